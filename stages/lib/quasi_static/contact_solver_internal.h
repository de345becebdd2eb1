// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct corrections, for the files that make it up only.
#ifndef CRAQUELURE_CONTACT_SOLVER_INTERNAL_H
#define CRAQUELURE_CONTACT_SOLVER_INTERNAL_H

#include "contact_solver.h"

#include <stddef.h>

// A joint and those of its strains, from the first on, that have a row.
struct entry {
    int32_t joint;
    int count, row[STRAINS];
    double load[STRAINS];     // that it begins with
    double pull[2];           // of the shear spring, so far
    double overlap;           // so far; 0: open
    enum touch touch;         // so far
    bool is_new;              // since the last time
    double slope[STRAINS][3]; // of q with the first three strains; of the others, each
                              // with its own
};

struct addition {
    int first; // row
    struct halves halves;
};

// W and the matrix have rows CAPACITY apart.
struct corrections {
    struct stiffness *stiffness;
    int n_joint;
    const struct joint *joint;
    const double (*tangent)[STRAINS];
    const double (*from)[STRAINS]; // (n_joint) strains that they go on from
    double share;                  // of the compliance that counts
    double work;                   // multiplications since there were none
    int n_entry, entry_capacity;
    struct entry *entry;
    int *of; // (n_joint) the entry of each, or -1
    int n_addition, addition_capacity;
    struct addition *addition;
    int count, capacity;            // rows
    int *entry_of, *strain_of;      // (count)
    double *compliance;             // W
    double *work_space;             // (CAPACITY * DENSE_PANEL)
    double *matrix;                 // 1 + dq/de W of those that act, factored
    int *order;                     // of the matrix's rows, as pivots chose
    int n_acting, *acting;          // rows
    int n_factored, *factored;      // those in the matrix
    double (*factored_slope)[3];    // (n_factored)
    double *strain, *linear, *more; // e, B K^-1 r, q
    double *left, *step, *right, *answer;
};

static inline double *compliance_of(const struct corrections *c, int row)
{
    return c->compliance + (size_t)row * (size_t)c->capacity;
}

// The loads at strains as they are; those of springs that slip as Newton's method wants
// them (SOFTENED) or as they are. Then what is left of e - B K^-1 r + W q(e): the
// largest of it.
void resist_entry(struct corrections *c, struct entry *entry, bool softened);
// Of the loads as they are: what the shear spring pulls with beside the bond.
void note_pull(const struct corrections *c, struct entry *entry);
double find_left(struct corrections *c);
double resist_entries(struct corrections *c, bool softened);

// Adds W MORE in ROW to SUM (count).
void add_answer(const struct corrections *c, int row, double more, double *sum);

// Newton's method from strains as they are: whether it is found, to ENOUGH.
bool settle_together(struct corrections *c, bool softened, double enough);

// Joints in turn, each exactly while the others push as they do: as long as that brings
// something, and no further than to ENOUGH.
void settle_in_turn(struct corrections *c, double enough);

#endif
