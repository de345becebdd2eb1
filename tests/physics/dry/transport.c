// SPDX-License-Identifier: GPL-3.0-or-later
// What invade makes known of pressures, permeabilities and diffusivities: a bundle of
// tubes, lattices and chains in closed form, random networks against Gaussian
// elimination in long double, and what mirrors and exchanged ends must not change.
#include "invade/transport.h"
#include "../../test.h"
#include "../support_lattice.h"
#include "invade/entry.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double tension = 0.07274;

struct result {
    struct invasion invasion;
    struct outcome outcome;
    struct transport transport;
    enum status status;
    struct reason reason;
};

static struct result invaded(const struct network *network, unsigned inlet,
                             unsigned outlet, bool trapping)
{
    struct result result = {.reason = {""}};
    struct invasion_conditions conditions = {
        .inlet = inlet, .outlet = outlet, .trapping = trapping};
    struct entry entry;
    assert_int_equal(entry_init(network, INVADE_THROATS,
                                &(struct entry_conditions){tension, 0, 1000, 0}, &entry,
                                &result.reason),
                     0);
    conditions.entry_priority = entry.entry_priority;
    assert_int_equal(invade(network, &conditions, &result.invasion, &result.reason), 0);
    result.outcome = outcome_init(network, &conditions, &result.invasion,
                                  entry.pressure, HELD_BY_THROATS);
    result.status = transport_find(network, &conditions, &result.outcome,
                                   &result.transport, &result.reason);
    entry_free(&entry);
    return result;
}

static void result_free(struct result *result)
{
    transport_free(&result->transport);
    outcome_free(&result->outcome);
    invasion_free(&result->invasion);
}

// --- closed forms ------------------------------------------------------------------

enum { TUBES = 200 };

// From a node each on the upper wall to one on the lower.
static struct network bundle_of_tubes(void)
{
    struct network network = {.n_node = 2 * TUBES, .n_throat = TUBES};
    uint64_t seed = 12;
    network.node_position = NEW_ARRAY(struct vector, 2 * TUBES);
    network.node_walls = NEW_ARRAY(uint8_t, 2 * TUBES);
    network.throat_nodes = allocate(TUBES, sizeof *network.throat_nodes);
    network.throat_radius = NEW_ARRAY(double, TUBES);
    network.throat_length = NEW_ARRAY(double, TUBES);
    network.throat_kind = NEW_ARRAY(uint8_t, TUBES);
    network.packing.upper = (struct vector){1e-6, 2e-6, 4e-6};
    for (int t = 0; t < TUBES; t++) {
        network.throat_nodes[t][0] = t;
        network.throat_nodes[t][1] = TUBES + t;
        network.node_walls[t] = WALL_Z_UPPER;
        network.node_walls[TUBES + t] = WALL_Z_LOWER;
        network.node_position[t].z = network.packing.upper.z;
        network.throat_radius[t] = 1e-7 * (0.1 + next_random(&seed));
        network.throat_length[t] = 4e-6;
    }
    return network;
}

// Sum over the tubes that are as wide, or wider, of r to the POWER.
static double moment_from(const struct network *network, double radius, int power)
{
    double sum = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_radius[t] >= radius)
            sum += pow(network->throat_radius[t], power);
    return sum;
}

TEST(bundle_of_tubes)
{
    struct network network = bundle_of_tubes();
    struct result result = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, true);
    assert_int_equal(result.status, 0);
    const struct outcome *outcome = &result.outcome;
    assert_int_equal(outcome->n_curve, TUBES);
    const double section = moment_from(&network, 0, 2);
    for (int k = 0; k < TUBES; k++) {
        const double radius = 2 * tension / outcome->curve_pressure[k] * (1 - 1e-12);
        const double filled = 1 - moment_from(&network, radius, 2) / section;
        assert_true(fabs(outcome->curve_saturation[k] - filled) < 1e-13);
    }
    const struct transport *transport = &result.transport;
    assert_int_equal(transport->n, 11);
    for (int k = 0; k < transport->n; k++) {
        int n = 0;
        while (n < TUBES && outcome->saturation[n] > transport->saturation[k])
            n++;
        n = transport->saturation[k] < 1 ? n : -1;
        const double radius =
            n < 0 ? INFINITY : network.throat_radius[result.invasion.throat[n]];
        const int power[PROPERTIES] = {[PERMEABILITY] = 4, [DIFFUSIVITY] = 2};
        for (int p = 0; p < PROPERTIES; p++) {
            const double share = moment_from(&network, radius, power[p]) /
                                 moment_from(&network, 0, power[p]);
            assert_true(fabs(transport->relative[GAS][p][k] - share) < 1e-12);
            assert_true(fabs(transport->relative[LIQUID_PHASE][p][k] - 1 + share) <
                        1e-12);
        }
    }
    assert_close(transport->material[DIFFUSIVITY], M_PI * section / 2e-12, 1e-13);
    assert_close(transport->material[PERMEABILITY],
                 M_PI * moment_from(&network, 0, 4) / 8 / 2e-12, 1e-13);
    result_free(&result);
    network_free(&network);
}

// Upright columns that exchange nothing, as all are alike.
TEST(lattice_of_equal_throats)
{
    const int n[3] = {5, 4, 7};
    const double spacing = 5e-7, r = 0.2 * spacing;
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    struct result result = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, false);
    assert_int_equal(result.status, 0);
    const struct transport *transport = &result.transport;
    const double columns = n[0] * n[1];
    const double section = (n[0] - 1) * (n[1] - 1) * spacing * spacing;
    assert_close(transport->material[DIFFUSIVITY], columns * M_PI * r * r / section,
                 1e-13);
    assert_close(transport->material[PERMEABILITY],
                 columns * M_PI * r * r * r * r / 8 / section, 1e-13);
    const int last = transport->n - 1;
    assert_true(transport->saturation[0] == 1 && transport->saturation[last] == 0);
    for (int p = 0; p < PROPERTIES; p++) {
        assert_close(transport->relative[GAS][p][last], 1, 1e-13);
        assert_close(transport->relative[LIQUID_PHASE][p][0], 1, 1e-13);
        assert_true(transport->relative[GAS][p][0] == 0);
        assert_true(transport->relative[LIQUID_PHASE][p][last] == 0);
        for (int k = 1; k <= last; k++)
            assert_true(transport->relative[GAS][p][k] >=
                        transport->relative[GAS][p][k - 1] * (1 - 1e-13));
    }
    result_free(&result);
    network_free(&network);
}

// Resistances add up, over twelve decades of conductances.
TEST(chain_of_tubes)
{
    enum { N = 40 };
    struct network network = lattice_network(1, 1, N + 1, 1);
    uint64_t seed = 8;
    long double resistance[PROPERTIES] = {0};
    for (int t = 0; t < N; t++) {
        const double r = network.throat_radius[t] =
            0.1 * pow(10, -3 * next_random(&seed));
        resistance[PERMEABILITY] += 8 / (M_PI * (long double)r * r * r * r);
        resistance[DIFFUSIVITY] += 1 / (M_PI * (long double)r * r);
    }
    struct result result = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, true);
    assert_int_equal(result.status, 0);
    for (int p = 0; p < PROPERTIES; p++)
        assert_close(result.transport.conductance[p], (double)(1 / resistance[p]),
                     1e-13);
    result_free(&result);
    network_free(&network);
}

// --- against elimination -------------------------------------------------------------

enum { MOST_NODES = 64 };

// As the header says: the conductance from INLET to OUTLET of what OPEN (n_throat)
// says.
static double eliminated(const struct network *network, unsigned inlet, unsigned outlet,
                         const bool *open, int power)
{
    static long double a[MOST_NODES][MOST_NODES + 1];
    const int n = network->n_node;
    memset(a, 0, sizeof a);
    for (int t = 0; t < network->n_throat; t++) {
        const int *e = network->throat_nodes[t];
        const long double c = powl(network->throat_radius[t], power) /
                              network->throat_length[t] * M_PI / (power == 4 ? 8 : 1);
        for (int s = 0; s < 2 && open[t]; s++) {
            a[e[s]][e[s]] += c;
            a[e[s]][e[1 - s]] -= c;
        }
    }
    for (int i = 0; i < n; i++) {
        const unsigned walls = network->node_walls[i];
        const bool alone = !(a[i][i] > 0); // nothing leads to it
        if (!alone && !(walls & (inlet | outlet))) a[i][i] *= 1 + 1e-17L; // or nowhere
        if (!alone && !(walls & (inlet | outlet))) continue;
        memset(a[i], 0, sizeof a[i]);
        a[i][i] = 1;
        a[i][MOST_NODES] = walls & inlet ? 1 : 0;
    }
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            const long double factor = a[i][k] / a[k][k];
            for (int j = k; j <= MOST_NODES && factor != 0; j++)
                a[i][j] -= factor * a[k][j];
        }
    long double x[MOST_NODES], flow = 0;
    for (int i = n - 1; i >= 0; i--) {
        x[i] = a[i][MOST_NODES];
        for (int j = i + 1; j < n; j++)
            x[i] -= a[i][j] * x[j];
        x[i] /= a[i][i];
    }
    for (int t = 0; t < network->n_throat; t++)
        for (int s = 0; s < 2 && open[t]; s++) {
            const int from = network->throat_nodes[t][s],
                      to = network->throat_nodes[t][1 - s];
            if (network->node_walls[to] & outlet)
                flow += powl(network->throat_radius[t], power) /
                        network->throat_length[t] * M_PI / (power == 4 ? 8 : 1) *
                        (x[from] - x[to]);
        }
    return (double)flow;
}

static void check_states(const struct network *network, const struct result *result,
                         unsigned inlet, unsigned outlet)
{
    const struct transport *transport = &result->transport;
    const struct outcome *outcome = &result->outcome;
    bool *open = NEW_ARRAY(bool, network->n_throat);
    for (int k = 0; k < transport->n; k++)
        for (int way = 0; way < PHASES * PROPERTIES; way++) {
            const bool gas = way / PROPERTIES == GAS;
            const int power = way % PROPERTIES == PERMEABILITY ? 4 : 2;
            int event = 0;
            while (event < outcome->n && (event ? outcome->saturation[event - 1] : 1) >
                                             transport->saturation[k])
                event++;
            for (int t = 0; t < network->n_throat; t++) {
                const int at = outcome->throat_event[t];
                open[t] = (at >= 0 && at <= event) == gas;
                for (int s = 0; s < 2; s++) {
                    const int node = network->throat_nodes[t][s];
                    const int came = outcome->node_event[node];
                    open[t] &= (network->node_walls[node] & (inlet | outlet)) ||
                               (came >= 0 && came <= event) == gas;
                }
            }
            const double expected = eliminated(network, inlet, outlet, open, power) /
                                    transport->conductance[way % PROPERTIES];
            const double found =
                transport->relative[way / PROPERTIES][way % PROPERTIES][k];
            assert_true(fabs(found - expected) <= 1e-13 * fabs(expected) + 1e-15);
        }
    free(open);
}

TEST(random_lattices)
{
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct network network = lattice_network(4, 4, 4, 1);
        randomise_radii(&network, 1, 0.9, seed);
        for (int trapping = 0; trapping < 2; trapping++) {
            struct result result =
                invaded(&network, WALL_X_LOWER, WALL_X_UPPER, trapping);
            assert_int_equal(result.status, 0);
            check_states(&network, &result, WALL_X_LOWER, WALL_X_UPPER);
            result_free(&result);
        }
        network_free(&network);
    }
}

// --- symmetry ------------------------------------------------------------------------

TEST(ends_may_change_places)
{
    struct network network = lattice_network(6, 5, 7, 1);
    randomise_radii(&network, 1, 0.8, 4);
    struct result down = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, true);
    struct result up = invaded(&network, WALL_Z_LOWER, WALL_Z_UPPER, true);
    for (int p = 0; p < PROPERTIES; p++)
        assert_close(up.transport.conductance[p], down.transport.conductance[p], 1e-13);
    for (int i = 0; i < network.n_node; i++) { // upside down
        const unsigned walls = network.node_walls[i];
        network.node_walls[i] =
            (uint8_t)((walls & 15) | (walls & 16) << 1 | (walls & 32) >> 1);
        network.node_position[i].z = 6 - network.node_position[i].z;
    }
    struct result mirrored = invaded(&network, WALL_Z_LOWER, WALL_Z_UPPER, true);
    assert_int_equal(mirrored.transport.n, down.transport.n);
    for (int k = 0; k < down.transport.n; k++) {
        assert_true(mirrored.transport.saturation[k] == down.transport.saturation[k]);
        for (int way = 0; way < PHASES * PROPERTIES; way++)
            assert_true(
                mirrored.transport.relative[way / PROPERTIES][way % PROPERTIES][k] ==
                down.transport.relative[way / PROPERTIES][way % PROPERTIES][k]);
    }
    result_free(&down);
    result_free(&up);
    result_free(&mirrored);
    network_free(&network);
}

// Of more nodes than a direct solver is given, numbered from the one end or the other.
TEST(large_networks_conduct_alike_both_ways)
{
    struct network network = lattice_network(12, 13, 14, 1);
    randomise_radii(&network, 1, 0.9, 5);
    struct result down = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, true);
    struct result up = invaded(&network, WALL_Z_LOWER, WALL_Z_UPPER, true);
    for (int p = 0; p < PROPERTIES; p++)
        assert_close(up.transport.conductance[p], down.transport.conductance[p], 1e-13);
    result_free(&down);
    result_free(&up);
    network_free(&network);
}

TEST(no_way_is_refused)
{
    struct network network = lattice_network(3, 3, 4, 1);
    for (int t = 0; t < network.n_throat; t++) { // two pieces, one above the other
        const int32_t *ends = network.throat_nodes[t];
        if (network.node_position[ends[0]].z == 1 &&
            network.node_position[ends[1]].z == 2)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
    struct result result = invaded(&network, WALL_Z_UPPER, WALL_Z_LOWER, false);
    assert_int_equal(result.status, STATUS_BAD_DATA);
    assert_non_null(strstr(result.reason.text, "from inlet to outlet"));
    result_free(&result);
    result = invaded(&network, WALL_Z_UPPER, WALL_X_LOWER, false); // share an edge
    assert_int_equal(result.status, STATUS_BAD_DATA);
    assert_non_null(strstr(result.reason.text, "at the inlet and at the outlet"));
    result_free(&result);
    network_free(&network);
}
