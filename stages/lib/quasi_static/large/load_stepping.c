// SPDX-License-Identifier: GPL-3.0-or-later
// The load is let in by increments, as long as there is a stable equilibrium near the
// last one.
#include "large_state.h"

#include "basics/memory.h"
#include "quasi_static/quasi_static_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Increments get no smaller than this share of what is to be let in: so exactly is
// known where equilibrium ends.
static const double least_increment = 1e-6;

// Without a sign that it ends, equilibrium is not looked for in smaller ones than this.
static const double rough_increment = 1e-3;

// Nor after so many that took long and were not found.
static const int most_costly = 3;

// ---- the way ------------------------------------------------------------------------

static void withhold(struct equilibrium *e)
{
    e->damping = 0;
    e->large->share = 1;
    go_back(e);
    resist(e);
    memcpy(e->large->withheld, e->left, (size_t)e->n * sizeof *e->left);
}

// How far the way is.
struct way {
    double reached, increment;
    double widest; // increment so far, 0: none
    double before; // of the load, balanced when this began
    int costly;    // increments not found that took long
};

static struct way begin_way(struct equilibrium *e, double before)
{
    find_fragments(e);
    withhold(e);
    return (struct way){.increment = 1, .before = before};
}

static double balanced(const struct way *way)
{
    return way->before + (1 - way->before) * way->reached;
}

static enum advance try_increment(struct equilibrium *e, struct way *way)
{
    struct large *large = e->large;
    double moved;
    const bool is_least = way->increment <= least_increment;
    e->may_leave = is_least;
    large->share = fmin(1, way->reached + way->increment);
    const enum advance outcome = large_advance(e, 0, &moved);
    large->is_stale = outcome != ADVANCED;
    if (outcome == NOT_FOUND && corrections_are_costly(e->corrections)) way->costly++;
    if (outcome == ADVANCED) {
        keep_history(e);
        way->widest = fmax(way->widest, large->share - way->reached);
        way->reached = large->share;
        way->increment *= fmin(2, 0.8 / fmax(moved, 0.01));
    } else if (outcome != MEETS && !is_least) {
        way->increment =
            fmin(way->increment, 1 - way->reached) * fmax(0.25, fmin(0.5, 0.8 / moved));
    }
    return outcome;
}

// ---- its end ------------------------------------------------------------------------

static bool let_go_of(struct equilibrium *e, int fragment)
{
    if (e->fragments.is_held[fragment]) return false;
    bool *leaves = NEW_ARRAY(bool, e->n);
    leaves[fragment] = true;
    let_go(e, leaves);
    free(leaves);
    return true;
}

// Where the stiffness is not positive, a fragment that nothing holds leaves if it is
// what gives way, or else a bond that is at its strength there breaks. Whether there
// was one: if not, SOFTEST gave way. In this order: a loose grain would else break one
// bond after the other, none of which had been relieved by the last.
static bool give_way(struct equilibrium *e, double reached, int *softest)
{
    e->large->share = reached;
    go_back(e);
    resist(e);
    *softest = large_softest(e);
    return let_go_of(e, e->fragments.of[*softest]) || break_one(e);
}

static enum status refuse_end(double balanced, int softest, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "equilibrium ends with %.6f of what this load changes: the stiffness "
                  "is no longer positive (buckling, or a snap through), grain %d moves "
                  "most, and dashpots do not bring it to rest (engine=explicit follows "
                  "what comes then)",
                  balanced, softest);
}

static enum status refuse_long(struct equilibrium *e, const struct way *way,
                               struct reason *reason)
{
    e->damping = 0;
    e->large->share = 1;
    go_back(e);
    resist(e);
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "no end of the way to equilibrium: %.6f of what this load changes is "
        "balanced after as many increments and steps in time as %.0f easy "
        "ones, grain %d is furthest from it (more steps of the load, a larger "
        "quasi_static.increment, or engine=explicit)",
        balanced(way), e->large->most_tried, least_balanced(e));
}

// Something went on moving, and does so under the next load. Bonds that break may leave
// it so several times under one.
static void leave_restless(struct equilibrium *e)
{
    if (!e->large->is_restless) e->n_restless++;
    e->large->is_restless = true;
    e->large->share = 1;
    resist(e);
    e->restless = least_balanced(e);
    large_linearise(e);
    e->large->is_stale = true;
}

// Rest was found: it snapped through or buckled if anything moved further from START
// than it may in an increment.
static void note_snap(struct equilibrium *e, const struct displacement *start,
                      double balanced)
{
    double most = e->setup.increment;
    for (int i = 0; i < e->n; i++) {
        const double way = size_of(moved_from(&start[i], &e->before[i]));
        if (e->is_gone[i] || !(way > most)) continue;
        most = way;
        e->snapped = i;
    }
    if (!(most > e->setup.increment)) return;
    e->n_snap++;
    e->large->ended = balanced;
}

// Where slip and contacts that open leave none near the last: few steps mostly do.
static bool slip(struct equilibrium *e)
{
    e->may_leave = true;
    e->large->is_stale = true;
    go_back(e);
    const bool rests = come_to_rest(e);
    large_meet(e);
    resist(e);
    large_linearise(e);
    e->large->is_stale = true;
    return rests;
}

// What is left of the load, or what nothing holds, leaves.
static bool let_go_restless(struct equilibrium *e)
{
    find_fragments(e);
    return let_go_beyond(e, e->left, e->setup.tolerance * e->largest_load);
}

enum end { RESTS, LEAVES, MOVES };

// From where equilibrium ends dynamics decides: under as much more of the load as was
// the most to be let in at a time, or all of it where slip is the end.
static enum end go_through(struct equilibrium *e, const struct way *way,
                           bool is_unstable)
{
    const double more = is_unstable && way->widest > 0 ? way->widest : 1;
    struct displacement *start = duplicate(e->before, (size_t)e->n, sizeof *start);
    if (is_unstable) large_kick(e);
    e->large->share = fmin(1, way->reached + more);
    enum end end = !is_unstable && slip(e) ? RESTS : MOVES;
    if (end == MOVES && !is_unstable && let_go_restless(e)) end = LEAVES;
    if (end == MOVES && large_walk(e, start)) end = RESTS;
    if (end == MOVES && let_go_restless(e)) end = LEAVES;
    if (end == RESTS) note_snap(e, start, balanced(way));
    free(start);
    return end;
}

// Where there is no stable equilibrium near the last one.
static enum status go_beyond(struct equilibrium *e, struct way *way, bool is_unstable,
                             struct reason *reason)
{
    int softest = 0;
    const bool gives_way = is_unstable && give_way(e, way->reached, &softest);
    const enum end end = gives_way ? LEAVES : go_through(e, way, is_unstable);
    if (end == MOVES && is_unstable) return refuse_end(balanced(way), softest, reason);
    if (end == MOVES) leave_restless(e);
    if (end != LEAVES) way->reached = e->large->share;
    if (way->reached < 1) *way = begin_way(e, balanced(way));
    return STATUS_OK;
}

enum status large_balance(struct equilibrium *e, struct reason *reason)
{
    struct way way = begin_way(e, 0);
    if (e->large->tried == 0) e->large->is_restless = false; // a new load
    while (way.reached < 1) {
        e->large->balanced = balanced(&way);
        if (e->large->tried > e->large->most_tried) return refuse_long(e, &way, reason);
        const double usual = way.widest > 0 ? way.widest : 1;
        const bool is_least = way.increment <= least_increment;
        const bool is_rough = way.increment <= rough_increment * usual;
        const enum advance outcome = try_increment(e, &way);
        const bool goes_on = outcome == ADVANCED || outcome == MEETS;
        const bool is_enough = is_rough || way.costly >= most_costly;
        const bool ends = is_least ? !goes_on : outcome == NOT_FOUND && is_enough;
        if (!ends) continue;
        const enum status status = go_beyond(e, &way, outcome == UNSTABLE, reason);
        if (status) return status;
    }
    return STATUS_OK;
}
