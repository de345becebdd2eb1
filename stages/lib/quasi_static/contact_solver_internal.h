// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct contact_solver, for the files that make it up only.
#ifndef CRAQUELURE_CONTACT_SOLVER_INTERNAL_H
#define CRAQUELURE_CONTACT_SOLVER_INTERNAL_H

#include "contact_solver.h"

#include <stddef.h>

// A pair and those of its deformations, from the first on, that have a row.
struct active_pair {
    int32_t pair;
    int count, row[COMPONENTS];
    double load[COMPONENTS];     // that it begins with
    double shear_force[2];       // of the shear spring, so far
    double overlap;              // so far; 0: open
    enum contact_state state;    // so far
    bool is_new;                 // since the last time
    double slope[COMPONENTS][3]; // of q with the first three deformations; of the
                                 // others, each with its own
};

struct row_group {
    int first; // row
    struct halves halves;
};

// W and the matrix have rows CAPACITY apart.
struct contact_solver {
    struct stiffness *stiffness;
    int n_pair;
    const struct contact_pair *pair;
    const double (*tangent)[COMPONENTS];
    const double (*from)[COMPONENTS]; // (n_pair) deformations that they go on from
    double compliance_factor;         // of the compliance that counts
    double work;                      // multiplications since there were none
    int n_active, active_capacity;
    struct active_pair *active;
    int *active_of; // (n_pair) the entry of each, or -1
    int n_group, group_capacity;
    struct row_group *group;
    int count, capacity;                   // rows
    int *active_of_row, *component_of_row; // (count)
    double *compliance;                    // W
    double *work_space;                    // (CAPACITY * DENSE_PANEL)
    double *matrix;                        // 1 + dq/de W of those that act, factored
    int *order;                            // of the matrix's rows, as pivots chose
    int n_acting, *acting;                 // rows
    int n_factored, *factored;             // those in the matrix
    double (*factored_slope)[3];           // (n_factored)
    double *deformation, *free_deformation, *excess; // e, B K^-1 r, q
    double *residual, *step, *rhs, *solution;
};

static inline double *compliance_of(const struct contact_solver *c, int row)
{
    return c->compliance + (size_t)row * (size_t)c->capacity;
}

// The loads at deformations as they are; those of springs that slip as Newton's method
// wants them (AUGMENTED) or as they are. Then what is left of e - B K^-1 r + W q(e):
// the largest of it.
void update_pair_excess(struct contact_solver *c, struct active_pair *active,
                        bool is_augmented);
// Of the loads as they are: what the shear spring pulls with beside the bond.
void update_augmentation(const struct contact_solver *c, struct active_pair *active);
double find_contact_residual(struct contact_solver *c);
double update_contacts(struct contact_solver *c, bool is_augmented);

// Adds W MORE in ROW to SUM (count).
void add_compliance(const struct contact_solver *c, int row, double more, double *sum);

// Newton's method from deformations as they are: whether it is found, to ENOUGH.
bool semismooth_newton(struct contact_solver *c, bool is_augmented, double enough);

// Pairs in turn, each exactly while the others push as they do: as long as that brings
// something, and no further than to ENOUGH.
void gauss_seidel(struct contact_solver *c, double enough);

#endif
