// SPDX-License-Identifier: GPL-3.0-or-later
// Without friction the loads of pairs are the slope of a convex energy E(u), whichever
// contacts are open: contacts push in proportion to their overlap, bonds are linear. So
// where many contacts open or close at once, Newton's method needs no contact solver:
//     K step = residual,    K the tangent at u,
//     u += t step,          t in (0, 1] where  slope(t) = step . residual(u + t step)
// is a small part of slope(0). -slope is dE/dt, which only grows with t; E falls with
// each step, and is quadratic between finitely many changes of contacts, so that the
// steps end at equilibrium (Fischer and Kummer's semismooth Newton, made global).
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

static double slope_along_step(const struct quasi_static *qs)
{
    double sum = 0;
    for (int i = 0; i < qs->n; i++)
        sum += dot(qs->step[i].translation, qs->residual[i].translation) +
               dot(qs->step[i].rotation, qs->residual[i].rotation);
    return sum;
}

// From FROM (n); the residual is then that of u = FROM + T step.
static double slope_at(struct quasi_static *qs, const struct displacement *from,
                       double t)
{
    for (int i = 0; i < qs->n; i++) {
        qs->displacement[i] = from[i];
        displacement_subtract(&qs->displacement[i],
                              displacement_scaled(-t, qs->step[i]));
    }
    update_residual(qs);
    return slope_along_step(qs);
}

// Regula falsi between 0 and 1, where the end that stays has its slope halved
// (Illinois).
static void search_along_step(struct quasi_static *qs, const struct displacement *from)
{
    enum { MOST = 12 };
    const double small = 0.1, first = slope_along_step(qs);
    double low = 0, high = 1, at_low = first, at_high = slope_at(qs, from, 1);
    int side = 0;
    if (at_high >= -small * first) return;
    for (int k = 0; k < MOST; k++) {
        const double t = low + (high - low) * at_low / (at_low - at_high);
        const double slope = slope_at(qs, from, t);
        if (fabs(slope) <= small * first) return;
        if (slope > 0) {
            low = t;
            at_low = slope;
            if (side == 1) at_high *= 0.5;
            side = 1;
        } else {
            high = t;
            at_high = slope;
            if (side == -1) at_low *= 0.5;
            side = -1;
        }
    }
    slope_at(qs, from, low);
}

// Whether K is the tangent as all pairs are now: a fresh one is not factored twice.
static bool is_tangent_factored(const struct quasi_static *qs)
{
    if (qs->factors == 0 || qs->factored_dashpot != dashpot_in_stiffness(qs))
        return false;
    for (int j = 0; j < qs->n_pair; j++) {
        const struct factored now = pair_as_factored(qs, j);
        if (now.state != qs->factored[j].state ||
            now.is_bonded != qs->factored[j].is_bonded)
            return false;
    }
    return true;
}

bool frictionless_step(struct quasi_static *qs)
{
    if (!is_frictionless(qs) || qs->damping > 0) return false;
    update_residual(qs);
    contact_solver_clear(qs->contacts);
    if (!is_tangent_factored(qs) && !factor_tangent(qs)) return false;
    stiffness_begin(qs->matrix, qs->residual);
    stiffness_finish(qs->matrix, qs->step);
    if (qs->may_detach && detach_beyond(qs, qs->step, SMALL_LIMIT)) return true;
    leave_detached_grains(qs);
    if (!(slope_along_step(qs) > 0)) return false; // rounding
    struct displacement *from =
        duplicate(qs->displacement, (size_t)qs->n, sizeof *from);
    search_along_step(qs, from);
    free(from);
    qs->iterations++;
    return true;
}
