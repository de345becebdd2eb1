// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes for the tests of equilibrium: grains bonded as in [K Table 5.1], a block of
// them, and its loads.
#ifndef CRAQUELURE_TEST_EQUILIBRIUM_SCENE_H
#define CRAQUELURE_TEST_EQUILIBRIUM_SCENE_H

#include "dem-replay/equilibrium.h"
#include "dem_scene.h"

static const double bond_stiffness = 8e14; // N/m3
static const double contact_stiffness = 3e4;
static const double radius_fraction = 0.5858;

static inline struct equilibrium_setup setup_of(const struct packing *packing,
                                                const uint8_t *fixed)
{
    return (struct equilibrium_setup){
        .packing = packing,
        .fixed = fixed,
        .material = {.normal_stiffness = contact_stiffness,
                     .shear_stiffness = contact_stiffness},
        .bond = {.normal_stiffness = bond_stiffness,
                 .shear_stiffness = bond_stiffness,
                 .normal_strength = INFINITY,
                 .shear_strength = INFINITY,
                 .radius_fraction = radius_fraction},
        .tolerance = 1e-10,
        .most_iterations = 40};
}

static inline struct equilibrium *make(const struct equilibrium_setup *setup)
{
    struct equilibrium *equilibrium;
    struct reason reason = {""};
    if (equilibrium_new(&equilibrium, setup, &reason)) fail_msg("%s", reason.text);
    return equilibrium;
}

static inline void find(struct equilibrium *equilibrium, const struct vector *force)
{
    struct reason reason = {""};
    if (equilibrium_find(equilibrium, force, &reason)) fail_msg("%s", reason.text);
}

static inline double bond_area(void)
{
    return M_PI * pow(radius_fraction * RADIUS, 2);
}

enum { SIDE = 3, HIGH = 4, BLOCK = SIDE * SIDE * HIGH };

static inline void hold_bottom(uint8_t fixed[BLOCK])
{
    for (int i = 0; i < BLOCK; i++)
        fixed[i] = i < SIDE * SIDE;
}

// Squeezed from the sides and pulled up unevenly, SIZE N at most.
static inline void load_block(struct vector force[BLOCK], double size)
{
    for (int i = 0; i < BLOCK; i++) {
        const int x = i % SIDE - 1, y = i / SIDE % SIDE - 1;
        force[i] =
            (struct vector){-size * x, -0.7 * size * y, 0.1 * size * (1 + (i * 7) % 5)};
    }
}

static inline double apart(const struct vector *a, const struct vector *b)
{
    double most = 0, size = 0;
    for (int i = 0; i < BLOCK; i++) {
        most = fmax(most, distance(a[i], b[i]));
        size = fmax(size, norm(a[i]));
    }
    return most / size;
}

#endif
