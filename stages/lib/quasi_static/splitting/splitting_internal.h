// SPDX-License-Identifier: GPL-3.0-or-later
// Inside struct splitting, for the files of this folder only. Units of the engine.
#pragma once

#include "sparse/anderson_normal.h"
#include "splitting.h"

// Near pairs may touch: bonded ones, and others while their gap is small. They alone
// are in both matrices. NEAR is sorted.
struct splitting {
    bool *is_near; // (n_pair)
    int n_near;
    int32_t *near;              // (n_near) pairs
    double stiffness;           // rho, of the springs between grains and contacts
    double *force;              // (3 n_near) q
    double *change;             // (3 n_near) of q in an iteration
    double (*place)[3];         // (n_near) z, deformation by which the contact's law is
    double *dashpot;            // (n) E, of each grain
    struct displacement *right; // (n)
    struct displacement *part;  // (n) of a step
    struct stiffness *split;    // bonds, dashpots and rho: constant over iterations
    bool is_split_stale;
    double change_of_load;     // the largest residual when this load began
    struct stiffness *tangent; // as contacts are: Newton's method
    // What is factored last: (n_pair) of each component, and between both shears.
    double (*values)[COMPONENTS];
    double *across;
    struct anderson_normal of_forces, of_step;
};

// ---- contact_splitting.c ------------------------------------------------------------

// Begins at the state of the last equilibrium.
void begin_splitting(struct quasi_static *qs, struct splitting *s);
// Iterates until no spring between grain and contact carries more than ENOUGH. False:
// not within the iterations. The displacements are those of the grains; `place` that of
// the contacts.
bool split_contacts(struct quasi_static *qs, struct splitting *s, double enough);

// ---- coupled_newton.c ---------------------------------------------------------------

enum newton_dashpots { WITHOUT_DASHPOTS, WITH_DASHPOTS };

// Newton's method from the displacements on, the first step with the laws of the
// contacts at their places. False: not found; displacements have no meaning then.
bool coupled_newton(struct quasi_static *qs, struct splitting *s,
                    enum newton_dashpots dashpots);

// ---- near_pairs.c -------------------------------------------------------------------

// Freed with splitting_free.
struct splitting *splitting_create(struct quasi_static *qs);

// Pairs that have come near join the others; both matrices get a new pattern. False:
// none has.
bool add_near_pairs(struct quasi_static *qs, struct splitting *s);
