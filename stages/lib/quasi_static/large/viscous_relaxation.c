// SPDX-License-Identifier: GPL-3.0-or-later
// Where there is no equilibrium near the last one, dashpots slow the grains, which are
// followed by implicit Euler steps,
//     B^T response(B u) + damping K (u - previous) = load,
// damping being viscosity over time step: large steps have little of it, and without
// any the step leads to equilibrium. A step that is found becomes history.
#include "../quasi_static_internal.h"

#include <math.h>

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

// False: no rest within the iterations, or no step with the stiffest dashpots; the
// caller rolls back.
static bool viscous_relaxation(struct quasi_static *qs)
{
    struct pace pace = {.growth = 16, .missed = INFINITY};
    qs->damping = 1;
    roll_back_state(qs);
    for (int64_t k = 0; k < qs->setup.most_iterations && qs->damping <= STIFFEST; k++) {
        if (qs->kinematics->solve(qs)) {
            pace.carried = largest_dashpot_load(qs);
            commit_state(qs);
            if (qs->damping == 0) return true;
            lengthen(qs, &pace);
        } else {
            shorten(qs, &pace);
        }
        roll_back_state(qs);
    }
    return false;
}

bool relax_to_equilibrium(struct quasi_static *qs)
{
    qs->damping = 0;
    if (qs->kinematics->solve(qs)) {
        commit_state(qs);
        return true;
    }
    if (!qs->is_unconverged && viscous_relaxation(qs)) return true;
    qs->damping = 0;
    roll_back_state(qs);
    update_residual(qs);
    return false;
}
