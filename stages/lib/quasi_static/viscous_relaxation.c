// SPDX-License-Identifier: GPL-3.0-or-later
// Where there is no equilibrium near the last one, dashpots slow the grains, which are
// followed by implicit Euler steps,
//     B^T response(B u) + damping (K + c) (u - previous) = load,
// damping being viscosity over time step: large steps have little of it, and without
// any the step leads to equilibrium. A step that is found becomes history.
//
// Dashpots at pairs, in proportion to K, do not slow a grain that touches nothing, or
// rolls. So each grain also has a dashpot c of its own, much softer than any pair.
#include "quasi_static_internal.h"

#include <math.h>
#include <string.h>

void commit_state(struct quasi_static *qs)
{
    memcpy(qs->previous, qs->displacement, (size_t)qs->n * sizeof *qs->previous);
    for (int j = 0; j < qs->n_pair; j++) {
        for (int k = 0; k < COMPONENTS; k++)
            qs->last_increment[j][k] =
                qs->deformation[j][k] - qs->pair[j].deformation[k];
        memcpy(qs->pair[j].deformation, qs->deformation[j],
               sizeof qs->pair[j].deformation);
        qs->pair[j].contact = qs->response[j].contact;
        if (qs->pair[j].contact.state == CONTACT_NEW)
            qs->pair[j].contact.state = CONTACT_STICKING;
    }
    if (qs->kinematics->commit) qs->kinematics->commit(qs);
}

// A far place would not have been reached: what takes grains there breaks before.
void commit_equilibrium(struct quasi_static *qs)
{
    for (int i = 0; i < qs->n && !qs->large; i++)
        if (!qs->is_detached[i] &&
            !(displacement_size(qs->displacement[i]) <= SMALL_LIMIT))
            return;
    commit_state(qs);
}

void roll_back_state(struct quasi_static *qs)
{
    memcpy(qs->displacement, qs->previous, (size_t)qs->n * sizeof *qs->displacement);
    memset(qs->dashpot_force, 0, (size_t)qs->n * sizeof *qs->dashpot_force);
}

// How long the steps in time are.
struct pace {
    double growth;  // of the next
    double found;   // damping of the last that was found
    double carried; // by dashpots, at the end of it
    double missed;  // by dashpots, when equilibrium was last sought in vain
};
static const double STIFFEST = 1e4, SOFTEST = 1e-12;

// Steps grow 16-fold while they are found. Without dashpots Newton's method fails where
// grains have far to go, and that costs more than a step: so equilibrium is sought when
// steps are long and dashpots carry a tenth of what they did the last time.
static void lengthen(struct quasi_static *qs, struct pace *pace)
{
    const double long_enough = 1e-2, less = 0.1;
    pace->found = qs->damping;
    qs->damping /= pace->growth;
    pace->growth = 16;
    const bool is_near =
        pace->found <= long_enough && pace->carried <= less * pace->missed;
    if (is_near || qs->damping < SOFTEST) qs->damping = 0;
}

// One that is not found shrinks 8-fold, and then grows 2-fold.
static void shorten(struct quasi_static *qs, struct pace *pace)
{
    if (qs->damping > 0) {
        qs->damping *= 8;
        pace->growth = 2;
        return;
    }
    pace->missed = pace->carried;
    qs->damping = pace->found / pace->growth;
    if (qs->damping < SOFTEST) qs->damping = INFINITY;
}

// Whether something held would move further than is small: it slides without end, and
// longer steps only take it further. What is not a number goes on, to be reported.
static bool slides_away(const struct quasi_static *qs)
{
    for (int i = 0; i < qs->n && !qs->large; i++)
        if (qs->fragments.is_held[qs->fragments.of[i]] && !qs->is_detached[i] &&
            displacement_size(qs->displacement[i]) > SMALL_LIMIT)
            return true;
    return false;
}

// False: no rest within the iterations, or no step with the stiffest dashpots; the
// caller rolls back.
static bool viscous_relaxation(struct quasi_static *qs)
{
    struct pace pace = {.growth = 16, .missed = INFINITY};
    qs->damping = 1;
    roll_back_state(qs);
    for (int64_t k = 0; k < qs->setup.most_iterations && qs->damping <= STIFFEST; k++) {
        if (qs->kinematics->solve(qs)) {
            if (qs->damping > 0 && slides_away(qs)) break;
            if (qs->damping == 0) {
                commit_equilibrium(qs);
                return true;
            }
            pace.carried = largest_dashpot_load(qs);
            commit_state(qs);
            lengthen(qs, &pace);
        } else {
            shorten(qs, &pace);
        }
        roll_back_state(qs);
    }
    return false;
}

// Where too many contacts change for Newton's method, the splitting is for them.
bool relax_to_equilibrium(struct quasi_static *qs)
{
    qs->damping = 0;
    if (qs->kinematics->solve(qs)) {
        commit_equilibrium(qs);
        return true;
    }
    const bool too_many = has_splitting(qs) && contact_solver_is_full(qs->contacts);
    if (!qs->is_unconverged && !too_many && viscous_relaxation(qs)) return true;
    qs->damping = 0;
    roll_back_state(qs);
    update_residual(qs);
    return false;
}

bool relax_with_most_rows(struct quasi_static *qs)
{
    contact_solver_set_most_rows(qs->contacts, MOST_ROWS);
    const bool rests = viscous_relaxation(qs);
    contact_solver_set_most_rows(qs->contacts, MOST_ROWS_WITH_FRICTION);
    qs->damping = 0;
    if (!rests) roll_back_state(qs);
    return rests;
}
