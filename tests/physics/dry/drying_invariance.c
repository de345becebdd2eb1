// SPDX-License-Identifier: GPL-3.0-or-later
// What drying must not depend on: how nodes and throats are numbered, the unit of
// length, the number of threads, and, while the liquid is in one piece, how fast it
// dries.
#include "../../test.h"
#include "../support_lattice.h"
#include "dry/liquid/clusters.h"
#include "elimination/dense_front.h"
#include "network/invasion.h"

#include "basics/memory.h"

#include <omp.h>
#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;

// A copy in which node i is NODE_TO[i] and throat t is THROAT_TO[t].
static struct network renumbered(const struct network *old, int n[3],
                                 const int *node_to, const int *throat_to)
{
    struct network new = lattice_network(n[0], n[1], n[2], spacing);
    for (int i = 0; i < old->n_node; i++) {
        new.node_position[node_to[i]] = old->node_position[i];
        new.node_walls[node_to[i]] = old->node_walls[i];
    }
    for (int t = 0; t < old->n_throat; t++) {
        const int a = node_to[old->throat_nodes[t][0]];
        const int b = node_to[old->throat_nodes[t][1]];
        new.throat_nodes[throat_to[t]][0] = a < b ? a : b;
        new.throat_nodes[throat_to[t]][1] = a < b ? b : a;
        new.throat_radius[throat_to[t]] = old->throat_radius[t];
        new.throat_length[throat_to[t]] = old->throat_length[t];
        new.throat_kind[throat_to[t]] = old->throat_kind[t];
    }
    for (int64_t k = 0; k < old->face_offset[old->n_face]; k++)
        new.face_nodes[k] = node_to[old->face_nodes[k]];
    return new;
}

static void compare_steps(const struct drying_history *a,
                          const struct drying_history *b)
{
    assert_int_equal(a->n_step, b->n_step);
    for (int k = 0; k < a->n_step; k++) {
        assert_int_equal(a->clusters[k], b->clusters[k]);
        assert_true(fabs(a->time[k] - b->time[k]) <= 1e-12 * a->time[k]);
        assert_true(fabs(a->rate[k] - b->rate[k]) <= 1e-12 * a->rate[k]);
        assert_true(fabs(a->saturation[k] - b->saturation[k]) < 1e-12);
    }
}

// With the Kelvin effect what is on the verge of condensing may fill to the brim or
// not, which makes a step.
static void check_renumbered(enum liquid_limit liquid, double spread,
                             unsigned empty_walls, bool kelvin)
{
    int n[3] = {6, 5, 7};
    uint64_t seed = 99;
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    randomise_radii(&network, spacing, spread, 3);
    impose_empty_throats(&network, empty_walls);
    int *node_to = shuffled(network.n_node, &seed);
    int *throat_to = shuffled(network.n_throat, &seed);
    struct network other = renumbered(&network, n, node_to, throat_to);

    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.kelvin = kelvin;
    struct drying_history a = dry_and_check(&network, &conditions);
    struct drying_history b = dry_and_check(&other, &conditions);
    if (!kelvin) compare_steps(&a, &b);
    double *emptied =
        NEW_ARRAY(double, network.n_throat); // throats that tie have no order
    for (int k = 0; k < b.n_event; k++)
        emptied[b.event_throat[k]] = b.event_time[k]; // for the last time
    for (int k = 0; k < a.n_event; k++) {
        if (a.event_kind[k] == EVENT_REFILLED) continue;
        const double time = emptied[throat_to[a.event_throat[k]]];
        assert_true(fabs(a.event_time[k] / time - 1) < 1e-12);
    }
    free(emptied);
    drying_history_free(&a);
    drying_history_free(&b);
    network_free(&network);
    network_free(&other);
    free(node_to);
    free(throat_to);
}

TEST(numbering_does_not_matter)
{
    for (int all_equal = 0; all_equal < 2; all_equal++) {
        const double spread = all_equal ? 0 : 0.2;
        check_renumbered(LIQUID_INVISCID, spread, 0, false);
        check_renumbered(LIQUID_IMMOBILE, spread, 0, false);
        check_renumbered(LIQUID_INVISCID, spread,
                         WALL_X_LOWER | WALL_Y_UPPER | WALL_Z_LOWER, false);
    }
    check_renumbered(LIQUID_INVISCID, 0.2, 0, true);
    check_renumbered(LIQUID_IMMOBILE, 0.2, 0, true);
    check_renumbered(LIQUID_VISCOUS, 0.2, 0, true);
}

// Nodes moved at random, and each throat as wide as its narrower node: most share that
// with others and are as wide to the last digit.
static struct network irregular_network(int n[3], uint64_t seed)
{
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    double *clearance = NEW_ARRAY(double, network.n_node);
    for (int i = 0; i < network.n_node; i++) {
        clearance[i] = spacing * (0.1 + 0.2 * next_random(&seed));
        struct vector *place = &network.node_position[i];
        for (int axis = 0; axis < 3; axis++)
            if (!(network.node_walls[i] & 3 << 2 * axis))
                set_component(place, axis,
                              component(*place, axis) +
                                  0.3 * spacing * (next_random(&seed) - 0.5));
    }
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *ends = network.throat_nodes[t];
        network.throat_radius[t] = fmin(clearance[ends[0]], clearance[ends[1]]);
        network.throat_length[t] = norm(along_throat(&network, t));
    }
    free(clearance);
    return network;
}

// The same throats one after the other, at the same times.
static void check_same_events(const struct drying_history *a,
                              const struct drying_history *b, const int *throat_to)
{
    assert_int_equal(a->n_event, b->n_event);
    for (int k = 0; k < a->n_event; k++) {
        assert_int_equal(throat_to[a->event_throat[k]], b->event_throat[k]);
        assert_int_equal(a->event_kind[k], b->event_kind[k]);
        assert_true(fabs(a->event_time[k] / b->event_time[k] - 1) < 1e-12);
    }
}

static void check_irregular(enum liquid_limit liquid)
{
    int n[3] = {6, 5, 7};
    uint64_t seed = 5;
    struct network network = irregular_network(n, 41);
    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.viscosity = 1e-6;
    struct drying_history first = dry_and_check(&network, &conditions);
    for (int run = 0; run < 3; run++) {
        int *node_to = shuffled(network.n_node, &seed);
        int *throat_to = shuffled(network.n_throat, &seed);
        struct network other = renumbered(&network, n, node_to, throat_to);
        struct drying_history again = dry_and_check(&other, &conditions);
        check_same_events(&first, &again, throat_to);
        drying_history_free(&again);
        network_free(&other);
        free(node_to);
        free(throat_to);
    }
    drying_history_free(&first);
    network_free(&network);
}

TEST(ties_do_not_hang_on_numbers)
{
    check_irregular(LIQUID_INVISCID);
    check_irregular(LIQUID_IMMOBILE);
    check_irregular(LIQUID_VISCOUS);
}

static void check_scaled(enum liquid_limit liquid)
{
    struct network network = lattice_network(5, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.2, 17);
    check_dries_alike_enlarged(&network, kharaghani_conditions(liquid));
    network_free(&network);
}

TEST(unit_of_length_does_not_matter)
{
    check_scaled(LIQUID_INVISCID);
    check_scaled(LIQUID_IMMOBILE);
}

// For each throat, the size of its cluster when it empties and the lowest throat in it.
struct kin {
    int size, lowest;
};

static struct kin *kin_when_emptied(const struct network *network,
                                    const struct drying_history *history)
{
    struct kin *kin = NEW_ARRAY(struct kin, network->n_throat);
    struct incidence incidence = network_incidence(network);
    struct clusters clusters = clusters_init(network, &incidence, NULL, true);
    for (int k = 0; k < history->n_event; k++) {
        const int throat = history->event_throat[k];
        const int cluster = clusters.of_throat[throat];
        int lowest = 0;
        while (clusters.of_throat[lowest] != cluster)
            lowest++;
        kin[throat] = (struct kin){clusters.size[cluster], lowest};
        clusters_empty_throat(&clusters, throat);
    }
    clusters_free(&clusters);
    incidence_free(&incidence);
    return kin;
}

// Invasion percolation within a cluster knows radii and neighbours only: the rates
// decide which cluster is ahead, but each empties in the same order and splits in the
// same way.
TEST(order_within_a_cluster_does_not_depend_on_the_rate)
{
    struct network network = lattice_network(8, 8, 8, spacing);
    randomise_radii(&network, spacing, 0.3, 31);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history a = dry_and_check(&network, &conditions);
    conditions.mass_transfer *= 10;
    conditions.air_vapour_pressure = 2000;
    struct drying_history b = dry_and_check(&network, &conditions);

    struct kin *kin_a = kin_when_emptied(&network, &a);
    struct kin *kin_b = kin_when_emptied(&network, &b);
    for (int t = 0; t < network.n_throat; t++) {
        assert_int_equal(kin_a[t].size, kin_b[t].size);
        assert_int_equal(kin_a[t].lowest, kin_b[t].lowest);
    }
    int n_moved = 0;
    for (int k = 0; k < a.n_event; k++)
        n_moved += a.event_throat[k] != b.event_throat[k];
    assert_true(n_moved > a.n_event / 10);
    free(kin_a);
    free(kin_b);
    drying_history_free(&a);
    drying_history_free(&b);
    network_free(&network);
}

// Whether the cluster of THROAT holds liquid at a node on the lower wall. GAS: nodes at
// which a throat has emptied.
static bool leads_down(const struct network *network, const struct clusters *clusters,
                       const bool *gas, int throat)
{
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[t][end];
            if (clusters->of_throat[t] == clusters->of_throat[throat] && !gas[node] &&
                (network->node_walls[node] & WALL_Z_LOWER))
                return true;
        }
    return false;
}

// Until gas reaches the wall opposite the open one, one cluster stands on it, and
// empties as if it did not evaporate but was pushed out there, with all else trapped.
static void check_drying_is_invasion(double gravity)
{
    struct network network = lattice_network(7, 7, 9, spacing);
    randomise_radii(&network, spacing, 0.3, 32);
    impose_empty_throats(&network, WALL_Z_UPPER); // at the surface one throat a node
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.gravity = gravity;
    conditions.surface_tension = 0.07;
    struct drying_history history = dry_and_check(&network, &conditions);

    double *entry_priority = NEW_ARRAY(double, network.n_throat);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        entry_priority[t] =
            conditions.liquid_density * gravity / 2 *
                (network.node_position[node[0]].z + network.node_position[node[1]].z) -
            2 * conditions.surface_tension / network.throat_radius[t];
    }
    struct invasion invasion;
    struct reason reason;
    const struct invasion_conditions rule = {.entry_priority = entry_priority,
                                             .inlet = WALL_Z_UPPER,
                                             .outlet = WALL_Z_LOWER,
                                             .trapping = true};
    assert_int_equal(invade(&network, &rule, &invasion, &reason), 0);

    struct incidence incidence = network_incidence(&network);
    struct clusters clusters = clusters_init(&network, &incidence, NULL, true);
    bool *gas = NEW_ARRAY(bool, network.n_node);
    int n = 0;
    for (int k = 0; k < history.n_event; k++) {
        const int throat = history.event_throat[k];
        if (n < invasion.breakthrough && leads_down(&network, &clusters, gas, throat)) {
            assert_int_equal(invasion.throat[n++], throat);
        }
        clusters_empty_throat(&clusters, throat);
        for (int end = 0; end < 2; end++)
            gas[network.throat_nodes[throat][end]] = true;
    }
    assert_int_equal(n, invasion.breakthrough);
    assert_true(n > history.n_event / 10);
    free(gas);
    free(entry_priority);
    clusters_free(&clusters);
    incidence_free(&incidence);
    invasion_free(&invasion);
    drying_history_free(&history);
    network_free(&network);
}

TEST(one_cluster_empties_as_invasion_says)
{
    check_drying_is_invasion(0);
    check_drying_is_invasion(1e7);
}

// A front large enough for threads to share it, of doubles and of floats: the same
// bits.
TEST(threads_do_not_matter)
{
    int n[3] = {34, 34, 3};
    assert_true(n[0] * n[1] > SHARED_FRONT);
    struct network network = lattice_network(n[0], n[1], n[2], spacing);
    randomise_radii(&network, spacing, 0.5, 11);
    for (int rounded = 0; rounded < 2; rounded++) {
        struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
        conditions.vapour_tolerance = rounded ? 1e-6 : 0;
        struct drying_history history[2];
        for (int k = 0; k < 2; k++) {
            omp_set_num_threads(1 + 2 * k);
            history[k] = dry_or_fail(&network, &conditions);
        }
        const struct drying_history *a = &history[0], *b = &history[1];
        assert_int_equal(a->n_step, b->n_step);
        assert_memory_equal(a->rate, b->rate, (size_t)a->n_step * sizeof *a->rate);
        assert_memory_equal(a->time, b->time, (size_t)a->n_step * sizeof *a->time);
        for (int k = 0; k < 2; k++)
            drying_history_free(&history[k]);
    }
    network_free(&network);
}
