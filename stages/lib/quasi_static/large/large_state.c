// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_state.h"

#include "quasi_static/quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

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
    large->most_tried = 20000 + 20. * e->n_joint;
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

void large_make_room(struct equilibrium *e)
{
    struct large *large = e->large;
    const size_t count = (size_t)e->n_joint;
    large->start = reallocate(large->start, count, sizeof *large->start);
    large->before = reallocate(large->before, count, sizeof *large->before);
    large->now = reallocate(large->now, count, sizeof *large->now);
    large->more = reallocate(large->more, count, sizeof *large->more);
}

struct displacement since_before(const struct equilibrium *e, int i)
{
    return moved_from(&e->before[i], &e->trial[i]);
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
