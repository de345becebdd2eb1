// SPDX-License-Identifier: GPL-3.0-or-later
#include "support_lattice.h"

#include "../test.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static int lattice_node(int nx, int ny, int i, int j, int k)
{
    return (k * ny + j) * nx + i;
}

int lattice_throat(const struct network *network, int node, int axis)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        const struct vector way =
            subtract(network->node_position[ends[1]], network->node_position[ends[0]]);
        if (ends[0] == node && component(way, axis) > 0) return t;
    }
    return -1;
}

static void add_nodes(struct network *network, const int n[3], double spacing)
{
    network->n_node = n[0] * n[1] * n[2];
    network->node_position = NEW_ARRAY(struct vector, network->n_node);
    network->node_walls = NEW_ARRAY(uint8_t, network->n_node);
    for (int node = 0; node < network->n_node; node++) {
        const int at[3] = {node % n[0], node / n[0] % n[1], node / n[0] / n[1]};
        network->node_position[node] =
            (struct vector){at[0] * spacing, at[1] * spacing, at[2] * spacing};
        for (int axis = 0; axis < 3; axis++) {
            if (at[axis] == 0) network->node_walls[node] |= (uint8_t)(1 << 2 * axis);
            if (at[axis] == n[axis] - 1)
                network->node_walls[node] |= (uint8_t)(2 << 2 * axis);
        }
    }
}

static void add_throats(struct network *network, const int n[3], double spacing)
{
    const int stride[3] = {1, n[0], n[0] * n[1]};
    const size_t most = 3 * (size_t)network->n_node;
    network->throat_nodes = allocate(most, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, most);
    network->throat_length = NEW_ARRAY(double, most);
    network->throat_kind = NEW_ARRAY(uint8_t, most);
    for (int node = 0; node < network->n_node; node++)
        for (int axis = 0; axis < 3; axis++) {
            if (network->node_walls[node] & 2 << 2 * axis) continue;
            const int t = network->n_throat++;
            network->throat_nodes[t][0] = node;
            network->throat_nodes[t][1] = node + stride[axis];
            network->throat_radius[t] = 0.2 * spacing;
            network->throat_length[t] = spacing;
        }
}

static void add_grains(struct network *network, const int n[3], double spacing)
{
    struct packing *packing = &network->packing;
    const int m[3] = {n[0] - 1, n[1] - 1, n[2] - 1};
    packing->n_particle = m[0] * m[1] * m[2];
    packing->position = NEW_ARRAY(struct vector, packing->n_particle);
    packing->radius = NEW_ARRAY(double, packing->n_particle);
    packing->upper = (struct vector){m[0] * spacing, m[1] * spacing, m[2] * spacing};
    for (int g = 0; g < packing->n_particle; g++) {
        packing->position[g] = (struct vector){(g % m[0] + 0.5) * spacing,
                                               (g / m[0] % m[1] + 0.5) * spacing,
                                               (g / m[0] / m[1] + 0.5) * spacing};
        packing->radius[g] = spacing / 2;
    }
}

// A square where a side of the grain's cube lies on WALL.
static void add_wall_face(struct network *network, const int n[3], int grain, int wall)
{
    const int m[3] = {n[0] - 1, n[1] - 1, n[2] - 1};
    const int stride[3] = {1, n[0], n[0] * n[1]};
    const int at[3] = {grain % m[0], grain / m[0] % m[1], grain / m[0] / m[1]};
    const int axis = wall / 2, upper = wall % 2;
    if (at[axis] != (upper ? m[axis] - 1 : 0)) return;
    const int u = stride[(axis + 1) % 3], v = stride[(axis + 2) % 3];
    const int corner =
        lattice_node(n[0], n[1], at[0], at[1], at[2]) + upper * stride[axis];
    const int square[4] = {corner, corner + u, corner + u + v, corner + v};
    const int face = network->n_face++;
    for (int k = 0; k < 4; k++)
        network->face_nodes[4 * face + k] = square[k];
    network->face_offset[face + 1] = 4 * (face + 1);
    network->face_particles[face][0] = grain;
    network->face_particles[face][1] = -1 - wall;
}

struct network lattice_network(int nx, int ny, int nz, double spacing)
{
    const int n[3] = {nx, ny, nz};
    struct network network = {0};
    add_nodes(&network, n, spacing);
    add_throats(&network, n, spacing);
    add_grains(&network, n, spacing);
    const size_t most = (size_t)(WALL_COUNT * network.packing.n_particle);
    network.face_offset = NEW_ARRAY(int64_t, most + 1);
    network.face_nodes = NEW_ARRAY(int32_t, 4 * most);
    network.face_particles = allocate(most, sizeof *network.face_particles);
    for (int wall = 0; wall < WALL_COUNT; wall++)
        for (int grain = 0; grain < network.packing.n_particle; grain++)
            add_wall_face(&network, n, grain, wall);
    return network;
}

struct network lattice_column(int n, double spacing)
{
    struct network network = lattice_network(2, 2, n + 1, spacing);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        if (node[1] - node[0] != 4 || node[0] % 4 != 0)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
    return network;
}

void randomise_radii(struct network *network, double spacing, double spread,
                     uint64_t seed)
{
    for (int t = 0; t < network->n_throat; t++)
        network->throat_radius[t] =
            0.2 * spacing * (1 + spread * (2 * next_random(&seed) - 1));
}

// All lengths times FACTOR; the lower corner is the origin.
static void enlarge(struct network *network, double factor)
{
    for (int i = 0; i < network->n_node; i++)
        network->node_position[i] = scale(factor, network->node_position[i]);
    for (int g = 0; g < network->packing.n_particle; g++)
        network->packing.position[g] = scale(factor, network->packing.position[g]);
    network->packing.upper = scale(factor, network->packing.upper);
    for (int t = 0; t < network->n_throat; t++) {
        network->throat_radius[t] *= factor;
        network->throat_length[t] *= factor;
    }
}

struct drying_conditions kharaghani_conditions(enum liquid_limit liquid)
{
    return (struct drying_conditions){.temperature = 293.15,
                                      .gas_pressure = 1e5,
                                      .saturation_pressure = 2339,
                                      .air_vapour_pressure = 0,
                                      .diffusivity = 2.5685e-5,
                                      .molar_mass = 18.02e-3,
                                      .liquid_density = 998.2,
                                      .mass_transfer = 5.1,
                                      .open_walls = WALL_Z_UPPER,
                                      .viscosity = 1e-6,
                                      .surface_tension = 0.07274,
                                      .saturation_step = 1,
                                      .start_saturation = 1,
                                      .liquid = liquid,
                                      .first_period_rate_fraction = 0.9};
}

struct drying_conditions kelvin_conditions(enum liquid_limit liquid)
{
    struct drying_conditions conditions = kharaghani_conditions(liquid);
    conditions.kelvin = true;
    return conditions;
}

// Every throat that takes part goes from 1 to 0, never up but in viscous liquid, in the
// changes and the events.
static void check_changes(const struct network *network,
                          const struct drying_history *history, bool refills)
{
    double *saturation = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        saturation[t] = network->throat_kind[t] == THROAT_NETWORK;
    int event = 0;
    for (int step = 0; step < history->n_step; step++) {
        double liquid = 0, full = 0;
        for (int64_t c = history->change_offset[step];
             c < history->change_offset[step + 1]; c++) {
            const int t = history->change_throat[c];
            assert_true(c == history->change_offset[step] ||
                        history->change_throat[c - 1] < t);
            assert_true(saturation[t] > 0);
            assert_true(history->change_saturation[c] >= 0);
            assert_true(history->change_saturation[c] < saturation[t] || refills);
            assert_true(history->change_saturation[c] <= 1);
            saturation[t] = history->change_saturation[c];
        }
        for (int t = 0; t < network->n_throat; t++) {
            const bool takes_part = network->throat_kind[t] == THROAT_NETWORK;
            liquid += saturation[t] * throat_volume(network, t);
            full += takes_part ? throat_volume(network, t) : 0;
        }
        assert_true(fabs(liquid / full - history->saturation[step]) < 1e-13);
        const int events_before = event;
        for (; event < history->n_event &&
               history->event_time[event] == history->time[step];
             event++)
            assert_true(saturation[history->event_throat[event]] ==
                        history->event_kind[event]); // refilled: 1, emptied: 0
        assert_int_equal(event > events_before, step > 0);
    }
    assert_int_equal(event, history->n_event);
    for (int t = 0; t < network->n_throat; t++)
        assert_true(saturation[t] == 0);
    free(saturation);
}

struct drying_history dry_or_fail(const struct network *network,
                                  const struct drying_conditions *conditions)
{
    struct drying_history history;
    struct reason reason = {""};
    const enum status status =
        dry_network(network, conditions, NULL, &history, &reason);
    if (status) fail_msg("%s", reason.text);
    return history;
}

struct drying_history dry_and_check(const struct network *network,
                                    const struct drying_conditions *conditions)
{
    struct drying_history history = dry_or_fail(network, conditions);
    int n = 0;
    double liquid = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK) {
            n++;
            liquid += throat_volume(network, t) * conditions->liquid_density;
        }
    for (int k = 0; k < history.n_event; k++)
        n += history.event_kind[k] == EVENT_REFILLED;
    assert_int_equal(history.n_event, n);
    assert_true(history.n_step <= n + 1);
    const int last = history.n_step - 1;
    assert_true(fabs(history.initial_liquid / liquid - 1) < 1e-13);
    assert_true(fabs(history.evaporated / liquid - 1) < 1e-12);
    assert_true(history.vapour_residual < 1e-12);
    assert_true(history.saturation[0] == 1 && history.saturation[last] == 0);
    assert_true(history.time[0] == 0 && history.rate[last] == 0);
    assert_true(history.clusters[last] == 0);

    // The gas only grows, so by the maximum principle the rate only falls, unless wider
    // menisci come up, with more vapour.
    double evaporated = 0;
    for (int k = 0; k < last; k++) {
        const double lost = evaporated / liquid;
        assert_true(history.time[k + 1] > history.time[k]);
        assert_true(history.rate[k + 1] <= history.rate[k] * (1 + 1e-12) ||
                    conditions->kelvin);
        assert_true(history.saturation[k + 1] < history.saturation[k]);
        assert_true(fabs(history.saturation[k] - (1 - lost)) < 1e-11);
        evaporated += history.rate[k] * (history.time[k + 1] - history.time[k]);
    }
    check_changes(network, &history,
                  conditions->liquid == LIQUID_VISCOUS || conditions->kelvin);
    return history;
}

void check_dries_alike_enlarged(struct network *network,
                                struct drying_conditions conditions)
{
    const double factor = 0x1p30;
    struct drying_history small = dry_or_fail(network, &conditions);
    enlarge(network, factor);
    conditions.mass_transfer /= factor;
    if (conditions.kelvin) {
        conditions.surface_tension *= factor;
        conditions.viscosity *= factor * factor;
    }
    struct drying_history large = dry_or_fail(network, &conditions);
    assert_int_equal(small.n_step, large.n_step);
    for (int k = 0; k < small.n_step; k++) {
        assert_true(large.time[k] == small.time[k] * factor * factor);
        assert_true(large.rate[k] == small.rate[k] * factor);
        assert_true(large.saturation[k] == small.saturation[k]);
        assert_int_equal(large.clusters[k], small.clusters[k]);
    }
    assert_int_equal(small.n_event, large.n_event);
    for (int k = 0; k < small.n_event; k++)
        assert_int_equal(large.event_throat[k], small.event_throat[k]);
    for (int64_t c = 0; c < small.change_offset[small.n_step]; c++)
        assert_true(large.change_saturation[c] == small.change_saturation[c]);
    assert_true(large.breakthrough_saturation == small.breakthrough_saturation);
    drying_history_free(&small);
    drying_history_free(&large);
}
