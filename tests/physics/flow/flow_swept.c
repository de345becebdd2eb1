// SPDX-License-Identifier: GPL-3.0-or-later
// The rate at which moving grains open a pore is the derivative of its volume: cells
// less the sectors of grains in them, measured a little before and a little after.
#include "../../test.h"
#include "flow/facet.h"
#include "flow/pore_volume_rate.h"
#include "geometry/solid_angle.h"

#include <stdlib.h>

enum { N = 40 };

static double noise(void)
{
    static unsigned state = 1;
    state = state * 1664525u + 1013904223u;
    return state / 4294967296.0;
}

static struct vector random_vector(void)
{
    const double x = noise(), y = noise();
    return (struct vector){x, y, noise()};
}

// By Gauss: facets and walls, each times a point on it.
static double cell_volume(const struct grains *grains, const struct pore_cell *cell)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        if (cell->neighbour[k] < 0) continue;
        struct corner corner[3];
        struct vector on = {0, 0, 0};
        for (int m = 0; m < 3; m++) {
            corner[m] = facet_corner_of(grains, cell, k, m);
            if (corner[m].radius > 0) on = corner[m].at;
        }
        const struct facet facet =
            measure_facet(corner, cell->centre, cell->centre, true);
        sum += dot(facet.area, on) / 3;
        if (cell->corner[k] >= 0) continue;
        const int wall = -1 - cell->corner[k];
        const struct vector normal = wall_normal(wall);
        const double plane = wall % 2 ? component(grains->box, wall / 2) : 0;
        sum += -dot(facet.area, normal) * plane / 3;
    }
    return sum;
}

static struct vector direction(const struct grains *grains,
                               const struct pore_cell *cell, int from, int to)
{
    if (cell->corner[to] < 0) return wall_normal(-1 - cell->corner[to]);
    return subtract(corner_position(grains, cell, to),
                    corner_position(grains, cell, from));
}

static double fluid_volume(const struct grains *grains, const struct pore_cell *cell)
{
    double volume = cell_volume(grains, cell);
    for (int k = 0; k < 4; k++) {
        if (cell->corner[k] < 0) continue;
        const int *other = facet_corner[k];
        const struct half_angle angle = half_solid_angle(
            direction(grains, cell, k, other[0]), direction(grains, cell, k, other[1]),
            direction(grains, cell, k, other[2]));
        const double radius = grains->radius[cell->corner[k]];
        volume -= radius * radius * radius / 3 *
                  solid_angle_between((struct half_angle){1, 0}, angle);
    }
    return volume;
}

static void move(struct grains *grains, const struct vector *velocity,
                 struct vector rate, double time)
{
    for (int i = 0; i < N; i++)
        grains->position[i] = add(grains->position[i], scale(time, velocity[i]));
    grains->box.x *= 1 + rate.x * time;
    grains->box.y *= 1 + rate.y * time;
    grains->box.z *= 1 + rate.z * time;
}

static double *volumes(const struct grains *grains, const struct cells *cells)
{
    double *volume = calloc((size_t)cells->n_pore, sizeof *volume);
    for (int c = 0; c < cells->n; c++)
        volume[cells->cell[c].pore] += fluid_volume(grains, &cells->cell[c]);
    return volume;
}

TEST(opening_is_the_derivative_of_the_volume)
{
    struct packing packing = {.n_particle = N, .upper = {1, 1, 1}};
    struct vector position[N], velocity[N];
    double radius[N];
    for (int i = 0; i < N; i++) {
        position[i] = add((struct vector){.1, .1, .1}, scale(.8, random_vector()));
        velocity[i] = subtract(random_vector(), (struct vector){.5, .5, .5});
        radius[i] = .02 + .02 * noise();
    }
    packing.position = position;
    packing.radius = radius;
    struct grains grains;
    struct cells cells;
    struct reason reason;
    assert_int_equal(find_cells(&packing, &grains, &cells, &reason), STATUS_OK);
    const struct throat_rule rule = {.factor = 0.5};
    struct throats throats = find_throats(&grains, &cells, &rule);
    const struct vector rate = {0.3, -0.2, 0.1};
    double *opening = opening_rates(&grains, &cells, &throats, velocity, rate);

    const double step = 1e-5;
    const struct vector box = grains.box;
    move(&grains, velocity, rate, step);
    double *after = volumes(&grains, &cells);
    move(&grains, velocity, (struct vector){0, 0, 0}, -2 * step);
    grains.box = box;
    grains.box.x *= 1 - rate.x * step;
    grains.box.y *= 1 - rate.y * step;
    grains.box.z *= 1 - rate.z * step;
    double *before = volumes(&grains, &cells);
    double sum = 0;
    for (int i = 0; i < cells.n_pore; i++) {
        assert_true(fabs(opening[i] - (after[i] - before[i]) / (2 * step)) < 1e-8);
        sum += opening[i];
    }
    assert_true(fabs(sum - box.x * box.y * box.z * (rate.x + rate.y + rate.z)) < 1e-12);
    free(opening);
    free(after);
    free(before);
    throats_free(&throats);
    cells_free(&cells);
    grains_free(&grains);
}
