// SPDX-License-Identifier: GPL-3.0-or-later
// Regular triangulations by their definition, with exact numbers: no point has less
// power to the centre of a cell than its corners have, cells fill the hull, and which
// they are depends on the points alone.
#include "geometry/triangulation/regular_triangulation.h"
#include "../../test.h"
#include "geometry/triangulation/insertion_order.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "geometry/triangulation/exact.h"
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 216, SIDE = 6 };

struct scene {
    struct vector at[POINTS];
    double weight[POINTS];
};

// One for all tests, which so draw different scenes.
static gsl_rng *generator(void)
{
    static gsl_rng *kept;
    if (!kept) kept = gsl_rng_alloc(gsl_rng_mt19937);
    return kept;
}

static double draw(void)
{
    return gsl_rng_uniform(generator());
}

static struct scene random_points(void)
{
    struct scene scene = {0};
    for (int i = 0; i < POINTS; i++)
        scene.at[i] = (struct vector){draw(), draw(), draw()};
    return scene;
}

// Eight points on each of many spheres, four in each of many planes.
static struct scene lattice(void)
{
    struct scene scene = {0};
    for (int i = 0; i < POINTS; i++)
        scene.at[i] = (struct vector){i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
    return scene;
}

// All on one sphere to rounding, but for its centre, which comes last.
static struct scene sphere(void)
{
    struct scene scene = random_points();
    for (int i = 0; i < POINTS; i++) {
        const struct vector from =
            subtract(scene.at[i], (struct vector){0.5, 0.5, 0.5});
        scene.at[i] = scale(i + 1 < POINTS ? 1 / norm(from) : 0, from);
    }
    return scene;
}

// With their reflections in three walls.
static struct scene reflected(void)
{
    const struct scene original = random_points();
    struct scene scene = original;
    for (int i = 0; i < POINTS; i++) {
        scene.at[i] = original.at[i / 4];
        if (i % 4) {
            const double x = component(scene.at[i], i % 4 - 1);
            set_component(&scene.at[i], i % 4 - 1, -x);
        }
    }
    return scene;
}

// Some so much heavier that others are engulfed.
static struct scene weighted(struct scene scene, double most)
{
    for (int i = 0; i < POINTS; i++)
        scene.weight[i] = most * floor(4 * draw());
    return scene;
}

static struct weighted_point point(const struct scene *scene, int32_t i)
{
    return (struct weighted_point){scene->at[i], scene->weight[i]};
}

static void assert_empty_spheres(const struct scene *scene,
                                 const struct triangulation *triangulation)
{
    struct weighted_point points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = point(scene, i);
    for (int c = 0; c < triangulation->n_cell; c++) {
        const int32_t *v = triangulation->cell[c].vertex;
        const struct weighted_point *p[5] = {&points[v[0]], &points[v[1]],
                                             &points[v[2]], &points[v[3]]};
        assert_int_equal(exact_orientation(p), 1);
        for (int i = 0; i < POINTS; i++) {
            p[4] = &points[i];
            assert_true(exact_power_side(p) <= 0);
        }
    }
}

static bool has_corner(const struct cell *cell, int32_t corner)
{
    for (int k = 0; k < 4; k++)
        if (cell->vertex[k] == corner) return true;
    return false;
}

// Neighbours share three corners, and cells end where nothing lies beyond: so they fill
// the hull.
static void assert_fills_hull(const struct scene *scene,
                              const struct triangulation *triangulation)
{
    struct weighted_point points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = point(scene, i);
    for (int c = 0; c < triangulation->n_cell; c++) {
        const struct cell *cell = &triangulation->cell[c];
        for (int k = 0; k < 4; k++) {
            const struct weighted_point *p[4];
            for (int m = 0; m < 4; m++) {
                p[m] = &points[cell->vertex[m]];
                if (m != k && cell->neighbour[k] >= 0)
                    assert_true(has_corner(&triangulation->cell[cell->neighbour[k]],
                                           cell->vertex[m]));
            }
            for (int i = 0; i < POINTS && cell->neighbour[k] < 0; i++) {
                p[k] = &points[i];
                assert_true(exact_orientation(p) >= 0);
            }
        }
    }
}

static int compare_corners(const void *a, const void *b)
{
    return memcmp(a, b, 4 * sizeof(int32_t));
}

// The corners of all cells, sorted, numbered as NAME says.
static int32_t (*cells_of(const struct triangulation *triangulation,
                          const int32_t *name))[4]
{
    const size_t n = (size_t)triangulation->n_cell;
    int32_t(*corners)[4] = allocate(n, sizeof *corners);
    for (size_t c = 0; c < n; c++) {
        for (int k = 0; k < 4; k++)
            corners[c][k] = name[triangulation->cell[c].vertex[k]];
        qsort(corners[c], 4, sizeof **corners, rising_ints);
    }
    qsort(corners, n, sizeof *corners, compare_corners);
    return corners;
}

static void triangulate_scene(const struct scene *scene, const int32_t *from,
                              struct triangulation *triangulation)
{
    struct weighted_point points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = point(scene, from[i]);
    assert_int_equal(triangulate(points, POINTS, triangulation), 0);
}

static void assert_same_in_order(const struct scene *scene, const int32_t *itself,
                                 const struct triangulation *triangulation,
                                 const int32_t *from)
{
    struct triangulation shuffled;
    triangulate_scene(scene, from, &shuffled);
    assert_int_equal(shuffled.n_cell, triangulation->n_cell);
    int32_t(*first)[4] = cells_of(triangulation, itself);
    int32_t(*second)[4] = cells_of(&shuffled, from);
    assert_memory_equal(first, second, (size_t)shuffled.n_cell * sizeof *first);
    free(first);
    free(second);
    triangulation_free(&shuffled);
}

// A drawn order, and the one that is fast.
static void assert_same_in_any_order(const struct scene *scene, const int32_t *itself,
                                     const struct triangulation *triangulation)
{
    int32_t from[POINTS];
    memcpy(from, itself, sizeof from);
    for (int i = POINTS - 1; i > 0; i--) {
        const unsigned long j = gsl_rng_uniform_int(generator(), (unsigned long)i + 1);
        const int32_t kept = from[i];
        from[i] = from[j];
        from[j] = kept;
    }
    assert_same_in_order(scene, itself, triangulation, from);
    int32_t *order = insertion_order(scene->at, POINTS);
    assert_same_in_order(scene, itself, triangulation, order);
    free(order);
}

// WHOLE: no point is engulfed.
static void check(struct scene scene, bool whole)
{
    struct triangulation triangulation;
    bool used[POINTS] = {0};
    int32_t itself[POINTS];
    for (int i = 0; i < POINTS; i++)
        itself[i] = i;
    triangulate_scene(&scene, itself, &triangulation);
    assert_empty_spheres(&scene, &triangulation);
    assert_fills_hull(&scene, &triangulation);
    assert_same_in_any_order(&scene, itself, &triangulation);
    int count = 0;
    for (int c = 0; c < triangulation.n_cell; c++)
        for (int k = 0; k < 4; k++)
            used[triangulation.cell[c].vertex[k]] = true;
    for (int i = 0; i < POINTS; i++)
        count += used[i];
    assert_true(whole ? count == POINTS : count < POINTS && count > POINTS / 10);
    triangulation_free(&triangulation);
}

TEST(points)
{
    check(random_points(), true);
    check(lattice(), true);
    check(sphere(), true);
    check(reflected(), true);
}

TEST(weighted)
{
    check(weighted(random_points(), 1e-4), true);
    check(weighted(lattice(), 0.125), true);
    check(weighted(random_points(), 0.05), false);
    check(weighted(lattice(), 0.5), false);
}

TEST(flat)
{
    const struct scene scene = lattice();
    struct weighted_point points[SIDE * SIDE];
    struct triangulation triangulation;
    for (int i = 0; i < SIDE * SIDE; i++)
        points[i] = point(&scene, i);
    assert_int_equal(triangulate(points, SIDE * SIDE, &triangulation), -1);
    assert_int_equal(triangulate(points, SIDE, &triangulation), -1);
    assert_int_equal(triangulate(points, 1, &triangulation), -1);
}
