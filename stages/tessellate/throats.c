// SPDX-License-Identifier: GPL-3.0-or-later
// Throats: the edges of the diagram, dual to the facets of the triangulation.
#include "assemble.h"

#include "basics/memory.h"

#include <stdlib.h>

// A throat as seen from one facet: two nodes, and how wide it is beside these grains.
struct candidate {
    int32_t node[2];
    double radius; // mean diameters; may be below 0 where grains overlap
    int cell;      // keeps the order deterministic
};

static double clearance(const struct assembly *assembly, const int32_t node[2],
                        int particle, double radius)
{
    const struct vector a = assembly->nodes->position[node[0]];
    const struct vector along = subtract(assembly->nodes->position[node[1]], a);
    const struct vector to = subtract(assembly->generators->position[particle], a);
    const double length2 = dot(along, along);
    double t = length2 > 0 ? dot(to, along) / length2 : 0;
    if (assembly->clearance == CLEARANCE_SEGMENT) t = fmin(fmax(t, 0), 1);
    return norm(subtract(to, scale(t, along))) - radius; // [K 3.7, 3.8]
}

// The least clearance to the grains of the facet opposite corner K of CELL.
static double facet_clearance(const struct assembly *assembly, int cell, int k,
                              const int32_t node[2])
{
    double least = HUGE_VAL;
    for (int m = 0; m < 4; m++) {
        const int point = assembly->triangulation->vertex[cell][m];
        if (m == k || point >= assembly->generators->n_particle) continue;
        least = fmin(least, clearance(assembly, node, point, assembly->radius[point]));
    }
    return least;
}

static bool facet_has_grain(const struct assembly *assembly, int cell, int k)
{
    for (int m = 0; m < 4; m++)
        if (m != k &&
            assembly->triangulation->vertex[cell][m] < assembly->generators->n_particle)
            return true;
    return false;
}

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *first = a, *second = b;
    for (int end = 0; end < 2; end++)
        if (first->node[end] != second->node[end])
            return first->node[end] < second->node[end] ? -1 : 1;
    return (first->cell > second->cell) - (first->cell < second->cell);
}

static struct candidate *find_candidates(const struct assembly *assembly, int *count)
{
    struct candidate *candidates = NULL;
    int capacity = 0;
    *count = 0;
    for (int c = 0; c < assembly->triangulation->n_cell; c++)
        for (int k = 0; k < 4; k++) {
            const int d = assembly->triangulation->neighbour[c][k];
            if (d < c || !facet_has_grain(assembly, c, k)) continue;
            int32_t a = assembly->nodes->of_cell[c], b = assembly->nodes->of_cell[d];
            if (a == b) continue; // united on a wall
            const int32_t node[2] = {a < b ? a : b, a < b ? b : a};
            GROW_ARRAY(candidates, *count, capacity);
            candidates[(*count)++] =
                (struct candidate){.node = {node[0], node[1]},
                                   .radius = facet_clearance(assembly, c, k, node),
                                   .cell = c};
        }
    if (*count)
        qsort(candidates, (size_t)*count, sizeof *candidates, compare_candidates);
    return candidates;
}

// A throat in a wall is seen from the facets of several images: one throat, as wide as
// the narrowest of them says.
static int fuse_in_walls(const struct assembly *assembly, struct candidate *candidates,
                         int count)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        const struct candidate *next = &candidates[k];
        struct candidate *last = kept ? &candidates[kept - 1] : NULL;
        const bool same = last && last->node[0] == next->node[0] &&
                          last->node[1] == next->node[1] &&
                          (assembly->nodes->walls[next->node[0]] &
                           assembly->nodes->walls[next->node[1]]);
        if (same)
            last->radius = fmin(last->radius, next->radius);
        else
            candidates[kept++] = *next;
    }
    return kept;
}

int assemble_throats(const struct assembly *assembly, struct network *network)
{
    int count, closed = 0;
    struct candidate *candidates = find_candidates(assembly, &count);
    count = fuse_in_walls(assembly, candidates, count);

    const double unit = assembly->generators->unit;
    network->n_throat = count;
    network->throat_nodes = allocate((size_t)count, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, count);
    network->throat_length = NEW_ARRAY(double, count);
    network->throat_kind = NEW_ARRAY(uint8_t, count);
    for (int t = 0; t < count; t++) {
        for (int end = 0; end < 2; end++)
            network->throat_nodes[t][end] = candidates[t].node[end];
        network->throat_length[t] =
            unit * distance(assembly->nodes->position[candidates[t].node[0]],
                            assembly->nodes->position[candidates[t].node[1]]);
        network->throat_radius[t] = unit * fmax(0, candidates[t].radius);
        closed += candidates[t].radius < 0;
    }
    free(candidates);
    return closed;
}
