// SPDX-License-Identifier: GPL-3.0-or-later
// Dynamics, where equilibrium ends: dashpots at all joints, in proportion to their
// stiffness, slow the way down to the next equilibrium, which is walked in implicit
// steps of time.
#include "large_state.h"

#include "quasi_static/quasi_static_internal.h"

#include <math.h>

// ---- how it begins ------------------------------------------------------------------

// The mode that is resisted least at the last equilibrium, or by joints alone if that
// is not positive either, by inverse iteration.
int large_softest(struct equilibrium *e)
{
    enum { ROUNDS = 8 };
    const struct displacement none = {{0, 0, 0}, {0, 0, 0}};
    int softest = 0;
    const double(*tangent)[STRAINS] = (const double(*)[STRAINS])e->tangent;
    if (!factor(e)) {
        const double hold = e->large->hold;
        const double soft[2] = {e->soft[0] + hold, e->soft[1] + hold};
        stiffness_factor(e->matrix, tangent, NULL, soft);
    }
    if (e->setup.is_free) return free_softest(e, NULL);
    for (int i = 0; i < e->n; i++)
        e->step[i] = e->is_gone[i]
                         ? none
                         : (struct displacement){{1, 0.7, 0.4 + i % 3}, {0.3, 0.6, 1}};
    for (int round = 0; round < ROUNDS; round++) {
        stiffness_begin(e->matrix, e->step);
        stiffness_finish(e->matrix, e->step);
        for (int i = softest = 0; i < e->n; i++)
            if (size_of(e->step[i]) > size_of(e->step[softest])) softest = i;
        const double size = size_of(e->step[softest]);
        for (int i = 0; i < e->n; i++)
            e->step[i] = scaled(1 / size, e->step[i]);
    }
    return softest;
}

// The way that the rest of the load pushes; where it does not tell, as a row that is
// pushed at its end, the way inverse iteration has come to.
static double way_of_kick(const struct equilibrium *e)
{
    double work = 0, load = 0;
    for (int i = 0; i < e->n; i++) {
        const struct displacement *rest = &e->large->withheld[i];
        work += dot(e->step[i].shift, rest->shift) + dot(e->step[i].turn, rest->turn);
        load += norm(rest->shift) + norm(rest->turn);
    }
    return work < -1e-6 * load ? -1 : 1;
}

void large_kick(struct equilibrium *e)
{
    const double size = 0.1 * e->setup.increment * way_of_kick(e);
    go_back(e);
    if (e->setup.is_free) stand_still(e, e->step);
    for (int i = 0; i < e->n; i++)
        pull(&e->trial[i], scaled(-size, e->step[i]));
    resist(e);
    keep_history(e);
}

// ---- steps in time ------------------------------------------------------------------

// Of dashpots, over the stiffness and a time step: no step is longer or shorter. Forces
// that no joint bears take steps that are shorter by as much.
static const double softest = 1e-8, stiffest = 1e12;

// How long steps are.
struct pace {
    double damping;
    double found, missed; // the last of those with which a step was; 0: none
};

// Longer as things come to rest, as far as an increment allows; not at once beyond
// where none was found.
static void step_further(struct pace *pace, double moved)
{
    const double before = pace->damping;
    pace->found = before;
    pace->damping *= fmax(1. / 16, moved / 0.8);
    if (moved < 0.8 && pace->damping < 1.1 * pace->missed)
        pace->damping = sqrt(before * fmin(before, pace->missed));
    pace->missed *= 0.25;
    if (pace->damping < softest) pace->damping = 0;
}

static void step_less(struct pace *pace, enum advance outcome, double moved)
{
    const double before = pace->damping;
    pace->missed = outcome == TOO_FAR ? 0 : before;
    pace->damping = outcome == TOO_FAR     ? 1.5 * moved * before
                    : pace->found > before ? pace->found
                                           : 8 * before;
    pace->damping = fmax(pace->damping, softest);
    pace->found = 0;
}

static double left_without_dashpots(struct equilibrium *e)
{
    e->damping = 0;
    go_back(e);
    resist(e);
    return largest_left(e);
}

// Fragments that nothing holds leave when they have moved so far that they would not
// be found at rest by small displacements either.
static bool let_go_of_loose(struct equilibrium *e, const struct displacement *start)
{
    for (int i = 0; i < e->n; i++)
        e->step[i] = moved_from(&start[i], &e->before[i]);
    find_fragments(e);
    return let_go_beyond(e, e->step, furthest);
}

// Steps that get somewhere do not count: those in which something moves by half an
// increment, or by which a tenth of what was left to balance is gone.
static bool walk(struct equilibrium *e, const struct displacement *start)
{
    const int most = (int)(20 / e->setup.increment);
    double least = left_without_dashpots(e);
    const double beyond = fmax(1, least); // of what the stiffest joint bears
    struct pace pace = {.damping = beyond};
    const double rest = e->setup.tolerance * e->largest_load;
    int64_t idle = 0;
    e->may_leave = false;
    for (int k = 0; k < most && idle < e->setup.most_iterations; k++) {
        double moved;
        e->large->is_stale = true;
        const enum advance outcome = large_advance(e, pace.damping, &moved);
        idle++;
        if (outcome == MEETS) continue;
        if (outcome != ADVANCED) {
            step_less(&pace, outcome, moved);
            if (pace.damping > stiffest * beyond) break;
            continue;
        }
        keep_history(e);
        e->large->is_stale = false;
        if (pace.damping == 0) return true;
        const double left = left_without_dashpots(e);
        const bool breaks = let_go_of_loose(e, start) || break_one(e);
        if (breaks || moved >= 0.5 || left < 0.9 * least) idle = 0;
        if (left < 0.9 * least) least = left;
        if (!breaks) step_further(&pace, moved);
        if (!breaks && left <= rest) pace.damping = 0;
    }
    left_without_dashpots(e);
    return false;
}

// Dashpots at joints do not see loose grains roll. Where things do not come to rest so,
// others hold each grain a little, in proportion to the softest joint.
bool large_walk(struct equilibrium *e, const struct displacement *start)
{
    bool rests = false;
    for (int k = 0; k < 2 && !rests; k++) {
        e->large->drag = k * 1e6 * e->soft[1];
        rests = walk(e, start);
    }
    e->large->drag = 0;
    return rests;
}
