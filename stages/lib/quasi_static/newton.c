// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include <string.h>

// As everything is now; what slips, and begins to touch, is left to corrections. Then
// the bond alone is in the factor across the contact, or else the contact as if it
// stuck: so that a grain that slips wherever it touches is not free there. Nor where
// dashpots are to slow it that are like the factor, and its bond is soft by decades.
bool factor_tangent(struct quasi_static *qs)
{
    const double soft = 1e-4; // of the contact
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const enum contact_state state = qs->response[j].contact.state;
        const bool is_bonded = pair->is_bonded && !pair->is_detached;
        qs->factored[j] = (struct factored){state, is_bonded};
        if (state == CONTACT_NEW) qs->factored[j].state = CONTACT_STICKING;
        for (int k = 0; k < COMPONENTS; k++)
            qs->tangent[j][k] = is_bonded ? pair->bond_stiffness[k] : 0;
        if (state) qs->tangent[j][NORMAL] += pair->normal_stiffness;
        const bool is_held = qs->damping == 0 ||
                             pair->bond_stiffness[SHEAR] > soft * pair->shear_stiffness;
        const bool is_stiff =
            state && !(state == CONTACT_SLIPPING && is_bonded && is_held);
        for (int k = 0; k < 2 && is_stiff; k++)
            qs->tangent[j][SHEAR + k] += pair->shear_stiffness;
    }
    contact_solver_clear(qs->contacts);
    qs->factors++;
    return qs->kinematics->factor(qs);
}

// How many of a pair's deformations do not resist as the factor says when it is, bonded
// or not, in TOUCH.
static int changed_components(const struct quasi_static *qs, int j,
                              enum contact_state state)
{
    const struct contact_pair *pair = &qs->pair[j];
    const struct factored *factored = &qs->factored[j];
    if (factored->is_bonded && (!pair->is_bonded || pair->is_detached))
        return COMPONENTS;
    if (state == factored->state && state <= CONTACT_STICKING) return 0;
    return pair->shear_stiffness > 0 ? 3 : 1;
}

enum step_outcome { STEP_FOUND, TOO_MANY_ROWS, CONTACTS_UNSOLVED };

// Corrects pairs that are unlike the factor, here or where the deformations MORE lead,
// or if that is NULL as much again as the last load did, and once more. Whether there
// are new ones.
static enum step_outcome add_changed_pairs(struct quasi_static *qs,
                                           const double (*more)[COMPONENTS],
                                           bool *is_new)
{
    const int before = contact_solver_count(qs->contacts);
    int count = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        enum contact_state state = qs->response[j].contact.state;
        int components = changed_components(qs, j, state);
        if (components == 0) {
            double deformation[COMPONENTS];
            for (int k = 0; k < COMPONENTS; k++)
                deformation[k] = qs->deformation[j][k] +
                                 (more ? more[j][k] : 2 * qs->last_increment[j][k]);
            state = pair_respond(&qs->pair[j], deformation).contact.state;
            components = changed_components(qs, j, state);
        }
        if (components > 0) qs->changed[count++] = (struct pair_rows){j, components};
    }
    if (!contact_solver_add(qs->contacts, count, qs->changed)) return TOO_MANY_ROWS;
    *is_new = contact_solver_count(qs->contacts) > before;
    return STEP_FOUND;
}

// The step with those pairs corrected that are known to need it, beginning with GUESS
// of their deformations. In REST is what the factor alone has to balance.
static enum step_outcome solve_contacts(struct quasi_static *qs,
                                        const double (*guess)[COMPONENTS])
{
    const double compliance_factor = 1 / (1 + qs->damping);
    memcpy(qs->rhs, qs->residual, (size_t)qs->n * sizeof *qs->rhs);
    if (contact_solver_count(qs->contacts) > 0) {
        if (!contact_solver_solve(qs->contacts, qs->deformation, guess,
                                  compliance_factor, 1e-3 * qs->tolerance_now))
            return CONTACTS_UNSOLVED;
        contact_solver_subtract(qs->contacts, compliance_factor, qs->rhs);
    }
    stiffness_finish(qs->matrix, qs->step);
    deform_pairs(qs, qs->step, qs->increment);
    return STEP_FOUND;
}

// The step that balances all: pairs that it would change are corrected too, until
// there are no more.
static enum step_outcome find_step(struct quasi_static *qs)
{
    enum { ROUNDS = 10 };
    bool is_new;
    for (int i = 0; i < qs->n; i++)
        qs->residual[i] = displacement_scaled(1 / (1 + qs->damping), qs->residual[i]);
    stiffness_begin(qs->matrix, qs->residual);
    if (add_changed_pairs(qs, NULL, &is_new)) return TOO_MANY_ROWS;
    if (solve_contacts(qs, NULL)) return CONTACTS_UNSOLVED;
    for (int round = 0; round < ROUNDS; round++) {
        if (add_changed_pairs(qs, qs->increment, &is_new)) return TOO_MANY_ROWS;
        if (!is_new) break;
        if (solve_contacts(qs, qs->increment)) return CONTACTS_UNSOLVED;
    }
    return STEP_FOUND;
}

// One round: a step, or a new factor where the old one does not do. Whether it did
// anything.
bool newton_step(struct quasi_static *qs, bool *is_fresh)
{
    const enum step_outcome outcome = find_step(qs);
    if (qs->may_detach && (outcome == STEP_FOUND || *is_fresh) &&
        detach_beyond(qs, qs->step, small_limit))
        return true;
    if (outcome != STEP_FOUND) {
        if (*is_fresh || (qs->large && contact_solver_is_costly(qs->contacts)))
            return false;
        update_residual(qs);
        *is_fresh = true;
        return factor_tangent(qs);
    }
    if (qs->kinematics->adjust_step) qs->kinematics->adjust_step(qs);
    for (int i = 0; i < qs->n; i++) {
        displacement_subtract(&qs->displacement[i],
                              displacement_scaled(-1, qs->step[i]));
        displacement_subtract(&qs->dashpot_force[i],
                              displacement_scaled(-1, qs->rhs[i]));
    }
    update_residual(qs);
    qs->iterations++;
    return true;
}
