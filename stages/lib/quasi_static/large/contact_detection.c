// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that come near each other on the way: sought anew when one has moved so far
// that some may.
#include "quasi_static/quasi_static_internal.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>

static bool may_meet(const struct equilibrium *e)
{
    double smallest = INFINITY, furthest_way = 0;
    for (int i = 0; i < e->n; i++) {
        const double way = distance(e->trial[i].shift, e->large->searched[i]);
        smallest = fmin(smallest, e->packing->radius[i] / e->length);
        if (!e->is_gone[i]) furthest_way = fmax(furthest_way, way);
    }
    return furthest_way > joint_reach * smallest;
}

// Grains at the trial, within the box where it repeats.
static struct packing moved_packing(const struct equilibrium *e)
{
    struct packing now = *e->packing;
    now.position = NEW_ARRAY(struct vector, e->n);
    for (int i = 0; i < e->n; i++) {
        struct vector x =
            add(e->packing->position[i], scale(e->length, e->trial[i].shift));
        for (int axis = 0; axis < 3; axis++) {
            const double lower = component(now.lower, axis);
            const double period = component(now.upper, axis) - lower;
            const double from = component(x, axis) - lower;
            if (now.periodic[axis])
                set_component(&x, axis, lower + from - period * floor(from / period));
        }
        now.position[i] = x;
    }
    return now;
}

// The pairs that joints are of, sorted; with the wall, -1 comes first.
static int32_t (*joint_pairs(const struct equilibrium *e))[2]
{
    int32_t(*pair)[2] = allocate((size_t)e->n_joint, sizeof *pair);
    for (int j = 0; j < e->n_joint; j++) {
        const int32_t *grain = e->joint[j].grain;
        pair[j][0] = grain[0] < grain[1] ? grain[0] : grain[1];
        pair[j][1] = grain[0] < grain[1] ? grain[1] : grain[0];
    }
    if (e->n_joint > 0) qsort(pair, (size_t)e->n_joint, sizeof *pair, compare_pairs);
    return pair;
}

// A joint as it would have been all the time, but that nothing touched.
static struct joint late_joint(const struct equilibrium *e, struct joint joint,
                               struct lie *before)
{
    const int32_t *grain = joint.grain;
    const struct vector first = e->before[grain[0]].shift;
    *before = joint_lie(&joint);
    if (grain[1] < 0) {
        joint.strain[STRAIN_ALONG] = -dot(first, joint.axis[0]);
        before->arm[0] += joint.strain[STRAIN_ALONG];
    } else {
        const struct joint_setup setup = joints_of(e);
        const double from = joint.arm[0] + joint.arm[1];
        const struct vector now =
            add(scale(from, joint.axis[0]), subtract(e->before[grain[1]].shift, first));
        const struct joint then =
            contact_joint(&setup, grain[0], grain[1], scale(e->length, now));
        *before = joint_lie(&then);
        joint.strain[STRAIN_ALONG] = norm(now) - from;
    }
    joint.contact.touch = TOUCH_NONE;
    return joint;
}

static void append(struct equilibrium *e, struct joint joint)
{
    struct large *large = e->large;
    const size_t count = (size_t)e->n_joint + 1;
    e->joint = reallocate(e->joint, count, sizeof *e->joint);
    large->start = reallocate(large->start, count, sizeof *large->start);
    large->before = reallocate(large->before, count, sizeof *large->before);
    large->start[e->n_joint] = joint_lie(&joint);
    e->joint[e->n_joint] = late_joint(e, joint, &large->before[e->n_joint]);
    e->n_joint++;
}

static void append_near(struct equilibrium *e)
{
    const struct joint_setup setup = joints_of(e);
    struct packing now = moved_packing(e);
    const int n_known = e->n_joint;
    int32_t(*known)[2] = joint_pairs(e);
    int n_near;
    int32_t(*near)[2] = neighbour_pairs(&now, joint_reach, &n_near);
    for (int k = 0; k < n_near; k++) {
        const int i = near[k][0], j = near[k][1];
        if (e->is_gone[i] || e->is_gone[j] ||
            (n_known > 0 &&
             bsearch(near[k], known, (size_t)n_known, sizeof *known, compare_pairs)))
            continue;
        const struct vector way = subtract(e->trial[j].shift, e->trial[i].shift);
        append(e, contact_joint(
                      &setup, i, j,
                      subtract(nearest_image(&now, i, j), scale(e->length, way))));
    }
    for (int i = 0; i < e->n && e->setup.has_wall; i++) {
        const double height =
            e->packing->position[i].z + e->length * e->trial[i].shift.z - now.lower.z;
        const int32_t pair[2] = {-1, i};
        if (!e->is_gone[i] && height <= (1 + joint_reach) * now.radius[i] &&
            !(n_known > 0 &&
              bsearch(pair, known, (size_t)n_known, sizeof *known, compare_pairs)))
            append(e, wall_joint(&setup, i));
    }
    free(near);
    free(known);
    free(now.position);
}

bool large_meet(struct equilibrium *e)
{
    struct large *large = e->large;
    if (!may_meet(e)) return false;
    for (int i = 0; i < e->n; i++)
        large->searched[i] = e->trial[i].shift;
    const int before = e->n_joint;
    append_near(e);
    if (e->n_joint == before) return false;
    large_make_room(e);
    make_room_for_joints(e);
    resist(e);
    for (int j = before; j < e->n_joint; j++)
        if (e->resistance[j].contact.touch) return true;
    return false;
}
