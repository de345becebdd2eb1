// SPDX-License-Identifier: GPL-3.0-or-later
// Where there is no equilibrium near the last one, dashpots at all pairs, in proportion
// to K, slow the grains, which are followed by implicit Euler steps,
//     B^T response(B u) + damping K (u - previous) = load,
// damping being viscosity over time step: large steps have little of it, and without
// any the step leads to equilibrium. A step that is found becomes history.
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

void roll_back_state(struct quasi_static *qs)
{
    memcpy(qs->displacement, qs->previous, (size_t)qs->n * sizeof *qs->displacement);
    memset(qs->dashpot_force, 0, (size_t)qs->n * sizeof *qs->dashpot_force);
}

// Steps grow 16-fold while they are found, and shrink 8-fold, to grow 2-fold, where one
// is not. False: no rest within the iterations, or without damping beyond STIFFEST.
static bool viscous_relaxation(struct quasi_static *qs)
{
    const double stiffest = 1e4, softest = 1e-2;
    double growth = 16;
    qs->damping = 1;
    roll_back_state(qs);
    for (int64_t k = 0; k < qs->setup.most_iterations && qs->damping <= stiffest; k++) {
        const bool found = qs->kinematics->solve(qs);
        if (found) {
            commit_state(qs);
            if (qs->damping == 0) return true;
            qs->damping = qs->damping > softest ? qs->damping / growth : 0;
            growth = 16;
        } else {
            qs->damping = fmax(8 * qs->damping, softest);
            growth = 2;
        }
        roll_back_state(qs);
    }
    qs->damping = 0;
    update_residual(qs);
    return false;
}

bool relax_to_equilibrium(struct quasi_static *qs)
{
    qs->damping = 0;
    if (qs->kinematics->solve(qs)) {
        commit_state(qs);
        return true;
    }
    if (!qs->is_unconverged) return viscous_relaxation(qs);
    roll_back_state(qs);
    update_residual(qs);
    return false;
}
