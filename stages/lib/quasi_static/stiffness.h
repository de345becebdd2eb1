// SPDX-License-Identifier: GPL-3.0-or-later
// The sparse stiffness of pairs between grains, factored, and what displacements
// answer a load.
#ifndef CRAQUELURE_STIFFNESS_H
#define CRAQUELURE_STIFFNESS_H

#include "contact_pair.h"
#include "quasi_static/large/pair_frame.h"
#include "sparse/supernodal.h"

struct stiffness;

// For N grains, of which those FIXED (n) do not move, and N_PAIR pairs, whose grains
// must stay the same. The caller frees it with stiffness_free.
struct stiffness *stiffness_create(int n, const uint8_t *fixed, int n_pair,
                                   const struct contact_pair *pair);
void stiffness_free(struct stiffness *stiffness);

// With TANGENT (n_pair) of each pair, >= 0 for each deformation, GEOMETRIC (n_pair) of
// it, which may be NULL, and of every grain besides what is SOFT against translations
// and turns. False: it is singular.
bool stiffness_factor(struct stiffness *stiffness, const double (*tangent)[COMPONENTS],
                      const struct pair_stiffness *geometric, const double soft[2]);

// Whether that is positive: whether any load grows with the displacement it makes.
bool stiffness_is_positive(const struct stiffness *stiffness);

// Begins the answer to LOAD (n), forces and moments, by the last factor. Finishing it,
// as often as wanted, is into ANSWER (n) the displacements under that load less what
// was taken off since the last time; 0 for fixed grains.
void stiffness_begin(struct stiffness *stiffness, const struct displacement *load);
void stiffness_finish(struct stiffness *stiffness, struct displacement *answer);

// Halves of the answers to as many GROUPS of unit loads as HALVES, COUNT (groups) in
// each. The product of halves is how the deformations of the ones answer loads of the
// others. The caller frees each (groups) with halves_free.
struct unit_load {
    int32_t pair, component;
};
void stiffness_halves(struct stiffness *stiffness, int groups, const int *count,
                      const struct unit_load (*load)[LANES], struct halves *halves);
void stiffness_product(const struct stiffness *stiffness, const struct halves *a,
                       const struct halves *b, double *product);

// How the load that was begun with, whole, deformations the pairs of HALVES:
// DEFORMATION for each of them. And takes those unit loads times LOAD off it.
void stiffness_deformation(const struct stiffness *stiffness,
                           const struct halves *halves, double *deformation);
void stiffness_subtract(struct stiffness *stiffness, const struct halves *halves,
                        const double *load);

// Multiplications that a factor takes.
double stiffness_work(const struct stiffness *stiffness);

#endif
