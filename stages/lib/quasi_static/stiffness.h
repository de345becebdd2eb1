// SPDX-License-Identifier: GPL-3.0-or-later
// The sparse stiffness of all pairs, factored,
//     K = sum over pairs of (B^T tangent B + geometric) + soft 1 = L L^T,
// six unknowns for each grain that moves, in the units of displacement.h. No memory of
// the load is kept but that of the last stiffness_begin. B maps the displacements of
// two grains to the six components of their deformation (contact_pair.h), `tangent` is
// diagonal in these. The factor is supernodal (sparse/supernodal.h); its pattern
// depends on the pairs alone, so it is analysed once and factored as often as states
// change.
#pragma once

#include "contact_pair.h"
#include "quasi_static/large/pair_frame.h"
#include "sparse/supernodal.h"

struct stiffness;

// For N grains, of which those FIXED (n) do not move, and N_PAIR pairs, which are kept,
// not copied, and whose grains must stay the same. Pairs that RESIST (n_pair; NULL:
// all) make its pattern; the others never have a tangent. The caller frees it with
// stiffness_free. Fixed grains have no unknowns. The pattern costs O(n_pair log n_pair)
// and an analysis by CHOLMOD; memory is that of the factor.
struct stiffness *stiffness_create(int n, const uint8_t *fixed, int n_pair,
                                   const struct contact_pair *pair, const bool *resist);
void stiffness_free(struct stiffness *stiffness);

// What K is made of. `soft` regularises it where nothing holds a grain.
struct stiffness_terms {
    const double (*tangent)[COMPONENTS];    // (n_pair) of each component, >= 0
    const double *across;                   // (n_pair) between both shears; NULL: none
    const struct pair_stiffness *geometric; // (n_pair); NULL: none
    double soft[2];        // on the diagonal, for translations and for rotations
    const double *dashpot; // (n) on the diagonal, of each grain; NULL: none
};

// Factors K. False: a pivot that no number holds.
bool stiffness_factor(struct stiffness *stiffness, const struct stiffness_terms *terms);

// Whether K, as last factored, is positive definite to what rounding leaves. If not
// there still are solutions, with a factor whose lost pivots were replaced.
bool stiffness_is_positive(const struct stiffness *stiffness);

// Solves K ANSWER = LOAD (n) by the last factor, forward and then backward. The
// backward part, which may follow as often as wanted, is of the load less what was
// subtracted since the last time; the answer (n) is 0 for fixed grains. Between the two
// calls contacts that changed are put right by stiffness_subtract, without a new factor
// (contact_solver.c).
void stiffness_begin(struct stiffness *stiffness, const struct displacement *load);
void stiffness_finish(struct stiffness *stiffness, struct displacement *answer);

// L^-1 B^T of single components, in up to MOST_SOLVES GROUPS of COUNT (groups) each,
// BATCH at most. PRODUCT of two such: entries of W = B K^-1 B^T, a row for each of A.
// The caller frees each (groups) with forward_solves_free. A load of 1 in COMPONENT
// (enum component) of PAIR.
struct unit_load {
    int32_t pair, component;
};

// LOAD (groups). What a wall or a fixed grain would get is left out.
void stiffness_forward_solves(struct stiffness *stiffness, int groups, const int *count,
                              const struct unit_load (*load)[BATCH],
                              struct forward_solves *solves);
void stiffness_product(const struct stiffness *stiffness,
                       const struct forward_solves *a, const struct forward_solves *b,
                       double *product);

// DEFORMATION of the components of SOLVES under the load of stiffness_begin, all of it;
// and subtracts B^T LOAD, a number for each, from it.
void stiffness_deformation(const struct stiffness *stiffness,
                           const struct forward_solves *solves, double *deformation);
void stiffness_subtract(struct stiffness *stiffness,
                        const struct forward_solves *solves, const double *load);

// Multiplications that a factor takes: to judge whether a new one is due.
double stiffness_work(const struct stiffness *stiffness);
