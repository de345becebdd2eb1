// SPDX-License-Identifier: GPL-3.0-or-later
// Joints that do not resist as the factored stiffness says: bonds that broke since,
// contacts that opened, closed or slip.
//
// Under what is left to balance, r, grains move by K^-1 (r - B^T q), where K is what is
// factored and q by how much such joints resist more than K says. Of q and their
// strains, e = B K^-1 r - W q(e) with W = B K^-1 B^T, only these joints know: a small
// dense system, solved by Newton's method, where that fails joint by joint in turn.
#ifndef CRAQUELURE_CONTACT_SOLVER_H
#define CRAQUELURE_CONTACT_SOLVER_H

#include "stiffness.h"

struct corrections;

// For N_JOINT joints, of which TANGENT (n_joint) is in the factor of
// STIFFNESS; all are kept, not copied. The caller frees it with corrections_free.
struct corrections *corrections_new(struct stiffness *stiffness, int n_joint,
                                    const struct joint *joint,
                                    const double (*tangent)[STRAINS]);
void corrections_free(struct corrections *corrections);

// None, after a new factor.
void corrections_clear(struct corrections *corrections);

// Of COUNT joints the first STRAINS, unless they are in already. False: there are too
// many, and a new factor is due.
struct correction {
    int32_t joint, strains;
};
bool corrections_add(struct corrections *corrections, int count,
                     const struct correction *new);
int corrections_count(const struct corrections *corrections); // of strains

// Multiplications spent on dense systems since there were no corrections.
double corrections_work(const struct corrections *corrections);
// Whether that is more than 100 factors take, and more than 1e10 (a second or two):
// then what is not found is not looked for in other ways.
bool corrections_are_costly(const struct corrections *corrections);

// Finds q for grains that move on from STRAIN (n_joint) under the load that the
// stiffness has begun with, where SHARE of their answers counts; strains to ENOUGH,
// beginning with GUESS (n_joint), or NULL: none. False: not found.
bool corrections_find(struct corrections *corrections, const double (*strain)[STRAINS],
                      const double (*guess)[STRAINS], double share, double enough);

// Takes B^T q off LEFT (n) and off what the stiffness has begun.
void corrections_take_off(const struct corrections *corrections, double share,
                          struct displacement *left);

#endif
