// SPDX-License-Identifier: GPL-3.0-or-later
// Walls are the limit of large spheres that touch the box from outside, of which the
// paper takes some of 10^6 boxes [C 3.1]: the larger they are, the more cells are the
// same, and pores come to where walls put them as one over their radius.
#include "../../test.h"
#include "basics/memory.h"
#include "basics/sorted.h"
#include "geometry/triangulation/regular_triangulation.h"
#include "network/pore_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = 150, ALL = N + 6 };

static double noise(void)
{
    static unsigned state = 7;
    state = state * 1664525u + 1013904223u;
    return state / 4294967296.0;
}

// A box of 1 with grains of two sizes, on a grid of 2^-20 so that units and large
// spheres round nothing.
static struct packing some_packing(void)
{
    struct packing packing = {.n_particle = N, .upper = {1, 1, 1}};
    packing.position = NEW_ARRAY(struct vector, N);
    packing.radius = NEW_ARRAY(double, N);
    for (int i = 0; i < N; i++) {
        for (int axis = 0; axis < 3; axis++)
            set_component(&packing.position[i], axis,
                          ldexp(rint(ldexp(0.04 + 0.92 * noise(), 20)), -20));
        packing.radius[i] = i % 3 ? 0.0625 : 0.03125;
    }
    return packing;
}

// Sorted corners, walls as -1 to -6.
struct corners {
    int32_t of[4];
};

static int by_corners(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct corners));
}

static struct corners sorted(const int32_t corner[4])
{
    struct corners corners;
    memcpy(corners.of, corner, sizeof corners.of);
    qsort(corners.of, 4, sizeof *corners.of, rising_ints);
    return corners;
}

// Cells with a grain between grains and spheres of RADIUS in place of walls.
static struct corners *between_spheres(const struct grains *grains, double radius,
                                       int *count)
{
    struct weighted_point point[ALL];
    for (int i = 0; i < N; i++)
        point[i] = (struct weighted_point){grains->position[i], grains->weight[i]};
    for (int wall = 0; wall < 6; wall++) {
        struct vector centre = scale(0.5, grains->box);
        set_component(&centre, wall / 2,
                      wall % 2 ? component(grains->box, wall / 2) + radius : -radius);
        point[N + wall] = (struct weighted_point){centre, radius * radius};
    }
    struct triangulation between;
    assert_int_equal(triangulate(point, ALL, &between), 0);
    struct corners *cell = NEW_ARRAY(struct corners, between.n_cell);
    *count = 0;
    for (int c = 0; c < between.n_cell; c++) {
        int32_t corner[4], grain = 0;
        for (int k = 0; k < 4; k++) {
            const int32_t vertex = between.cell[c].vertex[k];
            corner[k] = vertex < N ? vertex : N - 1 - vertex;
            grain += vertex < N;
        }
        if (grain) cell[(*count)++] = sorted(corner);
    }
    triangulation_free(&between);
    qsort(cell, (size_t)*count, sizeof *cell, by_corners);
    return cell;
}

// Where the power to the grain of corner 0 is that to three others, for walls spheres
// of RADIUS. Written for grain 0 as the origin and divided by the radius, so that
// nothing is lost however large that is: 2 c.x = |c|^2 - w + w_0.
static struct vector centre_for(const struct grains *grains, const int32_t corner[4],
                                double radius)
{
    int first = 0;
    while (corner[first] < 0)
        first++;
    const struct vector at = grains->position[corner[first]];
    const double weight = grains->weight[corner[first]];
    struct vector row[3];
    double right[3];
    for (int k = 0, n = 0; k < 4; k++) {
        if (k == first) continue;
        if (corner[k] >= 0) {
            row[n] = subtract(grains->position[corner[k]], at);
            right[n] = 0.5 * (dot(row[n], row[n]) - grains->weight[corner[k]] + weight);
        } else {
            const int wall = -1 - corner[k];
            const double apart = wall_distance(grains, at, wall);
            struct vector middle = subtract(scale(0.5, grains->box), at);
            set_component(&middle, wall / 2, 0);
            const struct vector normal = wall_normal(wall);
            row[n] = add(scale(1 + apart / radius, normal), scale(1 / radius, middle));
            right[n] =
                apart + 0.5 * (apart * apart + dot(middle, middle) + weight) / radius;
        }
        n++;
    }
    const struct vector a = cross(row[1], row[2]), b = cross(row[2], row[0]),
                        c = cross(row[0], row[1]);
    const struct vector sum =
        add(scale(right[0], a), add(scale(right[1], b), scale(right[2], c)));
    return add(at, scale(1 / dot(row[0], a), sum));
}

static double farthest_centre(const struct grains *grains, const struct cells *cells,
                              double radius)
{
    double farthest = 0;
    for (int c = 0; c < cells->n; c++) {
        const struct pore_cell *cell = &cells->cell[c];
        int walls = 0;
        for (int k = 0; k < 4; k++)
            walls += cell->corner[k] < 0;
        if (walls == 0 || walls == 4) continue;
        farthest = fmax(
            farthest, distance(cell->centre, centre_for(grains, cell->corner, radius)));
    }
    return farthest;
}

TEST(walls_are_the_limit_of_spheres)
{
    struct packing packing = some_packing();
    struct grains grains;
    struct cells cells;
    struct reason reason = {""};
    if (find_cells(&packing, &grains, &cells, &reason)) fail_msg("%s", reason.text);
    struct corners *ours = NEW_ARRAY(struct corners, cells.n);
    for (int c = 0; c < cells.n; c++)
        ours[c] = sorted(cells.cell[c].corner);
    qsort(ours, (size_t)cells.n, sizeof *ours, by_corners);
    double before = 0;
    for (int power = 2; power <= 8; power += 2) {
        const double radius = pow(10, power);
        int count, same = 0;
        struct corners *theirs = between_spheres(&grains, radius, &count);
        for (int c = 0; c < cells.n; c++)
            same += bsearch(&ours[c], theirs, (size_t)count, sizeof *theirs,
                            by_corners) != NULL;
        const double off = farthest_centre(&grains, &cells, radius);
        print_message("# spheres of 1e%d: %d of %d cells, pores off by %.2e\n", power,
                      same, cells.n, off);
        if (power >= 6) assert_true(same == cells.n && count == cells.n);
        if (power >= 6) assert_true(fabs(before / off / 100 - 1) < 0.01);
        before = off;
        free(theirs);
    }
    free(ours);
    cells_free(&cells);
    grains_free(&grains);
    packing_free(&packing);
}
