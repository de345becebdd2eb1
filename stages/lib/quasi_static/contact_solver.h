// SPDX-License-Identifier: GPL-3.0-or-later
// The contact problem: pairs that do not respond as the factored stiffness K says, as
// their bonds broke since, or their contacts opened, closed or slip.
//
// Under a residual r grains move by K^-1 (r - B^T q), where q is the excess of the
// loads of such pairs. Their deformations e = B K^-1 r - W q(e), W = B K^-1 B^T, depend
// on these pairs only: a small dense system, solved by a semismooth Newton method, and
// where that fails with the help of nonlinear Gauss-Seidel sweeps.
//
// A round of its use, for a factor that stays:
//     contact_solver_add        pairs whose law is no longer their tangent's
//     stiffness_begin           the residual as a load
//     contact_solver_solve      q of these pairs; false: make a new factor
//     contact_solver_subtract   takes B^T q off
//     stiffness_finish          the step of all grains
//     contact_solver_clear      after stiffness_factor
// A row costs one forward solve on its reach, W of m rows m^2 products of these, a
// solution O(m^3) for each matrix of Newton's method. Rows stay until they are cleared.
#pragma once

#include "stiffness.h"

struct contact_solver;

// For N_PAIR pairs, of which TANGENT (n_pair) is in the factor of STIFFNESS; all are
// kept, not copied. Of at most MOST ROWS. The caller frees it with contact_solver_free.
struct contact_solver *contact_solver_create(struct stiffness *stiffness, int n_pair,
                                             const struct contact_pair *pair,
                                             const double (*tangent)[COMPONENTS],
                                             int most_rows);
void contact_solver_free(struct contact_solver *solver);

// No pair is active: after a new factor.
void contact_solver_clear(struct contact_solver *solver);

// Activates COUNT pairs, of each the first so many components. False: there would be
// too many rows, and a new factor is due.
struct pair_rows {
    int32_t pair, count;
};

// On false those that fit are there.
bool contact_solver_add(struct contact_solver *solver, int count,
                        const struct pair_rows *new);
int contact_solver_count(const struct contact_solver *solver); // of rows

// From now on at most MOST ROWS; more that are there already stay.
void contact_solver_set_most_rows(struct contact_solver *solver, int most_rows);

// Whether there is no room for more of them.
bool contact_solver_is_full(const struct contact_solver *solver);

// Multiplications since no pair was active.
double contact_solver_work(const struct contact_solver *solver);
// Whether these are more than 100 factors take, and more than 1e10 (a second or two):
// then a solution that is not found is not looked for in other ways.
bool contact_solver_is_costly(const struct contact_solver *solver);

// Finds q for grains that move on from DEFORMATION (n_pair) under the load that the
// stiffness has begun with; W counts COMPLIANCE FACTOR times. The error of the
// deformations is at most ENOUGH. Begins at GUESS (n_pair); NULL: 0. False: not found.
bool contact_solver_solve(struct contact_solver *solver,
                          const double (*deformation)[COMPONENTS],
                          const double (*guess)[COMPONENTS], double compliance_factor,
                          double enough);

// Subtracts COMPLIANCE FACTOR times B^T q from RESIDUAL (n) and from the load that the
// stiffness has begun with.
void contact_solver_subtract(const struct contact_solver *solver,
                             double compliance_factor, struct displacement *residual);
