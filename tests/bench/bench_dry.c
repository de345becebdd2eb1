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
#include "dry/drying.h"
#include "network/invasion.h"

#include "basics/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

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
    network.packing.upper = (struct vector){n[0] - 1, n[1] - 1, n[2] - 1};
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

int main(int argc, char **argv)
{
    if (argc < 6) {
        fprintf(stderr, "bench_dry dry NX NY NZ inviscid|immobile [TOLERANCE [STEPS]]\n"
                        "bench_dry kelvin NX NY NZ inviscid|immobile LOWERED [STEPS]\n"
                        "bench_dry invade NX NY NZ pure|trapping\n");
        return STATUS_USAGE;
    }
    const int n[3] = {atoi(argv[2]), atoi(argv[3]), atoi(argv[4])};
    if (strcmp(argv[1], "invade") == 0)
        return invade_lattice(n, strcmp(argv[5], "trapping") == 0);
    const double number = argc > 6 ? strtod(argv[6], NULL) : 0;
    if (strcmp(argv[1], "kelvin") == 0)
        return dry(n, with_kelvin(argv[5], number), argc > 7 ? argv[7] : NULL);
    return dry(n, conditions(argv[5], number), argc > 7 ? argv[7] : NULL);
}
