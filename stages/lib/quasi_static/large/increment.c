// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on the present geometry, with the tangent and frames as they were
// last factored, and Anderson acceleration of the steps: a new factor when the residual
// does not fall to a tenth in a step, after 1, 4, 16, ... steps with the old one. Then:
// how far the increment led, whether grains have come to touch, and whether the tangent
// there is positive definite, that is, whether equilibrium is stable.
#include "increment.h"
#include "contact_detection.h"
#include "softest_mode.h"

#include <math.h>

// Mean radii that a grain may move in an increment, so that others do not pass it.
static const double STRIDE = 0.5;

// The largest rotation of a grain or pair since the last equilibrium, and approach of
// grains; translations count as STRIDE over what an increment may turn.
static double furthest_since(const struct quasi_static *qs)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++) {
        const struct displacement since = displacement_since_previous(qs, i);
        const double translated =
            norm(since.translation) * qs->setup.increment / STRIDE;
        const double size = fmax(norm(since.rotation), translated);
        if (!qs->is_detached[i] && !(size <= most)) most = size;
    }
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const struct vector *before = qs->large->previous[j].axis;
        const double turned = distance(qs->large->current[j].axis[0], before[0]);
        const double closer =
            fabs(qs->deformation[j][NORMAL] - pair->deformation[NORMAL]);
        const double size = fmax(turned, closer);
        if (!pair->is_detached && !(size <= most)) most = size;
    }
    return most;
}

// Newton's method does not converge from so far, nor from numbers that are none.
static bool is_astray(const struct quasi_static *qs)
{
    double sum = 0;
    for (int i = 0; i < qs->n; i++)
        sum += norm(qs->residual[i].translation) + norm(qs->residual[i].rotation) +
               norm(qs->displacement[i].translation) +
               norm(qs->displacement[i].rotation);
    return !isfinite(sum) || !(furthest_since(qs) <= 4 * qs->setup.increment);
}

bool solve_increment(struct quasi_static *qs)
{
    enum { ROUNDS = 60 };
    const double slow = 0.1;
    update_residual(qs);
    qs->tolerance_now = qs->setup.tolerance * qs->largest_load;
    if (qs->damping > 0)
        qs->tolerance_now = fmax(qs->tolerance_now, 1e-3 * largest_residual(qs));
    const double well = (qs->damping > 0 ? 1 : TARGET_FRACTION) * qs->tolerance_now;
    bool is_fresh = qs->large->factor_is_stale || qs->damping > 0;
    if (is_astray(qs)) return false;
    if (is_fresh && !factor_tangent(qs)) return false;
    qs->large->factor_is_stale = false;
    anderson_begin(&qs->large->acceleration, 6 * qs->n);
    double before = INFINITY;
    int since = 0, patience = 1; // rounds with one factor
    for (int round = 0; round < ROUNDS; round++) {
        const double left = largest_residual(qs);
        if (left <= well || (left <= qs->tolerance_now && left >= slow * before))
            return true;
        if (left > slow * before && since >= patience) {
            is_fresh = true;
            since = 0;
            patience *= 4;
            if (!factor_tangent(qs)) return false;
        }
        before = left;
        if (!newton_step(qs, &is_fresh) || is_astray(qs)) return false;
        is_fresh = false;
        since++;
    }
    update_residual(qs);
    return largest_residual(qs) <= qs->tolerance_now;
}

// One whose dense systems take as long as several increments counts as so many more.
static void count_work(struct quasi_static *qs)
{
    const double usual = 4e7; // multiplications
    qs->large->work_spent += 1 + contact_solver_work(qs->contacts) / usual;
    if (qs->setup.report)
        qs->setup.report(qs->setup.context, qs->large->balanced_fraction);
}

enum advance advance_increment(struct quasi_static *qs, double damping, double *moved)
{
    roll_back_state(qs);
    qs->damping = damping;
    qs->large->is_unstable = false;
    *moved = 4; // if it is not known
    const bool is_found = solve_increment(qs);
    count_work(qs);
    if (!is_found) return qs->large->is_unstable ? UNSTABLE : NOT_FOUND;
    *moved = furthest_since(qs) / qs->setup.increment;
    if (*moved > 1) return TOO_FAR;
    if (detect_contacts(qs)) return NEW_CONTACTS;
    if (damping > 0) return ADVANCED;
    return factor_tangent(qs) && (!qs->setup.is_free || davidson_is_stable(qs))
               ? ADVANCED
               : UNSTABLE;
}
