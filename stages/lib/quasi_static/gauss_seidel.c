// SPDX-License-Identifier: GPL-3.0-or-later
// Nonlinear Gauss-Seidel (Jean 1999): pair after pair solves its own rows p,
//     e_p = given - f W_pp q_p(e_p),  given = e_p - residual_p + f W_pp q_p,
// exactly while the others keep their q, and the residual follows: de_p at p, and f W
// dq_p everywhere. Here e is the deformation, q the excess and f the compliance factor.
//
// It converges slowly. contact_solver.c calls it before the third and later tries of
// semismooth_newton, so that these begin from states of contact (open, stuck, sliding)
// that fit together. So it ends when no state changes, after ten sweeps at most.
#include "contact_solver_internal.h"

#include "return_mapping.h"

#include <math.h>
#include <string.h>

// Torsion and bending are linear.
static void solve_moments(const struct active_pair *active,
                          const struct local_problem *s, double x[3])
{
    double m[3][3], right[3];
    for (int k = 0; k < 3; k++) {
        right[k] = s->given[k];
        for (int l = 0; l < 3; l++)
            m[k][l] = (k == l) + s->compliance[k][l] * active->slope[3 + l][0];
    }
    if (solve_three(m, right)) memcpy(x, right, sizeof right);
}

// The local problem of components FIRST to END - 1.
static struct local_problem local_problem_of(const struct contact_solver *c,
                                             const struct active_pair *active,
                                             int first, int end,
                                             const double from[COMPONENTS])
{
    struct local_problem s = {.given = {0}};
    memcpy(s.from, from + first, sizeof s.from);
    memcpy(s.load, active->load + first, sizeof s.load);
    memcpy(s.tangent, c->tangent[active->pair] + first, sizeof s.tangent);
    for (int k = 0; k < end - first; k++) {
        const int row = active->row[first + k];
        s.given[k] = c->deformation[row] - c->residual[row];
        for (int l = 0; l < end - first; l++) {
            const int other = active->row[first + l];
            s.compliance[k][l] = c->compliance_factor * compliance_of(c, row)[other];
            s.given[k] += s.compliance[k][l] * c->excess[other];
        }
    }
    return s;
}

// Three components at most, from FIRST on.
static void return_pair(struct contact_solver *c, struct active_pair *active, int first,
                        double enough)
{
    const int count = active->count - first < 3 ? active->count - first : 3;
    const int *row = active->row + first;
    double most = 0, before[3] = {0}, more[3], deformation[3] = {0};
    for (int k = 0; k < count; k++) {
        most = fmax(most, fabs(c->residual[row[k]]));
        before[k] = deformation[k] = c->deformation[row[k]];
        more[k] = c->excess[row[k]];
    }
    if (most <= enough) return;
    const struct local_problem s =
        local_problem_of(c, active, first, first + count, c->from[active->pair]);
    if (first == 0)
        return_map(&c->pair[active->pair], &s, deformation);
    else
        solve_moments(active, &s, deformation);
    for (int k = 0; k < count; k++)
        c->deformation[row[k]] = deformation[k];
    update_pair_excess(c, active, false);
    for (int k = 0; k < count; k++) {
        c->residual[row[k]] += deformation[k] - before[k];
        add_compliance(c, row[k], c->excess[row[k]] - more[k], c->residual);
    }
}

void gauss_seidel(struct contact_solver *c, double enough)
{
    enum { SWEEPS = 10 };
    bool changed = true;
    update_contacts(c, false);
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = sweep == 0;
        for (int e = 0; e < c->n_active; e++) {
            struct active_pair *active = &c->active[e];
            const enum contact_state before = active->state;
            for (int first = 0; first < active->count; first += 3)
                return_pair(c, active, first, 0.5 * enough);
            changed |= active->state != before;
        }
        find_contact_residual(c); // without the rounding of sums
    }
    for (int e = 0; e < c->n_active; e++)
        update_augmentation(c, &c->active[e]);
}
