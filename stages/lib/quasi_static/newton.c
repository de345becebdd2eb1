// SPDX-License-Identifier: GPL-3.0-or-later
// One step of Newton's method for the displacements u,
//     residual(u) = load - damping dashpot_force - B^T response(B u) = 0.
// K is the tangent as it was last factored, B^T tangent B. Dashpots at pairs have
// damping K, those of grains damping c, so that (1 + damping) (K + damping/(1 +
// damping) c) is factored. Pairs whose response has changed since carry an excess load
// q [contact_solver.h]:
//     K step = rhs = (residual - B^T q(B step)) / (1 + damping)
// and the dashpot force, which is K (u - previous), grows by rhs less the share of c. A
// pair that the step changes is active from then on, and the step is found again.
#include "quasi_static_internal.h"

#include <string.h>

// All pairs as they are now; slip is left to the contact solver. Across a contact that
// slips K has the bond alone, or where there is none the contact as if it stuck: else a
// grain that slips wherever it touches would be free. So too where the bond is softer
// by decades and dashpots, which are like K, are to slow the slip.
bool factor_tangent(struct quasi_static *qs)
{
    const double soft = 1e-4; // of the contact
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const enum contact_state state = qs->response[j].contact.state;
        qs->factored[j] = pair_as_factored(qs, j);
        const bool is_bonded = qs->factored[j].is_bonded;
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

// How many components of pair J do not respond as K says when its contact is in
// STATE.
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

// Whether frictionless_step costs less than the dense system of COUNT rows, R^3 / 3
// multiplications; it takes some factors of K until few pairs change.
static bool are_many_without_friction(const struct quasi_static *qs, double count)
{
    const double least = 128, factors = 0.1;
    return is_frictionless(qs) && !(qs->damping > 0) && count > least &&
           count * count * count / 3 > factors * stiffness_work(qs->matrix);
}

enum step_outcome { STEP_FOUND, TOO_MANY_ROWS, CONTACTS_UNSOLVED };

// Activates pairs that have changed, here or after MORE of deformation; NULL: after
// twice the last increment. IS NEW: whether there were any that were not active.
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
    if (are_many_without_friction(qs, count)) return TOO_MANY_ROWS;
    if (!contact_solver_add(qs->contacts, count, qs->changed)) return TOO_MANY_ROWS;
    *is_new = contact_solver_count(qs->contacts) > before;
    return STEP_FOUND;
}

// The step with the pairs that are active, beginning at GUESS of their deformation.
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

// The step, with all pairs active that it changes.
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

bool newton_step(struct quasi_static *qs, bool *is_fresh)
{
    const enum step_outcome outcome = find_step(qs);
    if (qs->may_detach && (outcome == STEP_FOUND || *is_fresh) &&
        detach_beyond(qs, qs->step, SMALL_LIMIT))
        return true;
    if (outcome != STEP_FOUND) {
        if (*is_fresh || (qs->large && contact_solver_is_costly(qs->contacts)))
            return false;
        update_residual(qs);
        *is_fresh = true;
        return factor_tangent(qs);
    }
    if (qs->kinematics->adjust_step) qs->kinematics->adjust_step(qs);
    const double dashpot = dashpot_in_stiffness(qs);
    leave_detached_grains(qs);
    for (int i = 0; i < qs->n; i++) {
        displacement_subtract(&qs->displacement[i],
                              displacement_scaled(-1, qs->step[i]));
        displacement_subtract(&qs->rhs[i], displacement_scaled(dashpot, qs->step[i]));
        displacement_subtract(&qs->dashpot_force[i],
                              displacement_scaled(-1, qs->rhs[i]));
    }
    update_residual(qs);
    qs->iterations++;
    return true;
}
