// SPDX-License-Identifier: GPL-3.0-or-later
// Inside struct contact_solver, for its own files only. Symbols as in contact_solver.c:
//     e = free_deformation - f W q(e),  W = B K^-1 B^T,  f the compliance factor.
// Rows are numbered as they were activated; those of one pair need not lie together.
#pragma once

#include "contact_solver.h"

#include <stddef.h>

// A pair, and the rows of its components, from the first on. A pair whose law is no
// longer that of its tangent in K: it has opened, closed or slipped since. A component
// that K has right has no row.
struct active_pair {
    int32_t pair;
    int count, row[COMPONENTS];
    double load[COMPONENTS];     // at `from`
    double shear_force[2];       // the augmented state, so far
    double overlap;              // the same; 0: open
    enum contact_state state;    // so far
    bool is_new;                 // since the last time
    double slope[COMPONENTS][3]; // dq/de with the first three components; of the
                                 // moments, each with its own
};

// Up to BATCH rows that were activated together, with their L^-1 B^T.
struct row_group {
    int first; // row
    struct forward_solves solves;
};

// It owns all but STIFFNESS, PAIR, TANGENT and FROM. Arrays without a shape are of
// `count` rows, with room for CAPACITY. W and the matrix have rows CAPACITY apart.
// Units of the engine.
struct contact_solver {
    struct stiffness *stiffness;
    int n_pair, most_rows;
    const struct contact_pair *pair;
    const double (*tangent)[COMPONENTS];
    const double (*from)[COMPONENTS]; // (n_pair) deformation, e = 0
    double compliance_factor;         // f
    double work;                      // multiplications since no pair was active
    int n_active, active_capacity;
    struct active_pair *active;
    int *active_of; // (n_pair) in ACTIVE, or -1
    int n_group, group_capacity;
    struct row_group *group;
    int count, capacity;                   // rows
    int *active_of_row, *component_of_row; // (count)
    double *compliance;                    // W
    double *work_space;                    // (CAPACITY * DENSE_PANEL)
    double *matrix;                        // 1 + dq/de f W of the acting rows, factored
    int *order;                            // of its rows, by pivots
    int n_acting, *acting;                 // rows where dq/de is not 0
    int n_factored, *factored;             // those in the matrix
    double (*factored_slope)[3];           // (n_factored)
    double *deformation, *free_deformation, *excess; // e, B K^-1 r, q(e)
    double *residual, *step, *rhs, *solution;
};

// Row ROW of W.
static inline double *compliance_of(const struct contact_solver *c, int row)
{
    return c->compliance + (size_t)row * (size_t)c->capacity;
}

// The excess load and its slope at the present deformation, of one pair or of all; by
// augmented springs or by the contacts' own. The residual e - free_deformation + f W q;
// the largest of it is returned.
void update_pair_excess(struct contact_solver *c, struct active_pair *active,
                        bool is_augmented);
// The augmented state becomes the present force of the shear spring, and overlap.
void update_augmentation(const struct contact_solver *c, struct active_pair *active);
double find_contact_residual(struct contact_solver *c);
double update_contacts(struct contact_solver *c, bool is_augmented);

// Adds f W times MORE in ROW to SUM (count).
void add_compliance(const struct contact_solver *c, int row, double more, double *sum);

// Newton's method from the present deformation on. False: no residual below ENOUGH.
// ENOUGH is for the largest component of the residual.
bool semismooth_newton(struct contact_solver *c, bool is_augmented, double enough);

// Sweeps over the pairs, each of which is solved exactly while the others keep their
// loads, to half of ENOUGH; until no contact changes its state, ten at most.
void gauss_seidel(struct contact_solver *c, double enough);
