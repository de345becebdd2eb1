// SPDX-License-Identifier: GPL-3.0-or-later
// How often the triangulation needs exact numbers:
//
//     bench_triangulation POINTS
#include "basics/memory.h"
#include "geometry/triangulation/insertion_order.h"
#include "geometry/triangulation/regular_triangulation.h"

#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

struct scene {
    const char *name;
    struct vector *at;
    double *weight; // NULL: all equal
    int n, capacity;
};

static void add_point(struct scene *scene, struct vector at)
{
    GROW_ARRAY(scene->at, scene->n, scene->capacity);
    scene->at[scene->n++] = at;
}

// In a box with sides of SIDE spacings; coordinates are multiples of 2^-40, as those of
// grains are, so that reflections are exact.
static void add_random(struct scene *scene, const gsl_rng *generator, int n,
                       double side)
{
    for (int i = 0; i < n; i++) {
        struct vector at;
        for (int axis = 0; axis < 3; axis++)
            set_component(
                &at, axis,
                ldexp(rint(ldexp(side * gsl_rng_uniform(generator), 40)), -40));
        add_point(scene, at);
    }
}

// Those within two spacings of a wall, as tessellate reflects them.
static void add_reflections(struct scene *scene, double side)
{
    const int n = scene->n;
    for (int i = 0; i < n; i++)
        for (int axis = 0; axis < 3; axis++)
            for (int upper = 0; upper < 2; upper++) {
                struct vector at = scene->at[i];
                const double wall = upper ? side : 0, x = component(at, axis);
                if (fabs(x - wall) > 2) continue;
                set_component(&at, axis, 2 * wall - x);
                add_point(scene, at);
            }
}

static void add_lattice(struct scene *scene, int side)
{
    for (int i = 0; i < side * side * side; i++)
        add_point(scene, (struct vector){i % side, i / side % side, i / side / side});
}

static void measure(struct scene *scene)
{
    struct triangulation triangulation = {0};
    const clock_t began = clock();
    int32_t *order = insertion_order(scene->at, scene->n);
    struct weighted_point *points = allocate_aligned((size_t)scene->n, sizeof *points);
    for (int k = 0; k < scene->n; k++)
        points[k] = (struct weighted_point){
            scene->at[order[k]], scene->weight ? scene->weight[order[k]] : 0};
    triangulate(points, scene->n, &triangulation);
    free(points);
    free(order);
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%-28s %9d %9d %12lld %10lld %9.4f %8.3f\n", scene->name, scene->n,
           triangulation.n_cell, (long long)triangulation.n_test,
           (long long)triangulation.n_exact,
           100 * (double)triangulation.n_exact / (double)triangulation.n_test, seconds);
    triangulation_free(&triangulation);
    free(scene->at);
    free(scene->weight);
}

int main(int argc, char **argv)
{
    const int n = argc > 1 ? atoi(argv[1]) : 100000;
    const int side = (int)lround(cbrt(n));
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    struct scene random = {.name = "random"},
                 boxed = {.name = "random, with reflections"},
                 weighted = {.name = "random, of many sizes"},
                 lattice = {.name = "simple cubic"};
    printf("%-28s %9s %9s %12s %10s %9s %8s\n", "points", "number", "cells",
           "sphere tests", "exact", "share, %", "seconds");
    add_random(&random, generator, n, side);
    measure(&random);
    add_random(&boxed, generator, n, side);
    add_reflections(&boxed, side);
    measure(&boxed);
    add_random(&weighted, generator, n, side);
    weighted.weight = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        weighted.weight[i] = 0.25 * gsl_rng_uniform(generator);
    measure(&weighted);
    add_lattice(&lattice, side);
    measure(&lattice);
    gsl_rng_free(generator);
}
