// SPDX-License-Identifier: GPL-3.0-or-later
#include "nodes.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Nodes closer to a wall, or wall nodes closer to each other, than this are taken to
// coincide: a thousand times the grid the generators are rounded to, mean diameters.
static const double coincide = 1e-9;

// Determinants below this, of the product of the edges, lose digits that matter.
static const double flat = 1e-3;

// The point of equal power to the four corners: 2 (x_k - x_0).c = |x_k - x_0|^2 - w_k +
// w_0 for c relative to corner 0, so that no large numbers are subtracted.
static struct vector power_centre(const struct generators *generators,
                                  const int32_t corner[4])
{
    const struct vector origin = generators->position[corner[0]];
    struct vector row[3];
    double right[3];
    for (int k = 0; k < 3; k++) {
        row[k] = subtract(generators->position[corner[k + 1]], origin);
        right[k] = 0.5 * (dot(row[k], row[k]) - generators->weight[corner[k + 1]] +
                          generators->weight[corner[0]]);
    }
    const struct vector across[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                     cross(row[0], row[1])};
    const double determinant = dot(row[0], across[0]);
    if (fabs(determinant) < flat * norm(row[0]) * norm(row[1]) * norm(row[2]))
        return exact_power_centre(generators->position, generators->weight, corner);
    struct vector centre = {0};
    // The second pass takes off what the first left by rounding.
    for (int pass = 0; pass < 2; pass++) {
        struct vector correction = {0};
        double residual[3];
        for (int k = 0; k < 3; k++)
            residual[k] = right[k] - dot(row[k], centre);
        for (int k = 0; k < 3; k++)
            correction = add(correction, scale(residual[k] / determinant, across[k]));
        centre = add(centre, correction);
    }
    return add(origin, centre);
}

static bool near_grain(const struct generators *generators, const int32_t corner[4])
{
    for (int k = 0; k < 4; k++)
        if (corner[k] < generators->n_particle) return true;
    return false;
}

// Puts a node exactly on every wall it is close to; returns those walls.
static uint8_t snap_to_walls(struct vector *position, struct vector box,
                             double *outside)
{
    uint8_t walls = 0;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const double at = wall % 2 ? component(box, wall / 2) : 0;
        const double beyond =
            (wall % 2 ? 1 : -1) * (component(*position, wall / 2) - at);
        if (fabs(beyond) < coincide) {
            walls |= (uint8_t)(1 << wall);
            set_component(position, wall / 2, at);
        } else {
            *outside = fmax(*outside, beyond);
        }
    }
    return walls;
}

static int root_of(int *parent, int i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

// The corners of a cell in ascending order of grain, walls last: names a node.
struct name {
    int32_t corner[4];
    int cell;
};

static int compare_int(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static int compare_names(const void *a, const void *b)
{
    const struct name *first = a, *second = b;
    for (int k = 0; k < 4; k++)
        if (first->corner[k] != second->corner[k])
            return first->corner[k] < second->corner[k] ? -1 : 1;
    return (first->cell > second->cell) - (first->cell < second->cell);
}

static struct name *sorted_names(const struct generators *generators,
                                 const struct triangulation *triangulation, int *count)
{
    struct name *names = NEW_ARRAY(struct name, triangulation->n_cell);
    *count = 0;
    for (int c = 0; c < triangulation->n_cell; c++) {
        if (!near_grain(generators, triangulation->vertex[c])) continue;
        struct name *name = &names[(*count)++];
        memcpy(name->corner, triangulation->vertex[c], sizeof name->corner);
        qsort(name->corner, 4, sizeof *name->corner, compare_int);
        name->cell = c;
    }
    qsort(names, (size_t)*count, sizeof *names, compare_names);
    return names;
}

// Where each cell's node would be, before those on walls are united.
struct places {
    struct vector *position;
    uint8_t *walls;
    int *parent; // cells whose nodes coincide on a wall; -1: no grain near
};

static void unite_on_walls(const struct triangulation *triangulation,
                           struct places *places)
{
    for (int c = 0; c < triangulation->n_cell; c++) {
        if (places->parent[c] < 0 || !places->walls[c]) continue;
        for (int k = 0; k < 4; k++) {
            const int d = triangulation->neighbour[c][k];
            if (d < 0 || places->parent[d] < 0 || !places->walls[d]) continue;
            if (distance(places->position[c], places->position[d]) > coincide) continue;
            const int first = root_of(places->parent, c),
                      second = root_of(places->parent, d);
            places->parent[first > second ? first : second] =
                first < second ? first : second;
        }
    }
}

struct nodes find_nodes(const struct generators *generators,
                        const struct triangulation *triangulation)
{
    const int n_cell = triangulation->n_cell;
    struct nodes nodes = {.of_cell = NEW_ARRAY(int, n_cell)};
    struct places places = {.position = NEW_ARRAY(struct vector, n_cell),
                            .walls = NEW_ARRAY(uint8_t, n_cell),
                            .parent = NEW_ARRAY(int, n_cell)};
    for (int c = 0; c < n_cell; c++) {
        places.parent[c] = near_grain(generators, triangulation->vertex[c]) ? c : -1;
        nodes.of_cell[c] = -1;
        if (places.parent[c] < 0) continue;
        places.position[c] = power_centre(generators, triangulation->vertex[c]);
        places.walls[c] = snap_to_walls(&places.position[c], generators->box,
                                        &nodes.farthest_outside);
    }
    unite_on_walls(triangulation, &places);

    int count;
    struct name *names = sorted_names(generators, triangulation, &count);
    nodes.position = NEW_ARRAY(struct vector, count);
    nodes.walls = NEW_ARRAY(uint8_t, count);
    for (int k = 0; k < count; k++) {
        const int root = root_of(places.parent, names[k].cell);
        if (nodes.of_cell[root] < 0) {
            nodes.position[nodes.n] = places.position[root];
            nodes.walls[nodes.n] = places.walls[root];
            nodes.of_cell[root] = nodes.n++;
        }
        nodes.of_cell[names[k].cell] = nodes.of_cell[root];
    }
    free(names);
    free(places.position);
    free(places.walls);
    free(places.parent);
    return nodes;
}

void nodes_free(struct nodes *nodes)
{
    free(nodes->position);
    free(nodes->walls);
    free(nodes->of_cell);
    *nodes = (struct nodes){0};
}
