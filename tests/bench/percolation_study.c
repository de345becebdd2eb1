// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation of random networks, a line a realisation:
//
//     percolation_study threshold cubic|square|voronoi SIZE RUNS SEED
//
// the share of throats at least as easy as the hardest that gas entered until it had
// crossed; the Voronoi network is that of SIZE^2 random points, a network a line with
// many draws on it;
//
//     percolation_study mass 2|3 throats|nodes SIZE RUNS SEED
//
// nodes that gas came to in the middle half of SIZE x 2 SIZE (x SIZE) nodes when it had
// crossed them lengthwise, without and with trapping;
//
//     percolation_study front 2|3 GRADIENT RUNS SEED
//
// with an ease that grows upwards by GRADIENT a node, gas coming from above, in a box
// in proportion to GRADIENT^(-nu/(1+nu)): how far below the height at which the share
// of easy throats is critical gas is at most and in the mean; and the standard
// deviation of the height of its nodes next to liquid that leads down.
//
// What is random is evenly distributed from 0 to 1. All networks repeat sideways.
#include "network/invasion.h"
#include "tessellate/diagram.h"

#include "../random.h"
#include "basics/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INLET = WALL_Z_UPPER, OUTLET = WALL_Z_LOWER, DRAWS = 100 };

static uint64_t stream(uint64_t seed, int run)
{
    uint64_t state = seed << 32 | (uint64_t)run;
    next_random(&state);
    return state * 0xd1342543de82ef95u;
}

static void random_ease(double *entry_priority, int n, uint64_t *state)
{
    for (int i = 0; i < n; i++)
        entry_priority[i] = next_random(state);
}

static struct invasion invaded(const struct network *network,
                               const struct invasion_conditions *conditions)
{
    struct invasion invasion;
    struct reason reason;
    if (invade(network, conditions, &invasion, &reason)) {
        fprintf(stderr, "percolation_study: %s\n", reason.text);
        exit(STATUS_INTERNAL);
    }
    return invasion;
}

// Nodes on a lattice of which one axis may be one node wide; x and y repeat. Places and
// sizes of throats decide between two that happen to be as easy.
static struct network lattice(const int n[3])
{
    const int n_node = n[0] * n[1] * n[2], stride[3] = {1, n[0], n[0] * n[1]};
    const size_t most = 3 * (size_t)n_node;
    struct network network = {
        .packing = {.upper = {n[0], n[1], n[2]}, .periodic = {1, 1, 0}},
        .n_node = n_node,
        .node_position = NEW_ARRAY(struct vector, n_node),
        .node_walls = NEW_ARRAY(uint8_t, n_node),
        .throat_nodes = allocate(most, sizeof *network.throat_nodes),
        .throat_radius = NEW_ARRAY(double, most),
        .throat_length = NEW_ARRAY(double, most),
        .throat_kind = NEW_ARRAY(uint8_t, most)};
    for (int node = 0; node < n_node; node++) {
        const int at[3] = {node % n[0], node / n[0] % n[1], node / n[0] / n[1]};
        network.node_position[node] = (struct vector){at[0], at[1], at[2]};
        if (at[2] == 0) network.node_walls[node] |= OUTLET;
        if (at[2] == n[2] - 1) network.node_walls[node] |= INLET;
        for (int axis = 0; axis < 3; axis++) {
            const bool last = at[axis] == n[axis] - 1;
            if (n[axis] == 1 || (last && axis == 2)) continue;
            const int other = node + (last ? 1 - n[axis] : 1) * stride[axis];
            network.throat_radius[network.n_throat] = 0.1;
            network.throat_length[network.n_throat] = 1;
            int32_t *ends = network.throat_nodes[network.n_throat++];
            ends[0] = node < other ? node : other;
            ends[1] = node < other ? other : node;
        }
    }
    return network;
}

// --- threshold ---------------------------------------------------------------------

static struct network voronoi(int size, uint64_t *state)
{
    const int n = size * size;
    struct packing packing = {.n_particle = n,
                              .position = NEW_ARRAY(struct vector, n),
                              .radius = NEW_ARRAY(double, n),
                              .upper = {size, 1, size},
                              .periodic = {1, 0, 0}};
    for (int i = 0; i < n; i++) {
        packing.position[i].x = size * next_random(state);
        packing.position[i].y = 0.5;
        packing.position[i].z = size * next_random(state);
        packing.radius[i] = 1e-3;
    }
    struct network network;
    struct tessellation_report report;
    struct reason reason;
    const struct tessellation how = {.boundary = BOUNDARY_TRUNCATE, .layer = true};
    if (tessellate(&packing, &how, &network, &report, &reason)) {
        fprintf(stderr, "percolation_study: %s\n", reason.text);
        exit(STATUS_INTERNAL);
    }
    packing_free(&packing);
    return network;
}

static double crossing(const struct network *network, double *entry_priority,
                       uint64_t *state)
{
    random_ease(entry_priority, network->n_throat, state);
    struct invasion invasion =
        invaded(network, &(struct invasion_conditions){.entry_priority = entry_priority,
                                                       .inlet = INLET,
                                                       .outlet = OUTLET,
                                                       .until_breakthrough = true});
    double hardest = 1;
    for (int k = 0; k < invasion.n; k++)
        hardest = fmin(hardest, entry_priority[invasion.throat[k]]);
    invasion_free(&invasion);
    return 1 - hardest;
}

static void threshold(const char *kind, int size, int run, uint64_t seed)
{
    uint64_t state = stream(seed, run);
    const bool is_voronoi = strcmp(kind, "voronoi") == 0;
    const int n[3] = {size, strcmp(kind, "cubic") ? 1 : size, size + 1};
    struct network network = is_voronoi ? voronoi(size, &state) : lattice(n);
    double *entry_priority = NEW_ARRAY(double, network.n_throat);
    for (int draw = is_voronoi ? DRAWS : 1; draw > 0; draw--)
        printf("%.9f%c", crossing(&network, entry_priority, &state),
               draw > 1 ? ' ' : '\n');
    network_free(&network);
    free(entry_priority);
}

// --- mass --------------------------------------------------------------------------

static void mass(int dimensions, enum invasion_rule rule, int size, int run,
                 uint64_t seed)
{
    uint64_t state = stream(seed, run);
    const int n[3] = {size, dimensions == 2 ? 1 : size, 2 * size};
    const int layer = n[0] * n[1];
    struct network network = lattice(n);
    const int count = rule == INVADE_THROATS ? network.n_throat : network.n_node;
    double *entry_priority = NEW_ARRAY(double, count);
    random_ease(entry_priority, count, &state);
    for (int trapping = 0; trapping < 2; trapping++) {
        struct invasion invasion = invaded(
            &network, &(struct invasion_conditions){.rule = rule,
                                                    .entry_priority = entry_priority,
                                                    .inlet = INLET,
                                                    .outlet = OUTLET,
                                                    .trapping = trapping,
                                                    .until_breakthrough = true});
        int sum = 0;
        for (int k = 0; k < invasion.n; k++) {
            const int height = invasion.node[k] / layer;
            sum +=
                invasion.node[k] >= 0 && height >= size / 2 && height < size / 2 + size;
        }
        printf("%d%c", sum, trapping ? '\n' : ' ');
        invasion_free(&invasion);
    }
    network_free(&network);
    free(entry_priority);
}

// --- front -------------------------------------------------------------------------

// Liquid that leads down: 1 in REACHED; GAS nodes next to it: 2.
static void find_front(const struct network *network, const bool *gas, uint8_t *reached)
{
    struct incidence incidence = network_incidence(network);
    int *queue = NEW_ARRAY(int, network->n_node);
    int n = 0;
    for (int i = 0; i < network->n_node; i++)
        if ((network->node_walls[i] & OUTLET) && !gas[i]) {
            reached[i] = 1;
            queue[n++] = i;
        }
    for (int k = 0; k < n; k++)
        for (int i = incidence.offset[queue[k]]; i < incidence.offset[queue[k] + 1];
             i++) {
            const int32_t *ends = network->throat_nodes[incidence.throat[i]];
            const int other = ends[ends[0] == queue[k]];
            if (reached[other]) continue;
            reached[other] = gas[other] ? 2 : 1;
            if (!gas[other]) queue[n++] = other;
        }
    incidence_free(&incidence);
    free(queue);
}

// Marks where gas comes without entering anything harder than LEVEL. Returns whether it
// stops before it has crossed.
static bool fill_to_level(const struct invasion *invasion, const double *entry_priority,
                          double level, bool *gas)
{
    int k = 0;
    for (; k < invasion->n && entry_priority[invasion->throat[k]] >= level; k++)
        if (invasion->node[k] >= 0) gas[invasion->node[k]] = true;
    return k < invasion->n;
}

static void front(int dimensions, double gradient, int run, uint64_t seed)
{
    static const double critical[] = {0.5, 0.24881182}, exponent[] = {4 / 7., 0.467};
    uint64_t state = stream(seed, run);
    const double width = pow(gradient, -exponent[dimensions - 2]);
    const int reach = (int)ceil(3 * width), across = (int)ceil(4 * width);
    const int n[3] = {across, dimensions == 2 ? 1 : across, 2 * reach};
    const int layer = n[0] * n[1];
    const double middle = reach - 0.5;
    struct network network = lattice(n);
    double *entry_priority = NEW_ARRAY(double, network.n_throat);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *ends = network.throat_nodes[t];
        entry_priority[t] =
            next_random(&state) +
            gradient * ((ends[0] / layer + ends[1] / layer) / 2.0 - middle);
    }
    struct invasion invasion = invaded(
        &network, &(struct invasion_conditions){.entry_priority = entry_priority,
                                                .inlet = INLET,
                                                .outlet = OUTLET,
                                                .until_breakthrough = true});
    bool *gas = NEW_ARRAY(bool, network.n_node);
    uint8_t *reached = NEW_ARRAY(uint8_t, network.n_node);
    if (!fill_to_level(&invasion, entry_priority, 1 - critical[dimensions - 2], gas))
        fprintf(stderr, "percolation_study: front %g: run %d is cut off\n", gradient,
                run);
    find_front(&network, gas, reached);
    double tip = 0, n_below = 0, below = 0, n_front = 0, sum = 0, squares = 0;
    for (int i = 0; i < network.n_node; i++) {
        const double height = i / layer - middle;
        if (gas[i] && height < 0) {
            n_below++;
            below -= height;
            tip = fmax(tip, -height);
        }
        if (reached[i] != 2) continue;
        n_front++;
        sum += height;
        squares += height * height;
    }
    const double mean = sum / n_front;
    // In a small box gas may stay above the critical height: no tail.
    printf("%.1f %.6f %.6f\n", tip, n_below > 0 ? below / n_below : 0,
           sqrt(squares / n_front - mean * mean));
    invasion_free(&invasion);
    network_free(&network);
    free(entry_priority);
    free(gas);
    free(reached);
}

int main(int argc, char **argv)
{
    if (argc < 6) {
        fprintf(stderr, "percolation_study threshold KIND SIZE RUNS SEED\n"
                        "percolation_study mass 2|3 throats|nodes SIZE RUNS SEED\n"
                        "percolation_study front 2|3 GRADIENT RUNS SEED\n");
        return STATUS_USAGE;
    }
    const int runs = atoi(argv[argc - 2]);
    const uint64_t seed = strtoull(argv[argc - 1], NULL, 10);
    for (int run = 0; run < runs; run++)
        if (strcmp(argv[1], "threshold") == 0)
            threshold(argv[2], atoi(argv[3]), run, seed);
        else if (strcmp(argv[1], "mass") == 0)
            mass(atoi(argv[2]),
                 strcmp(argv[3], "nodes") ? INVADE_THROATS : INVADE_NODES,
                 atoi(argv[4]), run, seed);
        else
            front(atoi(argv[2]), strtod(argv[3], NULL), run, seed);
    return STATUS_OK;
}
