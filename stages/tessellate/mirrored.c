// SPDX-License-Identifier: GPL-3.0-or-later
#include "mirrored.h"

#include "basics/memory.h"

#include <stdlib.h>

static const double grid = 1.0 / (1ull << 40);

static double round_to_grid(double x)
{
    return grid * nearbyint(x / grid);
}

double mean_diameter(const struct packing *packing)
{
    double sum = 0;
    for (int i = 0; i < packing->n_particle; i++)
        sum += 2 * packing->radius[i];
    return sum / packing->n_particle;
}

static struct vector scaled(const struct packing *packing, struct vector x, double unit)
{
    const struct vector from_corner = subtract(x, packing->lower);
    return (struct vector){round_to_grid(from_corner.x / unit),
                           round_to_grid(from_corner.y / unit),
                           round_to_grid(from_corner.z / unit)};
}

static enum status check_inside(const struct generators *generators,
                                struct reason *reason)
{
    for (int i = 0; i < generators->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double at = component(generators->position[i], axis);
            if (at > 0 && at < component(generators->box, axis)) continue;
            return refuse(
                reason, STATUS_BAD_DATA,
                "/particles/position: row %d: the centre must be inside the box "
                "along %c, from 0 to %g, got %g mean diameters from its lower wall",
                i, "xyz"[axis], component(generators->box, axis), at);
        }
    return STATUS_OK;
}

static int compare_places(const void *a, const void *b, void *positions)
{
    const int32_t i = *(const int32_t *)a, j = *(const int32_t *)b;
    const struct vector *at = positions;
    for (int axis = 0; axis < 3; axis++) {
        const double x = component(at[i], axis), y = component(at[j], axis);
        if (x != y) return x < y ? -1 : 1;
    }
    return (i > j) - (i < j);
}

// Of two grains in one place only one would get a cell, whichever came first.
static enum status check_distinct(const struct generators *generators,
                                  struct reason *reason)
{
    const struct vector *at = generators->position;
    const int n = generators->n_particle;
    int32_t *order = NEW_ARRAY(int32_t, n);
    for (int i = 0; i < n; i++)
        order[i] = i;
    qsort_r(order, (size_t)n, sizeof *order, compare_places, generators->position);
    enum status status = STATUS_OK;
    for (int k = 1; k < n && !status; k++)
        if (norm(subtract(at[order[k]], at[order[k - 1]])) == 0)
            status =
                refuse(reason, STATUS_BAD_DATA,
                       "/particles/position: row %d: has the same centre as row %d",
                       order[k], order[k - 1]);
    free(order);
    return status;
}

static void add_image(struct generators *generators, int i, int wall)
{
    const int axis = wall / 2;
    const double at = wall % 2 ? component(generators->box, axis) : 0;
    struct vector image = generators->position[i];
    set_component(&image, axis, 2 * at - component(image, axis)); // exact on the grid
    generators->position[generators->n] = image;
    generators->weight[generators->n] = generators->weight[i];
    generators->particle[generators->n] = i;
    generators->wall[generators->n++] = (int8_t)wall;
}

static double depth(const struct generators *generators, int i, int wall)
{
    const double at = component(generators->position[i], wall / 2);
    return wall % 2 ? component(generators->box, wall / 2) - at : at;
}

enum status mirror_grains(const struct packing *packing, double reach, bool power,
                          struct generators *generators, struct reason *reason)
{
    const int n = packing->n_particle;
    const size_t most = (size_t)n * (1 + WALL_COUNT);
    *generators = (struct generators){.n = n,
                                      .n_particle = n,
                                      .position = NEW_ARRAY(struct vector, most),
                                      .weight = NEW_ARRAY(double, most),
                                      .particle = NEW_ARRAY(int32_t, most),
                                      .wall = NEW_ARRAY(int8_t, most),
                                      .unit = mean_diameter(packing)};
    generators->box = scaled(packing, packing->upper, generators->unit);
    for (int i = 0; i < n; i++) {
        const double radius = packing->radius[i] / generators->unit;
        generators->position[i] =
            scaled(packing, packing->position[i], generators->unit);
        generators->weight[i] = power ? radius * radius : 0;
        generators->particle[i] = i;
        generators->wall[i] = -1;
    }
    enum status status = check_inside(generators, reason);
    if (!status) status = check_distinct(generators, reason);
    for (int i = 0; i < n && !status; i++)
        for (int wall = 0; wall < WALL_COUNT; wall++)
            if (depth(generators, i, wall) <= reach) add_image(generators, i, wall);
    return status;
}

void generators_free(struct generators *generators)
{
    free(generators->position);
    free(generators->weight);
    free(generators->particle);
    free(generators->wall);
    *generators = (struct generators){0};
}
