// SPDX-License-Identifier: GPL-3.0-or-later
#include "equilibrium_state.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct displacement nothing = {{0, 0, 0}, {0, 0, 0}};

void pull(struct displacement *sum, struct displacement load)
{
    sum->shift = subtract(sum->shift, load.shift);
    sum->turn = subtract(sum->turn, load.turn);
}

struct displacement scaled(double share, struct displacement a)
{
    return (struct displacement){scale(share, a.shift), scale(share, a.turn)};
}

// The strains that joints, as they lie, have when grains have MOVED (n).
static void strain_joints(const struct equilibrium *e, const struct displacement *moved,
                          double (*strain)[STRAINS])
{
    for (int j = 0; j < e->n_joint; j++) {
        const int32_t *grain = e->joint[j].grain;
        joint_strains(&e->joint[j], &moved[grain[0]],
                      grain[1] < 0 ? NULL : &moved[grain[1]], strain[j]);
    }
}

void strain_trial(struct equilibrium *e)
{
    strain_joints(e, e->trial, e->strain);
}

// What is left of the load at the trial.
void resist(struct equilibrium *e)
{
    for (int i = 0; i < e->n; i++) {
        e->left[i] = e->load[i];
        pull(&e->left[i], scaled(e->damping, e->dashpots[i]));
    }
    e->kind->resist(e);
    for (int i = 0; i < e->n; i++)
        if (e->setup.fixed[i] || e->is_gone[i]) e->left[i] = nothing;
}

double largest_left(const struct equilibrium *e)
{
    double most = 0;
    for (int i = 0; i < e->n; i++)
        most = fmax(most, size_of(e->left[i]));
    return most;
}

// ---- one step -----------------------------------------------------------------------

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

// What is marked leaves: its load counts no more, and nothing touches it.
void let_go(struct equilibrium *e, const bool *leaves)
{
    for (int i = 0; i < e->n; i++) {
        if (!leaves[e->fragments.of[i]] || e->is_gone[i]) continue;
        e->is_gone[i] = true;
        if (e->n_gone++ == 0) e->first_gone = i;
    }
    load_grains(e);
    for (int j = 0; j < e->n_joint; j++)
        for (int end = 0; end < 2; end++) {
            const int32_t grain = e->joint[j].grain[end];
            if (grain >= 0 && e->is_gone[grain]) e->joint[j].is_gone = true;
        }
    resist(e);
}

bool let_go_beyond(struct equilibrium *e, const struct displacement *moves, double most)
{
    bool *leaves = NEW_ARRAY(bool, e->n);
    bool any = false;
    for (int i = 0; i < e->n; i++) {
        const int fragment = e->fragments.of[i];
        if (e->is_gone[i] || e->fragments.is_held[fragment]) continue;
        if (!(size_of(moves[i]) <= most)) any = leaves[fragment] = true;
    }
    if (any) let_go(e, leaves);
    free(leaves);
    return any;
}

// ---- the way ------------------------------------------------------------------------

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

void keep_history(struct equilibrium *e)
{
    memcpy(e->before, e->trial, (size_t)e->n * sizeof *e->before);
    for (int j = 0; j < e->n_joint; j++) {
        for (int k = 0; k < STRAINS; k++)
            e->grown[j][k] = e->strain[j][k] - e->joint[j].strain[k];
        memcpy(e->joint[j].strain, e->strain[j], sizeof e->joint[j].strain);
        e->joint[j].contact = e->resistance[j].contact;
        if (e->joint[j].contact.touch == TOUCH_BEGINS)
            e->joint[j].contact.touch = TOUCH_STICKS;
    }
    if (e->kind->keep_history) e->kind->keep_history(e);
}

void go_back(struct equilibrium *e)
{
    memcpy(e->trial, e->before, (size_t)e->n * sizeof *e->trial);
    memset(e->dashpots, 0, (size_t)e->n * sizeof *e->dashpots);
}

int least_balanced(const struct equilibrium *e)
{
    int worst = 0;
    for (int i = 1; i < e->n; i++)
        if (size_of(e->left[i]) > size_of(e->left[worst])) worst = i;
    return worst;
}

// The way to rest with dashpots at all joints, by steps in time that grow as things
// come to rest and shrink where one cannot be found. Whether it came to rest.
static bool creep(struct equilibrium *e)
{
    const double stiffest = 1e4, softest = 1e-2;
    double growth = 16;
    e->damping = 1;
    go_back(e);
    for (int64_t k = 0; k < e->setup.most_iterations && e->damping <= stiffest; k++) {
        const bool found = e->kind->approach(e);
        if (found) {
            keep_history(e);
            if (e->damping == 0) return true;
            e->damping = e->damping > softest ? e->damping / growth : 0;
            growth = 16;
        } else {
            e->damping = fmax(8 * e->damping, softest);
            growth = 2;
        }
        go_back(e);
    }
    e->damping = 0;
    resist(e);
    return false;
}

bool come_to_rest(struct equilibrium *e)
{
    e->damping = 0;
    if (e->kind->approach(e)) {
        keep_history(e);
        return true;
    }
    if (!e->is_restless) return creep(e);
    go_back(e);
    resist(e);
    return false;
}
