// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria that were found side by side and under which no bond breaks are not worked
// out joint by joint: what is asked of each, its lane says. The joints come to it when
// one is wanted that has to be found from there, or when something of them is asked.
#include "foresee_state.h"

#include <math.h>
#include <string.h>

static bool is_free(const struct equilibrium *e, int grain)
{
    return !e->setup.fixed[grain] && !e->is_gone[grain];
}

double find_left_lanes(struct equilibrium *e, int count)
{
    struct foresight *f = e->foresight;
    const struct lane_kernels *kernels = lane_kernels();
    const double unit = e->stiffness / e->length;
    const struct bond_strength strength = {e->setup.bond.normal_strength / unit,
                                           e->setup.bond.shear_strength / unit,
                                           e->setup.relative_strength};
    memcpy(f->left, f->applied, (size_t)e->n * GRAIN * sizeof *f->left);
    f->sums = (struct lane_sums){.carried = {0}};
    kernels->resist(e->n_joint, e->joint, &strength, f->moved, f->left, &f->sums);
    for (int i = 0; i < e->n; i++)
        if (is_free(e, i))
            kernels->measure(i, &f->from[i], f->moved, f->left, &f->sums);
    double most = 0;
    for (int l = 0; l < count; l++)
        most = fmax(most, f->sums.left[l]);
    return most;
}

// Whether what was found in LANE is balanced as well as balance.c would have it, no
// bond breaks and all displacements are small.
static bool is_settled(const struct equilibrium *e, int lane)
{
    const struct lane_sums *sums = &e->foresight->sums;
    const double enough = e->setup.tolerance * e->foresight->largest_load[lane];
    return sums->left[lane] <= well_below * enough && sums->overload[lane] < strong &&
           sums->furthest[lane] <= furthest && isfinite(sums->unbalanced[lane]) &&
           isfinite(sums->carried[lane]);
}

bool foreseen(struct equilibrium *e)
{
    struct foresight *f = e->foresight;
    if (!f || f->n_expected == 0) return false;
    if (!has_looked(e)) {
        realise(f);
        e->damping = 0;
        go_back(e);
        look_ahead(e);
    }
    if (f->used >= f->found || !is_settled(e, f->used)) {
        realise(f);
        return false;
    }
    f->present = f->used;
    e->largest_load = f->largest_load[f->used];
    return true;
}

bool is_foreseen(const struct equilibrium *e)
{
    return e->foresight && e->foresight->present >= 0;
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

void go_to_lane(struct equilibrium *e, int lane)
{
    const struct foresight *f = e->foresight;
    for (int i = 0; i < e->n; i++) {
        const struct displacement more = in_lane(f->moved, i, lane);
        e->trial[i].shift = add(f->from[i].shift, more.shift);
        e->trial[i].turn = add(f->from[i].turn, more.turn);
    }
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
