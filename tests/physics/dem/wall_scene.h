// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes for the tests of rigid walls: a few grains of 1 mm among them.
#pragma once

#include "../dem_scene.h"

#define GRAIN 1e-3 // m
static const double density = 2500, stiffness = 1000, gravity = 9.81;

struct scene {
    struct packing packing;
    struct dem_setup setup;
};

// Grains at rest at POSITION among walls; undamped, without friction.
static inline void set_scene(struct scene *scene, int n_grain,
                             const struct vector *position, int n_wall,
                             const struct dem_wall *wall)
{
    scene->packing = new_packing(n_grain, 0);
    scene->packing.upper = (struct vector){1, 1, 1};
    for (int i = 0; i < n_grain; i++) {
        scene->packing.position[i] = position[i];
        scene->packing.radius[i] = GRAIN;
    }
    scene->setup = (struct dem_setup){.packing = &scene->packing,
                                      .material = {.density = density,
                                                   .normal_stiffness = stiffness,
                                                   .shear_stiffness = 0.8 * stiffness,
                                                   .young_modulus = 1e7,
                                                   .poisson_ratio = 0.3,
                                                   .restitution = 1},
                                      .n_wall = n_wall,
                                      .wall = wall,
                                      .time_step_safety = 0.05,
                                      .balance_energy = true,
                                      .threads = 1};
}

static inline double mass(void)
{
    return density * 4.0 / 3 * M_PI * GRAIN * GRAIN * GRAIN;
}

static inline double weight(void)
{
    return mass() * gravity;
}

static inline struct vector of_grain(const struct dem *dem, int grain,
                                     void (*ask)(const struct dem *, struct vector *))
{
    struct vector *all = NEW_ARRAY(struct vector, dem->n_particle);
    ask(dem, all);
    const struct vector one = all[grain];
    free(all);
    return one;
}

static inline void assert_near(struct vector got, struct vector wanted, double within)
{
    if (!(distance(got, wanted) <= within))
        fail_msg("got (%.12g, %.12g, %.12g), wanted (%.12g, %.12g, %.12g) within %g",
                 got.x, got.y, got.z, wanted.x, wanted.y, wanted.z, within);
}
