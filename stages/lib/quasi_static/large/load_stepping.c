// SPDX-License-Identifier: GPL-3.0-or-later
// The load factor s goes from 0 to 1 by increments, as long as there is a stable
// equilibrium near the last one. They grow up to twofold where they led less far than
// they may, and shrink where they led too far or nowhere. At a limit point, s no larger
// than LEAST_INCREMENT beyond, a fragment that nothing holds leaves if it is what gives
// way, or a bond that is at its strength breaks; else dynamics decides. Then s begins
// again at 0, with the residual that is left.
#include "load_stepping.h"
#include "contact_detection.h"
#include "implicit_dynamics.h"
#include "increment.h"
#include "softest_mode.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The smallest increment of the load factor: so exactly are limit points known.
static const double LEAST_INCREMENT = 1e-6;

// Where the tangent stays positive, increments that find no equilibrium get no smaller
// than this, of the largest that did.
static const double ROUGH_INCREMENT = 1e-3;

// Nor are they tried again after so many that took long.
static const int MOST_COSTLY = 3;

// ---- increments ---------------------------------------------------------------------

static void record_start(struct quasi_static *qs)
{
    qs->damping = 0;
    qs->large->load_factor = 1;
    roll_back_state(qs);
    update_residual(qs);
    memcpy(qs->large->residual_at_start, qs->residual,
           (size_t)qs->n * sizeof *qs->residual);
}

// Progress from one start to the next.
struct load_path {
    double reached, increment; // of the load factor
    double widest;             // increment that was found so far, 0: none
    double before;             // of the load, balanced when this began
    int costly;                // increments that took long and were not found
};

static struct load_path begin_load_path(struct quasi_static *qs, double before)
{
    update_fragments(qs);
    record_start(qs);
    return (struct load_path){.increment = 1, .before = before};
}

static double balanced(const struct load_path *path)
{
    return path->before + (1 - path->before) * path->reached;
}

static enum advance try_increment(struct quasi_static *qs, struct load_path *path)
{
    struct large_state *large = qs->large;
    double moved;
    const bool is_least = path->increment <= LEAST_INCREMENT;
    qs->may_detach = is_least;
    large->load_factor = fmin(1, path->reached + path->increment);
    const enum advance outcome = advance_increment(qs, 0, &moved);
    large->factor_is_stale = outcome != ADVANCED;
    if (outcome == NOT_FOUND && contact_solver_is_costly(qs->contacts)) path->costly++;
    if (outcome == ADVANCED) {
        commit_state(qs);
        path->widest = fmax(path->widest, large->load_factor - path->reached);
        path->reached = large->load_factor;
        path->increment *= fmin(2, 0.8 / fmax(moved, 0.01));
    } else if (outcome != NEW_CONTACTS && !is_least) {
        path->increment = fmin(path->increment, 1 - path->reached) *
                          fmax(0.25, fmin(0.5, 0.8 / moved));
    }
    return outcome;
}

// ---- limit points -------------------------------------------------------------------

static bool detach_fragment(struct quasi_static *qs, int fragment)
{
    if (qs->fragments.is_held[fragment]) return false;
    bool *leaves = NEW_ARRAY(bool, qs->n);
    leaves[fragment] = true;
    detach_fragments(qs, leaves);
    free(leaves);
    return true;
}

// The fragment of the grain that moves most in the softest mode, SOFTEST, leaves if
// nothing holds it; else a bond at its strength breaks. Not the other way round: a
// loose grain would make bonds break one after another, none relieved by the last.
// False: neither.
static bool detach_or_break(struct quasi_static *qs, double reached, int *softest)
{
    qs->large->load_factor = reached;
    roll_back_state(qs);
    update_residual(qs);
    *softest = find_softest_mode(qs);
    return detach_fragment(qs, qs->fragments.of[*softest]) || break_most_overloaded(qs);
}

static enum status refuse_end(double balanced, int softest, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "equilibrium ends at %.6f of the change of this load: the stiffness "
                  "is no longer positive (buckling, or a snap through), grain %d moves "
                  "most, and dashpots do not bring it to rest (engine=explicit follows "
                  "the motion after that)",
                  balanced, softest);
}

static enum status refuse_long(struct quasi_static *qs, const struct load_path *path,
                               struct reason *reason)
{
    qs->damping = 0;
    qs->large->load_factor = 1;
    roll_back_state(qs);
    update_residual(qs);
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "equilibrium is not reached: %.6f of the change of this load is balanced after "
        "the work of %.0f easy increments, grain %d is furthest from balance (more "
        "steps of the load, a larger quasi_static.increment, or engine=explicit)",
        balanced(path), qs->large->work_limit, grain_of_largest_residual(qs));
}

// What moves goes on under the next load. It counts once under a load, also where bonds
// that break begin it again.
static void accept_unconverged(struct quasi_static *qs)
{
    if (!qs->large->is_unconverged) qs->n_unconverged++;
    qs->large->is_unconverged = true;
    qs->large->load_factor = 1;
    update_residual(qs);
    qs->last_unconverged = grain_of_largest_residual(qs);
    large_linearise(qs);
    qs->large->factor_is_stale = true;
}

// Dynamics found rest: an instability, if a grain moved further from START than it may
// in an increment.
static void record_instability(struct quasi_static *qs,
                               const struct displacement *start, double balanced)
{
    double most = qs->setup.increment;
    for (int i = 0; i < qs->n; i++) {
        const double moved =
            displacement_size(displacement_between(&start[i], &qs->previous[i]));
        if (qs->is_detached[i] || !(moved > most)) continue;
        most = moved;
        qs->last_unstable = i;
    }
    if (!(most > qs->setup.increment)) return;
    qs->n_instability++;
    qs->large->fraction_at_instability = balanced;
}

// Viscous relaxation, where slip or contacts that open are the reason: few steps do.
static bool relax_slip(struct quasi_static *qs)
{
    qs->may_detach = true;
    qs->large->factor_is_stale = true;
    roll_back_state(qs);
    const bool rests = relax_to_equilibrium(qs);
    detect_contacts(qs);
    update_residual(qs);
    large_linearise(qs);
    qs->large->factor_is_stale = true;
    return rests;
}

// Fragments that nothing holds leave if they are not balanced.
static bool detach_unbalanced(struct quasi_static *qs)
{
    update_fragments(qs);
    return detach_beyond(qs, qs->residual, qs->setup.tolerance * qs->largest_load);
}

enum dynamics_end { AT_REST, DETACHED, MOVING };

// Dynamics from the limit point on, under a load factor larger by the widest increment
// so far, or under all of the load where slip is the reason.
static enum dynamics_end follow_past(struct quasi_static *qs,
                                     const struct load_path *path, bool is_unstable)
{
    const double more = is_unstable && path->widest > 0 ? path->widest : 1;
    struct displacement *start = duplicate(qs->previous, (size_t)qs->n, sizeof *start);
    if (is_unstable) perturb_along_mode(qs);
    qs->large->load_factor = fmin(1, path->reached + more);
    enum dynamics_end end = !is_unstable && relax_slip(qs) ? AT_REST : MOVING;
    if (end == MOVING && !is_unstable && detach_unbalanced(qs)) end = DETACHED;
    if (end == MOVING && follow_dynamics(qs, start)) end = AT_REST;
    if (end == MOVING && detach_unbalanced(qs)) end = DETACHED;
    if (end == AT_REST) record_instability(qs, start, balanced(path));
    free(start);
    return end;
}

static enum status pass_limit_point(struct quasi_static *qs, struct load_path *path,
                                    bool is_unstable, struct reason *reason)
{
    int softest = 0;
    const bool gives_way = is_unstable && detach_or_break(qs, path->reached, &softest);
    const enum dynamics_end end =
        gives_way ? DETACHED : follow_past(qs, path, is_unstable);
    if (end == MOVING && is_unstable)
        return refuse_end(balanced(path), softest, reason);
    if (end == MOVING) accept_unconverged(qs);
    if (end != DETACHED) path->reached = qs->large->load_factor;
    if (path->reached < 1) *path = begin_load_path(qs, balanced(path));
    return STATUS_OK;
}

enum status step_load(struct quasi_static *qs, struct reason *reason)
{
    struct load_path path = begin_load_path(qs, 0);
    if (qs->large->work_spent == 0) qs->large->is_unconverged = false; // a new load
    while (path.reached < 1) {
        qs->large->balanced_fraction = balanced(&path);
        if (qs->large->work_spent > qs->large->work_limit)
            return refuse_long(qs, &path, reason);
        const double usual = path.widest > 0 ? path.widest : 1;
        const bool is_least = path.increment <= LEAST_INCREMENT;
        const bool is_rough = path.increment <= ROUGH_INCREMENT * usual;
        const enum advance outcome = try_increment(qs, &path);
        const bool goes_on = outcome == ADVANCED || outcome == NEW_CONTACTS;
        const bool is_enough = is_rough || path.costly >= MOST_COSTLY;
        const bool ends = is_least ? !goes_on : outcome == NOT_FOUND && is_enough;
        if (!ends) continue;
        const enum status status =
            pass_limit_point(qs, &path, outcome == UNSTABLE, reason);
        if (status) return status;
    }
    return STATUS_OK;
}
