// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria that were found side by side are not worked out joint by joint: what is
// asked of each, its lane says. The joints come to it when the next loads are begun
// with from there, or when something of them is asked.
#include "foresee_state.h"

#include <math.h>
#include <string.h>

static bool is_free(const struct equilibrium *e, int grain)
{
    return !e->setup.fixed[grain] && !e->is_gone[grain];
}

void find_left_lanes(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    const struct lane_kernels *kernels = lane_kernels();
    const double unit = e->stiffness / e->length;
    const struct bond_strength strength = {e->setup.bond.normal_strength / unit,
                                           e->setup.bond.shear_strength / unit,
                                           e->setup.relative_strength};
    memcpy(f->left, f->applied, (size_t)e->n * GRAIN * sizeof *f->left);
    f->sums = (struct lane_sums){.carried = {0}};
    kernels->resist(e->n_joint, e->joint, f->strain, &strength, f->moved, f->left,
                    &f->sums);
    for (int i = 0; i < e->n; i++)
        if (is_free(e, i))
            kernels->measure(i, &f->from[i], f->moved, f->left, &f->sums);
}

static struct displacement in_lane(const double *numbers, int grain, int lane)
{
    double number[DEGREES];
    for (int k = 0; k < DEGREES; k++)
        number[k] = numbers[(long)grain * GRAIN + k * LANES + lane];
    struct displacement displacement;
    memcpy(&displacement, number, sizeof displacement);
    return displacement;
}

static void go_to_lane(struct equilibrium *e, int lane)
{
    const struct foresight *f = e->foresight;
    for (int i = 0; i < e->n; i++) {
        const struct displacement more = in_lane(f->moved, i, lane);
        e->trial[i].shift = add(f->from[i].shift, more.shift);
        e->trial[i].turn = add(f->from[i].turn, more.turn);
    }
}

// Whether the next lane is found, at places that are numbers.
static bool is_hint(const struct foresight *f)
{
    return f->used < f->found && isfinite(f->sums.furthest[f->used]);
}

// Whether what was found in LANE is balanced to SHARE of the tolerance, and all
// displacements are small.
static bool is_balanced(const struct equilibrium *e, int lane, double share)
{
    const struct lane_sums *sums = &e->foresight->sums;
    const double enough = e->setup.tolerance * e->foresight->largest_load[lane];
    return sums->left[lane] <= share * enough && sums->furthest[lane] <= furthest &&
           isfinite(sums->unbalanced[lane]) && isfinite(sums->carried[lane]);
}

// The joints come to the present equilibrium as far as the next is found from there:
// realise does besides what is asked of them.
static void settle_joints(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (f->present < 0) return;
    go_to_lane(e, f->present);
    f->present = -1;
    strain_trial(e);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const bool touches = e->strain[j][STRAIN_ALONG] <= joint->overlap;
        e->resistance[j].contact.touch =
            touches && !joint->is_gone ? TOUCH_STICKS : TOUCH_NONE;
    }
    keep_history(e);
}

// The most overloaded bond, if one is. The way through the factor that these loads have
// begun with serves on.
static bool break_in_lane(struct equilibrium *e, int lane)
{
    struct foresight *f = e->foresight;
    if (!(f->sums.overload[lane] >= strong)) return false;
    go_to_lane(e, lane);
    strain_trial(e);
    if (!break_one(e)) return false;
    f->found = lane;
    f->sight = 1;
    return true;
}

// The next lane, and those after it, while no bond breaks; after one has, again that
// lane alone, and then twice as many each time. Whether it is found; where no other
// bond breaks, with one round more if that is what it takes to be well below the
// tolerance.
static bool find_next(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    bool is_polished = false;
    for (;;) {
        if (f->used >= f->found) {
            const int end = f->used + f->sight;
            settle_joints(e);
            f->found = look(e, f->used, end < f->n_lane ? end : f->n_lane);
            f->sight = 2 * f->sight < LANES ? 2 * f->sight : LANES;
            is_polished = false;
        }
        f->has_hint = is_hint(f);
        if (!f->has_hint) return false;
        const bool is_near = is_balanced(e, f->used, 1);
        if (is_near && break_in_lane(e, f->used)) continue;
        if (is_near && (is_polished || is_balanced(e, f->used, well_below)))
            return true;
        if (is_polished) return false;
        polish(e, f->used, f->found);
        is_polished = true;
    }
}

static bool is_as_begun(const struct equilibrium *e)
{
    const struct foresight *f = e->foresight;
    return f->used < f->n_lane && f->n_crack == e->n_crack && f->n_gone == e->n_gone;
}

bool foreseen(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (!f || f->n_expected == 0) return false;
    if (!is_as_begun(e)) {
        settle_joints(e);
        begin_lanes_anew(e);
    }
    const bool is_found = find_next(e);
    if (is_found) {
        f->present = f->used;
        e->largest_load = f->largest_load[f->used];
    } else {
        settle_joints(e);
    }
    return is_found;
}

void foresee(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (!f || f->n_expected == 0) return;
    if (f->n_lane == 0) {
        begin_lanes_anew(e);
        f->found = look(e, 0, 1);
        f->has_hint = is_hint(f);
    }
    if (f->has_hint) go_to_lane(e, f->used);
    f->n_lane = f->found = f->used = 0;
}

bool is_foreseen(const struct equilibrium *e)
{
    return e->foresight && e->foresight->present >= 0;
}

void realise(struct foresight *f)
{
    if (!f || f->present < 0) return;
    struct equilibrium *e = f->of;
    const int lane = f->present;
    f->present = -1;
    go_to_lane(e, lane);
    for (int i = 0; i < e->n; i++)
        e->load[i] = in_lane(f->applied, i, lane);
    e->taken_off = f->taken_off[lane];
    e->damping = 0;
    resist(e);
    keep_history(e);
}

double foreseen_unbalanced_ratio(const struct equilibrium *e)
{
    const struct lane_sums *sums = &e->foresight->sums;
    const int lane = e->foresight->present;
    int moving = 0;
    for (int i = 0; i < e->n; i++)
        moving += is_free(e, i);
    const struct unbalanced sum = {sums->unbalanced[lane], sums->left[lane],
                                   sums->carried[lane], moving,
                                   (int)sums->carrying[lane]};
    return unbalanced_ratio(e, &sum);
}

// What joints do to a held grain is all that is left there.
struct displacement foreseen_pull(const struct equilibrium *e, int grain)
{
    const struct displacement left =
        in_lane(e->foresight->left, grain, e->foresight->present);
    return (struct displacement){scale(-1, left.shift), scale(-1, left.turn)};
}
