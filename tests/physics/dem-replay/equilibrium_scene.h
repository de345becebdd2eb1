// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes for the tests of equilibrium: grains bonded as in [K Table 5.1], a block of
// them, and its loads.
#pragma once

#include "../dem_scene.h"
#include "../support_equilibrium.h"

static const double bond_stiffness = 8e14; // N/m3
static const double contact_stiffness = 3e4;
static const double radius_fraction = 0.5858;

static inline struct quasi_static_setup setup_of(const struct packing *packing,
                                                 const uint8_t *fixed)
{
    return (struct quasi_static_setup){
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

static inline double bond_area(void)
{
    return M_PI * pow(radius_fraction * RADIUS, 2);
}

enum { SIDE = 3, HIGH = 4, BLOCK = SIDE * SIDE * HIGH };

// Held at its bottom; nothing slips or breaks.
struct block {
    struct packing packing;
    uint8_t fixed[BLOCK];
    struct quasi_static_setup setup; // of these
};

static inline struct block *new_block(void)
{
    struct block *block = NEW_ARRAY(struct block, 1);
    block->packing = cubic_lattice(SIDE, SIDE, HIGH, false);
    for (int i = 0; i < SIDE * SIDE; i++)
        block->fixed[i] = 1;
    block->setup = setup_of(&block->packing, block->fixed);
    return block;
}

static inline void free_block(struct block *block)
{
    packing_free(&block->packing);
    free(block);
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
