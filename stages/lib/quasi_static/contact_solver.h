// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs that do not resist as the factored stiffness says: bonds that broke since,
// contacts that opened, closed or slip.
//
// Under what is left to balance, r, grains move by K^-1 (r - B^T q), where K is what is
// factored and q by how much such pairs resist more than K says. Of q and their
// deformations, e = B K^-1 r - W q(e) with W = B K^-1 B^T, only these pairs know: a
// small dense system, solved by Newton's method, where that fails pair by pair in turn.
#ifndef CRAQUELURE_CONTACT_SOLVER_H
#define CRAQUELURE_CONTACT_SOLVER_H

#include "stiffness.h"

struct contact_solver;

// For N_PAIR pairs, of which TANGENT (n_pair) is in the factor of
// STIFFNESS; all are kept, not copied. The caller frees it with corrections_free.
struct contact_solver *contact_solver_create(struct stiffness *stiffness, int n_pair,
                                             const struct contact_pair *pair,
                                             const double (*tangent)[COMPONENTS]);
void contact_solver_free(struct contact_solver *solver);

// None, after a new factor.
void contact_solver_clear(struct contact_solver *solver);

// Of COUNT pairs the first COMPONENTS, unless they are in already. False: there are too
// many, and a new factor is due.
struct pair_rows {
    int32_t pair, count;
};
bool contact_solver_add(struct contact_solver *solver, int count,
                        const struct pair_rows *new);
int contact_solver_count(const struct contact_solver *solver); // of deformations

// Multiplications spent on dense systems since there were no corrections.
double contact_solver_work(const struct contact_solver *solver);
// Whether that is more than 100 factors take, and more than 1e10 (a second or two):
// then what is not found is not looked for in other ways.
bool contact_solver_is_costly(const struct contact_solver *solver);

// Finds q for grains that move on from DEFORMATION (n_pair) under the load that the
// stiffness has begun with, where SHARE of their answers counts; deformations to
// ENOUGH, beginning with GUESS (n_pair), or NULL: none. False: not found.
bool contact_solver_solve(struct contact_solver *solver,
                          const double (*deformation)[COMPONENTS],
                          const double (*guess)[COMPONENTS], double compliance_factor,
                          double enough);

// Takes B^T q off LEFT (n) and off what the stiffness has begun.
void contact_solver_subtract(const struct contact_solver *solver,
                             double compliance_factor, struct displacement *residual);

#endif
