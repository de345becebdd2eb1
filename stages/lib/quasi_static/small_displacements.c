// SPDX-License-Identifier: GPL-3.0-or-later
// Displacements that are small: directions are those of the packing.
#include "quasi_static_internal.h"

#include <math.h>

static void resist_small(struct equilibrium *e)
{
    strain_trial(e);
    for (int j = 0; j < e->n_joint; j++) {
        e->resistance[j] = joint_resistance(&e->joint[j], e->strain[j]);
        joint_take_off(&e->joint[j], e->resistance[j].load, e->left);
    }
}

static bool factor_small(struct equilibrium *e)
{
    const double(*tangent)[STRAINS] = (const double(*)[STRAINS])e->tangent;
    return stiffness_factor(e->matrix, tangent, NULL, e->soft);
}

// The next equilibrium, or step in time on the way there, from the last one: to well
// below what may be left, as forces on many grains add up, where that comes easily.
static bool approach_small(struct equilibrium *e)
{
    enum { ROUNDS = 20 };
    resist(e);
    e->enough = e->setup.tolerance * e->largest_load;
    if (e->damping > 0) e->enough = fmax(e->enough, 1e-3 * largest_left(e));
    const double well = (e->damping > 0 ? 1 : well_below) * e->enough;
    if (largest_left(e) <= well) return true; // the load is the same
    bool is_fresh = e->factors == 0 ||
                    corrections_work(e->corrections) > 16 * stiffness_work(e->matrix);
    if (is_fresh && !factor(e)) return false;
    double before = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        const double left = largest_left(e);
        if (left <= well || (left <= e->enough && left >= 0.1 * before)) return true;
        before = left;
        if (!improve(e, &is_fresh)) break;
    }
    resist(e);
    return largest_left(e) <= e->enough;
}

// At once or, where that is not found, in time. What does not even then come to rest
// leaves if nothing supports it; else it goes on moving under the next load.
static enum status balance_small(struct equilibrium *e, struct reason *reason)
{
    (void)reason;
    const double enough = e->setup.tolerance * e->largest_load;
    find_fragments(e);
    bool rests;
    do {
        go_back(e);
        rests = come_to_rest(e);
    } while (let_go_beyond(e, e->trial, furthest) ||
             (!rests && let_go_beyond(e, e->left, enough)));
    if (!rests) {
        if (!e->is_restless) e->n_restless++;
        e->is_restless = true;
        e->restless = least_balanced(e);
        keep_history(e);
    }
    return STATUS_OK;
}

const struct equilibrium_kind small_displacements = {.resist = resist_small,
                                                     .factor = factor_small,
                                                     .approach = approach_small,
                                                     .balance = balance_small};
