// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include <string.h>

// As everything is now; what slips, and begins to touch, is left to corrections. Then
// the bond alone is in the factor across the contact, or else the contact as if it
// stuck: so that a grain that slips wherever it touches is not free there. Nor where
// dashpots are to slow it that are like the factor, and its bond is soft by decades.
bool factor(struct equilibrium *e)
{
    const double soft = 1e-4; // of the contact
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const enum touch touch = e->resistance[j].contact.touch;
        const bool is_bonded = joint->is_bonded && !joint->is_gone;
        e->factored[j] = (struct factored){touch, is_bonded};
        if (touch == TOUCH_BEGINS) e->factored[j].touch = TOUCH_STICKS;
        for (int k = 0; k < STRAINS; k++)
            e->tangent[j][k] = is_bonded ? joint->bond_stiffness[k] : 0;
        if (touch) e->tangent[j][STRAIN_ALONG] += joint->contact_along;
        const bool is_held = e->damping == 0 || joint->bond_stiffness[STRAIN_ACROSS] >
                                                    soft * joint->contact_across;
        const bool is_stiff = touch && !(touch == TOUCH_SLIPS && is_bonded && is_held);
        for (int k = 0; k < 2 && is_stiff; k++)
            e->tangent[j][STRAIN_ACROSS + k] += joint->contact_across;
    }
    corrections_clear(e->corrections);
    e->factors++;
    return e->kind->factor(e);
}

// How many of a joint's strains do not resist as the factor says when it is, bonded or
// not, in TOUCH.
static int strains_unlike(const struct equilibrium *e, int j, enum touch touch)
{
    const struct joint *joint = &e->joint[j];
    const struct factored *factored = &e->factored[j];
    if (factored->is_bonded && (!joint->is_bonded || joint->is_gone)) return STRAINS;
    if (touch == factored->touch && touch <= TOUCH_STICKS) return 0;
    return joint->contact_across > 0 ? 3 : 1;
}

enum outcome { FOUND, TOO_MANY, STUCK };

// Corrects joints that are unlike the factor, here or where the strains MORE lead, or
// if that is NULL as much again as the last load did, and once more. Whether there are
// new ones.
static enum outcome include_joints(struct equilibrium *e, const double (*more)[STRAINS],
                                   bool *is_new)
{
    const int before = corrections_count(e->corrections);
    int count = 0;
    for (int j = 0; j < e->n_joint; j++) {
        enum touch touch = e->resistance[j].contact.touch;
        int strains = strains_unlike(e, j, touch);
        if (strains == 0) {
            double strain[STRAINS];
            for (int k = 0; k < STRAINS; k++)
                strain[k] = e->strain[j][k] + (more ? more[j][k] : 2 * e->grown[j][k]);
            touch = joint_resistance(&e->joint[j], strain).contact.touch;
            strains = strains_unlike(e, j, touch);
        }
        if (strains > 0) e->unlike[count++] = (struct correction){j, strains};
    }
    if (!corrections_add(e->corrections, count, e->unlike)) return TOO_MANY;
    *is_new = corrections_count(e->corrections) > before;
    return FOUND;
}

// The step with those joints corrected that are known to need it, beginning with GUESS
// of their strains. In REST is what the factor alone has to balance.
static enum outcome correct_step(struct equilibrium *e, const double (*guess)[STRAINS])
{
    const double share = 1 / (1 + e->damping);
    memcpy(e->rest, e->left, (size_t)e->n * sizeof *e->rest);
    if (corrections_count(e->corrections) > 0) {
        if (!corrections_find(e->corrections, e->strain, guess, share,
                              1e-3 * e->enough))
            return STUCK;
        corrections_take_off(e->corrections, share, e->rest);
    }
    stiffness_finish(e->matrix, e->step);
    strain_joints(e, e->step, e->more);
    return FOUND;
}

// The step that balances all: joints that it would change are corrected too, until
// there are no more.
static enum outcome find_step(struct equilibrium *e)
{
    enum { ROUNDS = 10 };
    bool is_new;
    for (int i = 0; i < e->n; i++)
        e->left[i] = scaled(1 / (1 + e->damping), e->left[i]);
    stiffness_begin(e->matrix, e->left);
    if (include_joints(e, NULL, &is_new)) return TOO_MANY;
    if (correct_step(e, NULL)) return STUCK;
    for (int round = 0; round < ROUNDS; round++) {
        if (include_joints(e, e->more, &is_new)) return TOO_MANY;
        if (!is_new) break;
        if (correct_step(e, e->more)) return STUCK;
    }
    return FOUND;
}

// One round: a step, or a new factor where the old one does not do. Whether it did
// anything.
bool improve(struct equilibrium *e, bool *is_fresh)
{
    const enum outcome outcome = find_step(e);
    if (e->may_leave && (outcome == FOUND || *is_fresh) &&
        let_go_beyond(e, e->step, furthest))
        return true;
    if (outcome != FOUND) {
        if (*is_fresh || (e->large && corrections_are_costly(e->corrections)))
            return false;
        resist(e);
        *is_fresh = true;
        return factor(e);
    }
    if (e->kind->take) e->kind->take(e);
    for (int i = 0; i < e->n; i++) {
        pull(&e->trial[i], scaled(-1, e->step[i]));
        pull(&e->dashpots[i], scaled(-1, e->rest[i]));
    }
    resist(e);
    e->iterations++;
    return true;
}
