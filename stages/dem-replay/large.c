// SPDX-License-Identifier: GPL-3.0-or-later
#include "large.h"

#include "basics/memory.h"
#include "equilibrium_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Increments get no smaller than this share of what is to be let in: so exactly is
// known where equilibrium ends.
static const double least_increment = 1e-6;

// Without a sign that it ends, equilibrium is not looked for in smaller ones than this.
static const double rough_increment = 1e-3;

// Rows that buckle do so later by what is soft against shifts.
struct large *large_new(struct equilibrium *e)
{
    struct large *large = NEW_ARRAY(struct large, 1);
    struct lie **const of_joints[] = {&large->start, &large->before, &large->now};
    for (size_t k = 0; k < sizeof of_joints / sizeof *of_joints; k++) {
        *of_joints[k] = NEW_ARRAY(struct lie, e->n_joint);
        for (int j = 0; j < e->n_joint; j++)
            (*of_joints[k])[j] = joint_lie(&e->joint[j]);
    }
    large->more = NEW_ARRAY(struct pair_stiffness, e->n_joint);
    large->acceleration = anderson_make(6 * e->n);
    anderson_begin(&large->acceleration, 6 * e->n);
    large->searched = NEW_ARRAY(struct vector, e->n);
    large->withheld = NEW_ARRAY(struct displacement, e->n);
    e->soft[0] *= 1e-3;
    large->share = 1;
    large->is_stale = true;
    return large;
}

void large_free(struct large *large)
{
    if (!large) return;
    free(large->start);
    free(large->before);
    free(large->now);
    free(large->more);
    anderson_free(&large->acceleration);
    free(large->searched);
    free(large->withheld);
    free(large);
}

// ---- geometry -----------------------------------------------------------------------

static struct displacement since_before(const struct equilibrium *e, int i)
{
    return (struct displacement){subtract(e->trial[i].shift, e->before[i].shift),
                                 subtract(e->trial[i].turn, e->before[i].turn)};
}

void large_strain_joints(struct equilibrium *e)
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

struct displacement large_loads(const struct equilibrium *e, int j, int end)
{
    struct joint joint = e->joint[j];
    lay_joint(&joint, &e->large->now[j]);
    return joint_loads(&joint, end, e->resistance[j].load);
}

// With dashpots, (1 + damping) times the stiffness resists, but for this part of it.
// Where nothing resists twist, what turns with the shear force has no symmetric part to
// speak of: half of it there would look like grains that give way about their contacts.
void large_linearise(struct equilibrium *e)
{
    struct large *large = e->large;
    anderson_begin(&large->acceleration, 6 * e->n);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const bool twists = joint->is_bonded && joint->bond_stiffness[STRAIN_TWIST] > 0;
        double load[STRAINS] = {0};
        for (int k = 0; k < (twists ? STRAINS : 1); k++)
            load[k] = e->resistance[j].load[k] / (1 + e->damping);
        lay_joint(&e->joint[j], &large->now[j]);
        geometric_stiffness(&e->joint[j], &large->now[j], load, &large->more[j]);
    }
}

// Steps with joints unlike the factor are no linear iteration.
void large_accelerate(struct equilibrium *e)
{
    if (e->damping > 0 || corrections_count(e->corrections) > 0)
        anderson_begin(&e->large->acceleration, 6 * e->n);
    else
        anderson_step(&e->large->acceleration, &e->step[0].shift.x);
}

void large_keep_history(struct equilibrium *e)
{
    memcpy(e->large->before, e->large->now,
           (size_t)e->n_joint * sizeof *e->large->before);
}

// ---- one increment ------------------------------------------------------------------

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
    const double well = (e->damping > 0 ? 1 : 1e-3) * e->enough;
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

enum advance { ADVANCED, TOO_FAR, MEETS, UNSTABLE, NOT_FOUND };

// To the equilibrium at the share that is let in, if there is a stable one near: MOVED,
// as a share of what an increment may be.
static enum advance advance(struct equilibrium *e, double *moved)
{
    go_back(e);
    e->damping = 0;
    *moved = 4; // if it is not known
    if (!large_approach(e)) return e->large->is_unstable ? UNSTABLE : NOT_FOUND;
    *moved = furthest_since(e) / e->setup.increment;
    if (*moved > 1) return TOO_FAR;
    if (large_meet(e)) return MEETS;
    return factor(e) ? ADVANCED : UNSTABLE;
}

// ---- the way ------------------------------------------------------------------------

static void withhold(struct equilibrium *e)
{
    e->large->share = 1;
    go_back(e);
    resist(e);
    memcpy(e->large->withheld, e->left, (size_t)e->n * sizeof *e->left);
}

// The grain that moves or turns most in the mode that is resisted least at the last
// equilibrium, or by joints alone if that is not positive either, by inverse iteration.
static int softest_grain(struct equilibrium *e)
{
    enum { ROUNDS = 8 };
    const struct displacement none = {{0, 0, 0}, {0, 0, 0}};
    int softest = 0;
    const double(*tangent)[STRAINS] = (const double(*)[STRAINS])e->tangent;
    if (!factor(e)) stiffness_factor(e->matrix, tangent, NULL, e->soft);
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
            e->step[i] = (struct displacement){scale(1 / size, e->step[i].shift),
                                               scale(1 / size, e->step[i].turn)};
    }
    return softest;
}

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
    *softest = softest_grain(e);
    return let_go_of(e, e->fragments.of[*softest]) || break_one(e);
}

static enum status refuse_end(double balanced, int softest, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "equilibrium ends with %.6f of what this load changes: the stiffness "
                  "is no longer positive (buckling, or a snap through), grain %d moves "
                  "most (engine=explicit follows what comes then)",
                  balanced, softest);
}

// Where slip and contacts that open leave no equilibrium near the last.
static void walk_in_time(struct equilibrium *e)
{
    e->large->share = 1;
    e->large->is_least = true;
    balance(e);
    large_meet(e);
    resist(e);
    large_linearise(e);
    e->large->is_stale = true;
}

// How far the way is.
struct way {
    double reached, increment;
    double widest; // increment so far, 0: none
    double before; // of the load, balanced when this began
};

static struct way begin_way(struct equilibrium *e, double before)
{
    fragments_find(&e->fragments, e->joint, e->n_joint, e->setup.fixed, e->is_gone);
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
    large->is_least = way->increment <= least_increment;
    large->share = fmin(1, way->reached + way->increment);
    const enum advance outcome = advance(e, &moved);
    large->is_stale = outcome != ADVANCED;
    if (outcome == ADVANCED) {
        keep_history(e);
        way->widest = fmax(way->widest, large->share - way->reached);
        way->reached = large->share;
        way->increment *= fmin(2, 0.8 / fmax(moved, 0.01));
    } else if (outcome != MEETS && !large->is_least) {
        way->increment =
            fmin(way->increment, 1 - way->reached) * fmax(0.25, fmin(0.5, 0.8 / moved));
    }
    return outcome;
}

enum status large_balance(struct equilibrium *e, struct reason *reason)
{
    struct way way = begin_way(e, 0);
    while (way.reached < 1) {
        const double usual = way.widest > 0 ? way.widest : 1;
        const bool is_rough = way.increment <= rough_increment * usual;
        const enum advance outcome = try_increment(e, &way);
        e->large->balanced = balanced(&way);
        if (outcome == NOT_FOUND && is_rough) {
            walk_in_time(e);
            break;
        }
        if (outcome != UNSTABLE || !e->large->is_least) continue;
        int softest;
        if (!give_way(e, way.reached, &softest))
            return refuse_end(e->large->balanced, softest, reason);
        way = begin_way(e, e->large->balanced);
    }
    e->large->balanced = 1;
    return STATUS_OK;
}
