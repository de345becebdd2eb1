// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own in networks that dry at random: what they
// evaporate, and which of them wait, against relaxation in long double of all throats
// that are gas and all bodies of liquid, without elimination.
#include "../../test.h"
#include "../support_lattice.h"
#include "dry/conditions.h"
#include "dry/kelvin/kelvin_menisci.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 1e-7;
enum { MOST_SWEEPS = 1000000 };

// All bodies change at once: by less, or neighbours would swing.
static const long double DAMPED = 0.7L;

// By nodes and bodies: a throat or a cluster.
struct field {
    const struct occupancy *occupancy;
    bool by_throat;
    long double *level;     // (n_node)
    long double *air;       // (n_node) conductance to the air
    long double *potential; // (n_throat) of a body
    long double *own;       // (n_throat) of the widest meniscus of a body; 0: none
};

static int body_of(const struct field *field, int throat)
{
    return field->by_throat ? throat : field->occupancy->clusters.of_throat[throat];
}

// ln((p_g - p_v) / (p_g - p_sat)), over that of the air.
static long double potential_of(const struct drying_conditions *c, double radius)
{
    const long double exponent =
        2 * (long double)c->surface_tension * c->molar_mass /
        (radius * (long double)c->liquid_density * GAS_CONSTANT * c->temperature);
    const long double vapour = c->saturation_pressure * expl(-exponent);
    const long double flat = c->gas_pressure - (long double)c->saturation_pressure;
    return logl((c->gas_pressure - vapour) / flat) /
           logl((c->gas_pressure - (long double)c->air_vapour_pressure) / flat);
}

static struct field make_field(const struct occupancy *occupancy,
                               const struct drying_conditions *conditions)
{
    const struct network *network = occupancy->network;
    struct field field = {.occupancy = occupancy,
                          .by_throat = conditions->liquid == LIQUID_IMMOBILE,
                          .level = NEW_ARRAY(long double, network->n_node),
                          .air = NEW_ARRAY(long double, network->n_node),
                          .potential = NEW_ARRAY(long double, network->n_throat),
                          .own = NEW_ARRAY(long double, network->n_throat)};
    for (int i = 0; i < occupancy->layer.n_exposed; i++)
        field.air[occupancy->layer.exposed[i]] +=
            (long double)occupancy->layer.area[i] / occupancy->layer.spacing;
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[t][end];
            if (occupancy->clusters.of_throat[t] < 0 || occupancy->wet_place[node] < 0)
                continue;
            const int body = body_of(&field, t);
            const long double own = potential_of(conditions, network->throat_radius[t]);
            if (field.own[body] == 0 || own < field.own[body]) field.own[body] = own;
            field.potential[body] = field.own[body];
        }
    return field;
}

static void free_field(struct field *field)
{
    free(field->level);
    free(field->air);
    free(field->potential);
    free(field->own);
}

static double section(const struct occupancy *occupancy, int throat)
{
    const double r = occupancy->network->throat_radius[throat];
    return occupancy->clusters.of_throat[throat] < 0 ? 0 : r * r;
}

// What flows to NODE, and the conductances from it.
static long double inflow(const struct field *field, int node, long double *degree)
{
    const struct occupancy *occupancy = field->occupancy;
    long double flow = field->air[node] * (1 - field->level[node]);
    *degree = field->air[node];
    for (int k = occupancy->incidence.offset[node];
         k < occupancy->incidence.offset[node + 1]; k++) {
        const int throat = occupancy->incidence.throat[k];
        const int32_t *ends = occupancy->network->throat_nodes[throat];
        if (occupancy->clusters.of_throat[throat] >= 0) continue;
        const long double conductance = occupancy->vapour.conductance[throat];
        flow += conductance * (field->level[ends[0] == node ? ends[1] : ends[0]] -
                               field->level[node]);
        *degree += conductance;
    }
    return flow;
}

static void set_level(struct field *field, int node)
{
    const struct occupancy *occupancy = field->occupancy;
    long double sum = 0, mean = 0;
    for (int k = occupancy->incidence.offset[node];
         k < occupancy->incidence.offset[node + 1]; k++) {
        const int throat = occupancy->incidence.throat[k];
        const double part = section(occupancy, throat);
        if (!(part > 0)) continue;
        sum += part;
        mean += part * field->potential[body_of(field, throat)];
    }
    field->level[node] = mean / sum;
}

// GAIN and SLOPE (n_throat), by bodies.
static void find_gains(const struct field *field, long double *gain, long double *slope)
{
    const struct occupancy *occupancy = field->occupancy;
    for (int t = 0; t < occupancy->network->n_throat; t++)
        gain[t] = slope[t] = 0;
    for (int k = 0; k < occupancy->n_wet; k++) {
        const int node = occupancy->wet[k];
        const int begin = occupancy->incidence.offset[node];
        const int end = occupancy->incidence.offset[node + 1];
        long double degree, sum = 0;
        const long double flow = inflow(field, node, &degree);
        for (int i = begin; i < end; i++)
            sum += section(occupancy, occupancy->incidence.throat[i]);
        for (int i = begin; i < end; i++) {
            const int throat = occupancy->incidence.throat[i];
            const long double part = section(occupancy, throat) / sum;
            if (!(part > 0)) continue;
            gain[body_of(field, throat)] += part * flow;
            slope[body_of(field, throat)] += part * degree;
        }
    }
}

// No meniscus more curved than its throat makes it; those that are less evaporate
// nothing. Until nothing changes any more.
static void relax(struct field *field, long double *gain, long double *slope)
{
    const struct occupancy *occupancy = field->occupancy;
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        long double change = 0;
        for (int k = 0; k < occupancy->n_wet; k++)
            set_level(field, occupancy->wet[k]);
        for (int i = 0; i < occupancy->network->n_node; i++) {
            long double degree;
            if (!occupancy->gas[i] || occupancy->wet_place[i] >= 0) continue;
            const long double flow = inflow(field, i, &degree);
            change = fmaxl(change, fabsl(flow / degree));
            field->level[i] += flow / degree;
        }
        find_gains(field, gain, slope);
        for (int b = 0; b < occupancy->network->n_throat; b++) {
            if (!(slope[b] > 0)) continue;
            const long double next =
                fminl(field->own[b], field->potential[b] + DAMPED * gain[b] / slope[b]);
            change = fmaxl(change, fabsl(next - field->potential[b]));
            field->potential[b] = next;
        }
        if (change < 1e-16L) return;
    }
    fail_msg("relaxation does not end");
}

// Returns how many wait.
static int compare(const struct occupancy *occupancy,
                   const struct drying_conditions *conditions,
                   const struct kelvin_menisci *kelvin, const struct losses *losses)
{
    const int n = occupancy->network->n_throat;
    struct field field = make_field(occupancy, conditions);
    long double *gain = NEW_ARRAY(long double, n), *slope = NEW_ARRAY(long double, n);
    relax(&field, gain, slope);
    long double rate = 0;
    for (int i = 0; i < occupancy->network->n_node; i++)
        if (field.air[i] > 0) rate += field.air[i] * (1 - field.level[i]);
    assert_true(fabsl(kelvin->rate / rate - 1) < 1e-11L);
    int n_wait = 0;
    for (int b = 0; b < n; b++)
        n_wait += slope[b] > 0 && field.potential[b] < field.own[b] * (1 - 1e-9L);
    for (int k = 0; k < losses->n; k++) {
        const int body = body_of(&field, losses->loss[k].throat);
        assert_true(fabsl(losses->loss[k].rate - gain[body]) < 1e-12L * rate);
        gain[body] = 0;
    }
    for (int b = 0; b < n; b++)
        assert_true(fabsl(gain[b]) < 1e-12L * rate);
    free(gain);
    free(slope);
    free_field(&field);
    return n_wait;
}

static int some_meniscus(struct occupancy *occupancy, bool by_throat, uint64_t *seed)
{
    const int node = occupancy->wet[(int)(next_random(seed) * occupancy->n_wet)];
    int k = occupancy->incidence.offset[node];
    while (occupancy->clusters.of_throat[occupancy->incidence.throat[k]] < 0)
        k++;
    const int throat = occupancy->incidence.throat[k];
    return by_throat ? throat
                     : clusters_invasion_throat(&occupancy->clusters,
                                                occupancy->clusters.of_throat[throat]);
}

// FOLLOW: what was found before is gone on from.
static void check(enum liquid_limit liquid, bool follow)
{
    struct network network = lattice_network(4, 4, 4, spacing);
    randomise_radii(&network, spacing, 0.8, 12);
    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.kelvin = conditions.lumped = true;
    conditions.mass_transfer *= 100; // relaxation is slow where air is hard to reach
    const struct drying_scale scale = drying_scale(&network, &conditions);
    struct boundary_layer layer;
    struct occupancy occupancy;
    struct reason reason;
    assert_int_equal(boundary_layers_init(
                         &network, conditions.open_walls, scale.length,
                         scale.boundary_layer,
                         &(struct boundary_form){.feet = FEET_SURFACE, .lumped = true},
                         &layer, &reason),
                     STATUS_OK);
    const struct occupancy_form form = {.length = scale.length,
                                        .gas_parts = liquid != LIQUID_IMMOBILE};
    assert_int_equal(occupancy_init(&network, conditions.open_walls, &form, layer,
                                    &occupancy, &reason),
                     STATUS_OK);
    struct kelvin_menisci kelvin = kelvin_menisci_init(&occupancy, &conditions);
    struct losses losses = losses_init(network.n_throat);
    uint64_t seed = 3;
    int n_wait = 0;
    for (int k = 0; occupancy.n_liquid > 3; k++) {
        if (kelvin_menisci_find(&kelvin, &occupancy, &losses, &reason))
            fail_msg("%s", reason.text);
        if (k % 8 == 0) n_wait += compare(&occupancy, &conditions, &kelvin, &losses);
        const int throat = some_meniscus(&occupancy, liquid == LIQUID_IMMOBILE, &seed);
        if (follow)
            kelvin_menisci_empty_throat(&kelvin, &occupancy, throat);
        else
            occupancy_empty_throat(&occupancy, throat);
    }
    assert_true(n_wait > 10);
    losses_free(&losses);
    kelvin_menisci_free(&kelvin);
    occupancy_free(&occupancy);
    network_free(&network);
}

TEST(throats)
{
    check(LIQUID_IMMOBILE, false);
    check(LIQUID_IMMOBILE, true);
}

TEST(clusters)
{
    check(LIQUID_INVISCID, false);
    check(LIQUID_INVISCID, true);
}
