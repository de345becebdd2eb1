// SPDX-License-Identifier: GPL-3.0-or-later
// Overdamped dynamics under the present load factor: dashpots at all pairs, in
// proportion to K, and implicit Euler steps as in viscous_relaxation.c, each an
// increment. `damping` is viscosity over time step. It begins with a small perturbation
// along the softest mode, in the direction in which the load does work, and ends when
// the residual without dashpots is within the tolerance.
#include "implicit_dynamics.h"
#include "increment.h"
#include "softest_mode.h"

#include <math.h>

// ---- how it begins ------------------------------------------------------------------

// 1 or -1: the direction along the mode in which the load works. Where the load does
// not tell, as for a straight row pushed at its end, 1.
static double direction_of_load(const struct quasi_static *qs)
{
    double work = 0, load = 0;
    for (int i = 0; i < qs->n; i++) {
        const struct displacement *rest = &qs->large->residual_at_start[i];
        work += dot(qs->step[i].translation, rest->translation) +
                dot(qs->step[i].rotation, rest->rotation);
        load += norm(rest->translation) + norm(rest->rotation);
    }
    return work < -1e-6 * load ? -1 : 1;
}

void perturb_along_mode(struct quasi_static *qs)
{
    const double size = 0.1 * qs->setup.increment * direction_of_load(qs);
    roll_back_state(qs);
    if (qs->setup.is_free) remove_rigid_motion(qs, qs->step);
    for (int i = 0; i < qs->n; i++)
        displacement_subtract(&qs->displacement[i],
                              displacement_scaled(-size, qs->step[i]));
    update_residual(qs);
    commit_state(qs);
}

// ---- steps in time ------------------------------------------------------------------

// Bounds on the damping, and so on steps. Where forces exceed what the stiffest pair
// bears, the upper one is larger by as much.
static const double SOFTEST = 1e-8, STIFFEST = 1e12;

// The length of steps, and of the last that were found and not found; 0: none.
struct time_step {
    double damping;
    double found, missed;
};

// So long that the next moves by 0.8 of an increment; but half way, by logarithms, to a
// length with which none was found.
static void lengthen(struct time_step *step, double moved)
{
    const double before = step->damping;
    step->found = before;
    step->damping *= fmax(1. / 16, moved / 0.8);
    if (moved < 0.8 && step->damping < 1.1 * step->missed)
        step->damping = sqrt(before * fmin(before, step->missed));
    step->missed *= 0.25;
    if (step->damping < SOFTEST) step->damping = 0;
}

static void shorten(struct time_step *step, enum advance outcome, double moved)
{
    const double before = step->damping;
    step->missed = outcome == TOO_FAR ? 0 : before;
    step->damping = outcome == TOO_FAR     ? 1.5 * moved * before
                    : step->found > before ? step->found
                                           : 8 * before;
    step->damping = fmax(step->damping, SOFTEST);
    step->found = 0;
}

static double static_residual(struct quasi_static *qs)
{
    qs->damping = 0;
    roll_back_state(qs);
    update_residual(qs);
    return largest_residual(qs);
}

// Fragments that nothing holds leave when they have moved by more than is small.
static bool detach_loose(struct quasi_static *qs, const struct displacement *start)
{
    for (int i = 0; i < qs->n; i++)
        qs->step[i] = displacement_between(&start[i], &qs->previous[i]);
    update_fragments(qs);
    return detach_beyond(qs, qs->step, SMALL_LIMIT);
}

// At most so many steps without progress. Progress is a bond that breaks, a motion of
// half an increment, or a residual that is less by a tenth than any before.
static bool integrate(struct quasi_static *qs, const struct displacement *start)
{
    const int most = (int)(20 / qs->setup.increment);
    double least = static_residual(qs);
    const double beyond = fmax(1, least); // of what the stiffest pair bears
    struct time_step step = {.damping = beyond};
    const double rest = qs->setup.tolerance * qs->largest_load;
    int64_t idle = 0;
    qs->may_detach = false;
    for (int k = 0; k < most && idle < qs->setup.most_iterations; k++) {
        double moved;
        qs->large->factor_is_stale = true;
        const enum advance outcome = advance_increment(qs, step.damping, &moved);
        idle++;
        if (outcome == NEW_CONTACTS) continue;
        if (outcome != ADVANCED) {
            shorten(&step, outcome, moved);
            if (step.damping > STIFFEST * beyond) break;
            continue;
        }
        commit_state(qs);
        qs->large->factor_is_stale = false;
        if (step.damping == 0) return true;
        const double left = static_residual(qs);
        const bool breaks = detach_loose(qs, start) || break_most_overloaded(qs);
        if (breaks || moved >= 0.5 || left < 0.9 * least) idle = 0;
        if (left < 0.9 * least) least = left;
        if (!breaks) lengthen(&step, moved);
        if (!breaks && left <= rest) step.damping = 0;
    }
    static_residual(qs);
    return false;
}

// Dashpots at pairs do not slow loose grains that roll. Where there is no rest with
// them, each grain has one of its own as well, in proportion to the softest pair.
bool follow_dynamics(struct quasi_static *qs, const struct displacement *start)
{
    bool rests = false;
    for (int k = 0; k < 2 && !rests; k++) {
        qs->large->mass_damping = k * 1e6 * qs->regularisation[1];
        rests = integrate(qs, start);
    }
    qs->large->mass_damping = 0;
    return rests;
}
