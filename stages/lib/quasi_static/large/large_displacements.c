// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_state.h"

#include "quasi_static/quasi_static_internal.h"

#include <string.h>

static void strain_large(struct equilibrium *e)
{
    struct large *large = e->large;
    for (int j = 0; j < e->n_joint; j++) {
        const int32_t *grain = e->joint[j].grain;
        const struct vector still = {0, 0, 0};
        struct displacement by[2];
        for (int end = 0; end < 2; end++)
            if (grain[end] >= 0) by[end] = since_before(e, grain[end]);
        const struct vector second = grain[1] < 0 ? still : e->trial[grain[1]].shift;
        const struct passage passage = {.start = &large->start[j],
                                        .before = &large->before[j],
                                        .shift =
                                            subtract(second, e->trial[grain[0]].shift),
                                        .by = {&by[0], grain[1] < 0 ? NULL : &by[1]}};
        large_strains(&e->joint[j], &passage, e->strain[j], &large->now[j]);
    }
}

// The load of joint J on the grain at END, at the trial.
static struct displacement load_of(const struct equilibrium *e, int j, int end)
{
    struct joint joint = e->joint[j];
    lay_joint(&joint, &e->large->now[j]);
    return joint_loads(&joint, end, e->resistance[j].load);
}

static void resist_large(struct equilibrium *e)
{
    strain_large(e);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        e->resistance[j] = joint_resistance(joint, e->strain[j]);
        for (int end = 0; end < 2; end++)
            if (joint->grain[end] >= 0)
                pull(&e->left[joint->grain[end]], load_of(e, j, end));
    }
    for (int i = 0; i < e->n; i++)
        pull(&e->left[i], scaled(1 - e->large->share, e->large->withheld[i]));
    if (e->setup.is_free) take_off_as_one(e);
}

static bool factor_large(struct equilibrium *e)
{
    const double(*tangent)[STRAINS] = (const double(*)[STRAINS])e->tangent;
    struct large *large = e->large;
    large_linearise(e);
    if (e->setup.is_free) large->hold = hold_of(e);
    const double more = large->hold + large->drag * e->damping / (1 + e->damping);
    const double soft[2] = {e->soft[0] + more, e->soft[1] + more};
    large->is_unstable = !stiffness_factor(e->matrix, tangent, large->more, soft) ||
                         !stiffness_is_positive(e->matrix);
    return !large->is_unstable;
}

// Dashpots resist as joints do, not as their loads turn: the part of a step that does
// is none of theirs. Steps with joints unlike the factor are no linear iteration.
static void take_large(struct equilibrium *e)
{
    if (e->damping > 0) take_off_turning(e, e->step, e->rest);
    if (e->setup.is_free) stand_still(e, e->step);
    if (e->damping > 0 || (corrections_count(e->corrections) > 0 && !e->setup.is_free))
        anderson_begin(&e->large->acceleration, 6 * e->n);
    else
        anderson_step(&e->large->acceleration, &e->step[0].shift.x);
}

static void keep_lies(struct equilibrium *e)
{
    memcpy(e->large->before, e->large->now,
           (size_t)e->n_joint * sizeof *e->large->before);
}

const struct equilibrium_kind large_displacements = {.resist = resist_large,
                                                     .factor = factor_large,
                                                     .take = take_large,
                                                     .keep_history = keep_lies,
                                                     .approach = large_approach,
                                                     .balance = large_balance};
