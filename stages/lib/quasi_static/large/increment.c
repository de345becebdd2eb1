// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_state.h"

#include "quasi_static/quasi_static_internal.h"

#include <math.h>

// Mean radii that a grain may move in an increment, so that others do not pass it.
static const double stride = 0.5;

// The furthest that a grain or a joint has turned, or grains came closer, since the
// last equilibrium.
static double furthest_since(const struct equilibrium *e)
{
    double most = 0;
    for (int i = 0; i < e->n; i++) {
        const struct displacement since = since_before(e, i);
        const double way = norm(since.shift) * e->setup.increment / stride;
        const double size = fmax(norm(since.turn), way);
        if (!e->is_gone[i] && !(size <= most)) most = size;
    }
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const struct vector *before = e->large->before[j].axis;
        const double turned = distance(e->large->now[j].axis[0], before[0]);
        const double closer =
            fabs(e->strain[j][STRAIN_ALONG] - joint->strain[STRAIN_ALONG]);
        const double size = fmax(turned, closer);
        if (!joint->is_gone && !(size <= most)) most = size;
    }
    return most;
}

// Newton's method goes astray before it goes so far, or where numbers end.
static bool is_astray(const struct equilibrium *e)
{
    double sum = 0;
    for (int i = 0; i < e->n; i++)
        sum += norm(e->left[i].shift) + norm(e->left[i].turn) +
               norm(e->trial[i].shift) + norm(e->trial[i].turn);
    return !isfinite(sum) || !(furthest_since(e) <= 4 * e->setup.increment);
}

bool large_approach(struct equilibrium *e)
{
    enum { ROUNDS = 60 };
    const double slow = 0.1;
    resist(e);
    e->enough = e->setup.tolerance * e->largest_load;
    if (e->damping > 0) e->enough = fmax(e->enough, 1e-3 * largest_left(e));
    const double well = (e->damping > 0 ? 1 : well_below) * e->enough;
    bool is_fresh = e->large->is_stale || e->damping > 0;
    if (is_astray(e)) return false;
    if (is_fresh && !factor(e)) return false;
    e->large->is_stale = false;
    anderson_begin(&e->large->acceleration, 6 * e->n);
    double before = INFINITY;
    int since = 0, patience = 1; // rounds with one factor
    for (int round = 0; round < ROUNDS; round++) {
        const double left = largest_left(e);
        if (left <= well || (left <= e->enough && left >= slow * before)) return true;
        if (left > slow * before && since >= patience) {
            is_fresh = true;
            since = 0;
            patience *= 4;
            if (!factor(e)) return false;
        }
        before = left;
        if (!improve(e, &is_fresh) || is_astray(e)) return false;
        is_fresh = false;
        since++;
    }
    resist(e);
    return largest_left(e) <= e->enough;
}

// One whose dense systems take as long as others altogether counts as so many more.
static void note_try(struct equilibrium *e)
{
    const double usual = 4e7; // multiplications
    e->large->tried += 1 + corrections_work(e->corrections) / usual;
    if (e->setup.report) e->setup.report(e->setup.context, e->large->balanced);
}

enum advance large_advance(struct equilibrium *e, double damping, double *moved)
{
    go_back(e);
    e->damping = damping;
    e->large->is_unstable = false;
    *moved = 4; // if it is not known
    const bool is_found = large_approach(e);
    note_try(e);
    if (!is_found) return e->large->is_unstable ? UNSTABLE : NOT_FOUND;
    *moved = furthest_since(e) / e->setup.increment;
    if (*moved > 1) return TOO_FAR;
    if (large_meet(e)) return MEETS;
    if (damping > 0) return ADVANCED;
    return factor(e) && (!e->setup.is_free || free_is_stable(e)) ? ADVANCED : UNSTABLE;
}
