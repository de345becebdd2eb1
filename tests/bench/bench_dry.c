// SPDX-License-Identifier: GPL-3.0-or-later
// Times drying on cubic lattices of nodes with random radii, without reading or
// writing.
//
//     bench_dry dry NX NY NZ inviscid|immobile [TOLERANCE [STEPS]]
//     bench_dry kelvin NX NY NZ inviscid|immobile LOWERED [STEPS]
//
//     bench_dry invade NX NY NZ pure|trapping
//
// print throats, seconds, throats a second and what rounding leaves of the balances
// (and write saturation, time and rate of each step to the file STEPS); or throats,
// seconds, throats invaded, and those when gas first reaches the far side.
//
//     bench_dry shifts NX NY NZ inviscid|immobile EVERY
//
// prints throats and, of each EVERY-th event where it changes the vapour: in the mean,
// how many nodes evaporate, how many of these evaporate otherwise by more than 1e-6
// afterwards, and how many would have to be told of it if smaller changes were put off
// until they are 1e-6 together.
#include "dry/conditions.h"
#include "dry/gas/boundary_layer.h"
#include "dry/inviscid/emptying_times.h"
#include "dry/run/drying.h"
#include "network/invasion.h"

#include "../random.h"
#include "basics/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// Spacing 1, radii evenly distributed from 0.1 to 0.3.
static struct network lattice(const int n[3])
{
    const int n_node = n[0] * n[1] * n[2], stride[3] = {1, n[0], n[0] * n[1]};
    const size_t most = 3 * (size_t)n_node;
    struct network network = {.n_node = n_node,
                              .node_position = NEW_ARRAY(struct vector, n_node),
                              .node_walls = NEW_ARRAY(uint8_t, n_node),
                              .throat_nodes =
                                  allocate(most, sizeof *network.throat_nodes),
                              .throat_radius = NEW_ARRAY(double, most),
                              .throat_length = NEW_ARRAY(double, most),
                              .throat_kind = NEW_ARRAY(uint8_t, most)};
    network.packing.upper =
        (struct vector){n[0] - 1, n[1] > 1 ? n[1] - 1 : 1, n[2] - 1};
    uint64_t random = 1;
    for (int node = 0; node < n_node; node++) {
        const int at[3] = {node % n[0], node / n[0] % n[1], node / n[0] / n[1]};
        network.node_position[node] = (struct vector){at[0], at[1], at[2]};
        for (int axis = 0; axis < 3; axis++) {
            if (at[axis] == 0) network.node_walls[node] |= (uint8_t)(1 << 2 * axis);
            if (at[axis] == n[axis] - 1) {
                network.node_walls[node] |= (uint8_t)(2 << 2 * axis);
                continue;
            }
            const int t = network.n_throat++;
            network.throat_nodes[t][0] = node;
            network.throat_nodes[t][1] = node + stride[axis];
            network.throat_radius[t] = 0.1 + 0.2 * next_random(&random);
            network.throat_length[t] = 1;
        }
    }
    return network;
}

// [K Table 3.1] under a boundary layer ten throats thick.
static struct drying_conditions conditions(const char *liquid, double tolerance)
{
    return (struct drying_conditions){
        .temperature = 293.15,
        .gas_pressure = 1e5,
        .saturation_pressure = 2339,
        .diffusivity = 2.5685e-5,
        .molar_mass = 18.02e-3,
        .liquid_density = 998.2,
        .mass_transfer = 2.5685e-6,
        .open_walls = WALL_Z_UPPER,
        .liquid = strcmp(liquid, "immobile") == 0 ? LIQUID_IMMOBILE : LIQUID_INVISCID,
        .start_saturation = 1,
        .step_interval = 1e-3,
        .vapour_tolerance = tolerance,
        .first_period_rate_fraction = 0.9};
}

// Above a meniscus in a throat of the mean radius the vapour is lowered by this part.
static struct drying_conditions with_kelvin(const char *liquid, double lowered)
{
    struct drying_conditions kelvin = conditions(liquid, 0);
    kelvin.kelvin = true;
    kelvin.surface_tension = -log1p(-lowered) * 0.2 / 2 * kelvin.liquid_density *
                             GAS_CONSTANT * kelvin.temperature / kelvin.molar_mass;
    return kelvin;
}

static void write_steps(const struct drying_history *history, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        return;
    }
    for (int k = 0; k < history->n_step; k++)
        fprintf(file, "%.17g %.17g %.17g\n", history->saturation[k], history->time[k],
                history->rate[k]);
    fclose(file);
}

static int dry(const int n[3], const struct drying_conditions c, const char *steps)
{
    struct network network = lattice(n);
    struct drying_history history;
    struct reason reason;
    const double start = seconds();
    const enum status status = dry_network(&network, &c, NULL, &history, &reason);
    const double time = seconds() - start;
    if (status) {
        fprintf(stderr, "bench_dry: %s\n", reason.text);
        return status;
    }
    printf("%d %.4f %.0f %.1e %.1e\n", network.n_throat, time, network.n_throat / time,
           fabs(history.evaporated / history.initial_liquid - 1),
           history.vapour_residual);
    if (steps) write_steps(&history, steps);
    drying_history_free(&history);
    network_free(&network);
    return STATUS_OK;
}

static int invade_lattice(const int n[3], bool trapping)
{
    struct network network = lattice(n);
    struct invasion invasion;
    struct reason reason;
    const double start = seconds();
    const enum status status =
        invade(&network,
               &(struct invasion_conditions){
                   .inlet = WALL_Z_UPPER, .outlet = WALL_Z_LOWER, .trapping = trapping},
               &invasion, &reason);
    printf("%d %.4f %d %d\n", network.n_throat, seconds() - start, invasion.n,
           invasion.breakthrough);
    invasion_free(&invasion);
    network_free(&network);
    return status;
}

static void begin_drying(const struct network *network,
                         const struct drying_conditions *c, struct occupancy *occupancy)
{
    const struct drying_scale scale = drying_scale(network, c);
    const struct occupancy_form form = {.length = scale.length,
                                        .gas_parts = c->liquid != LIQUID_IMMOBILE};
    struct boundary_layer layer;
    struct reason reason;
    if (boundary_layers_init(network, c->open_walls, scale.length, scale.boundary_layer,
                             &(struct boundary_form){.layers = 0}, &layer, &reason) ||
        occupancy_init(network, c->open_walls, &form, layer, occupancy, &reason)) {
        fprintf(stderr, "bench_dry: %s\n", reason.text);
        exit(STATUS_INTERNAL);
    }
}

struct shifts {
    double evaporating, changed, told;
    int n_event;
};

static void count_shifts(const struct occupancy *occupancy, const double *before,
                         struct shifts *shifts)
{
    for (int k = 0; k < occupancy->n_wet; k++) {
        const int node = occupancy->wet[k];
        const double now = vapour_evaporation(&occupancy->vapour, node);
        if (!(now > 0 && before[node] > 0)) continue;
        const double shift = fabs(now / before[node] - 1);
        shifts->evaporating++;
        shifts->changed += shift > 1e-6;
        shifts->told += fmin(1, shift / 1e-6);
    }
    shifts->n_event++;
}

static int follow_shifts(const int n[3], const struct drying_conditions c, int every)
{
    struct network network = lattice(n);
    struct occupancy occupancy;
    begin_drying(&network, &c, &occupancy);
    struct emptying_times times =
        emptying_times_init(&occupancy, c.liquid == LIQUID_IMMOBILE);
    double *before = NEW_ARRAY(double, network.n_node);
    struct shifts shifts = {0};
    for (int event = 0; occupancy.n_liquid > 0; event++) {
        const double rate = vapour_rate(&occupancy.vapour);
        for (int k = 0; event % every == 0 && k < occupancy.n_wet; k++)
            before[occupancy.wet[k]] =
                vapour_evaporation(&occupancy.vapour, occupancy.wet[k]);
        if (emptying_times_advance(&times) < 0) break;
        emptying_times_empty_ended(&times);
        if (event % every == 0 && vapour_rate(&occupancy.vapour) != rate)
            count_shifts(&occupancy, before, &shifts);
    }
    printf("%d %.0f %.0f %.0f\n", network.n_throat, shifts.evaporating / shifts.n_event,
           shifts.changed / shifts.n_event, shifts.told / shifts.n_event);
    free(before);
    emptying_times_free(&times);
    occupancy_free(&occupancy);
    network_free(&network);
    return STATUS_OK;
}

int main(int argc, char **argv)
{
    if (argc < 6) {
        fprintf(stderr, "bench_dry dry NX NY NZ inviscid|immobile [TOLERANCE [STEPS]]\n"
                        "bench_dry kelvin NX NY NZ inviscid|immobile LOWERED [STEPS]\n"
                        "bench_dry invade NX NY NZ pure|trapping\n"
                        "bench_dry shifts NX NY NZ inviscid|immobile EVERY\n");
        return STATUS_USAGE;
    }
    const int n[3] = {atoi(argv[2]), atoi(argv[3]), atoi(argv[4])};
    if (strcmp(argv[1], "invade") == 0)
        return invade_lattice(n, strcmp(argv[5], "trapping") == 0);
    const double number = argc > 6 ? strtod(argv[6], NULL) : 0;
    if (strcmp(argv[1], "shifts") == 0)
        return follow_shifts(n, conditions(argv[5], 0), number >= 1 ? (int)number : 1);
    if (strcmp(argv[1], "kelvin") == 0)
        return dry(n, with_kelvin(argv[5], number), argc > 7 ? argv[7] : NULL);
    return dry(n, conditions(argv[5], number), argc > 7 ? argv[7] : NULL);
}
