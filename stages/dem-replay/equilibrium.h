// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium of bonded grains itself, without cycles that lead there: for small
// displacements about where they began, with bonds [K 4.31-4.44], contacts that open,
// close and slip [K 4.11-4.26], by Newton's method on a sparse stiffness.
//
// Bonds break one after another: the most overloaded first, of equals the first listed,
// and the next is looked for when the load has found its way round.
//
// What equilibrium cannot hold: a fragment (grains joined by intact bonds) that no
// support holds and that would move more than a tenth of the mean radius when the rest
// is balanced leaves the aggregate. Its load counts no more, and nothing touches it any
// more. Where it flies and what it would hit is a matter of dynamics, and left to that
// engine.
#ifndef CRAQUELURE_EQUILIBRIUM_H
#define CRAQUELURE_EQUILIBRIUM_H

#include "dem/dem.h"

struct equilibrium_setup {
    const struct packing *packing; // with its bonds
    const uint8_t *fixed;          // (n_particle)
    bool has_wall;                 // beneath, at the lower z wall
    struct dem_material material;  // density and damping have no part in it
    struct dem_bond_material bond; // parallel
    double tolerance; // largest force or moment left on a grain, of the largest load
    int64_t most_iterations; // of one equilibrium
};

struct equilibrium;

// The caller frees *RESULT with equilibrium_free. STATUS_BAD_DATA: nothing resists.
enum status equilibrium_new(struct equilibrium **result,
                            const struct equilibrium_setup *setup,
                            struct reason *reason);
void equilibrium_free(struct equilibrium *equilibrium);

// The next one, under FORCE (n_particle) N, with the history of those before.
// STATUS_NOT_CONVERGED: not found in so many iterations, or what is left has moved so
// far that displacements are not small.
enum status equilibrium_find(struct equilibrium *equilibrium,
                             const struct vector *force, struct reason *reason);

// As the same functions of the engine [dem.h] say. The cycle of a crack is the
// iteration.
const struct dem_crack *equilibrium_cracks(const struct equilibrium *equilibrium,
                                           int *count);
void equilibrium_displacements(const struct equilibrium *equilibrium,
                               struct vector *displacement);
void equilibrium_bonds_intact(const struct equilibrium *equilibrium, uint8_t *intact);
struct dem_contact *equilibrium_contacts(const struct equilibrium *equilibrium,
                                         int *count);
double equilibrium_unbalanced_ratio(const struct equilibrium *equilibrium);

int equilibrium_iterations(const struct equilibrium *equilibrium); // so far
int equilibrium_gone(const struct equilibrium *equilibrium); // grains that have left

#endif
