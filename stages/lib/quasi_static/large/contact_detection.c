// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs are sought again when a grain has moved further since the last search than the
// range that was searched allows. New ones get the deformation that they would have had
// if they had been pairs from the start: with n the normal at the start and u the
// displacements at the last equilibrium, in mean radii,
//     from = arm_i + arm_j,  now = from n + u_j - u_i,
//     deformation[NORMAL] = |now| - from; at the wall -u_i.n.
// All other components are 0.
#include "contact_detection.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>

static bool may_touch(const struct quasi_static *qs)
{
    double smallest = INFINITY, furthest = 0;
    for (int i = 0; i < qs->n; i++) {
        const double moved =
            distance(qs->displacement[i].translation, qs->large->searched_at[i]);
        smallest = fmin(smallest, qs->packing->radius[i] / qs->length);
        if (!qs->is_detached[i]) furthest = fmax(furthest, moved);
    }
    return furthest > SEARCH_RANGE * smallest;
}

// Grains where they are now, within the box where it repeats.
static struct packing moved_packing(const struct quasi_static *qs)
{
    struct packing now = *qs->packing;
    now.position = NEW_ARRAY(struct vector, qs->n);
    for (int i = 0; i < qs->n; i++) {
        struct vector x = add(qs->packing->position[i],
                              scale(qs->length, qs->displacement[i].translation));
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

// The grains of all pairs, sorted; with the wall, -1 comes first.
static int32_t (*known_pairs(const struct quasi_static *qs))[2]
{
    int32_t(*grains)[2] = allocate((size_t)qs->n_pair, sizeof *grains);
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        grains[j][0] = grain[0] < grain[1] ? grain[0] : grain[1];
        grains[j][1] = grain[0] < grain[1] ? grain[1] : grain[0];
    }
    if (qs->n_pair > 0)
        qsort(grains, (size_t)qs->n_pair, sizeof *grains, compare_pairs);
    return grains;
}

// PAIR as it would be at the last equilibrium had it been one from the start, open; and
// its frame there.
static struct contact_pair new_pair(const struct quasi_static *qs,
                                    struct contact_pair pair, struct pair_frame *before)
{
    const int32_t *grain = pair.grain;
    const struct vector first = qs->previous[grain[0]].translation;
    *before = frame_of(&pair);
    if (grain[1] < 0) {
        pair.deformation[NORMAL] = -dot(first, pair.axis[0]);
        before->arm[0] += pair.deformation[NORMAL];
    } else {
        const struct contact_pair_setup setup = pair_setup_of(qs);
        const double from = pair.arm[0] + pair.arm[1];
        const struct vector now =
            add(scale(from, pair.axis[0]),
                subtract(qs->previous[grain[1]].translation, first));
        const struct contact_pair then =
            grain_pair(&setup, grain[0], grain[1], scale(qs->length, now));
        *before = frame_of(&then);
        pair.deformation[NORMAL] = norm(now) - from;
    }
    pair.contact.state = CONTACT_OPEN;
    return pair;
}

static void append_pair(struct quasi_static *qs, struct contact_pair pair)
{
    struct large_state *large = qs->large;
    const size_t count = (size_t)qs->n_pair + 1;
    qs->pair = reallocate(qs->pair, count, sizeof *qs->pair);
    large->start = reallocate(large->start, count, sizeof *large->start);
    large->previous = reallocate(large->previous, count, sizeof *large->previous);
    shrink_new_pair(qs, &pair);
    large->start[qs->n_pair] = frame_of(&pair);
    qs->pair[qs->n_pair] = new_pair(qs, pair, &large->previous[qs->n_pair]);
    qs->n_pair++;
}

static void append_near(struct quasi_static *qs)
{
    const struct contact_pair_setup setup = pair_setup_of(qs);
    struct packing now = moved_packing(qs);
    const int n_known = qs->n_pair;
    int32_t(*known)[2] = known_pairs(qs);
    int n_near;
    int32_t(*near)[2] = neighbour_pairs(&now, SEARCH_RANGE, &n_near);
    for (int k = 0; k < n_near; k++) {
        const int i = near[k][0], j = near[k][1];
        if (qs->is_detached[i] || qs->is_detached[j] ||
            (n_known > 0 &&
             bsearch(near[k], known, (size_t)n_known, sizeof *known, compare_pairs)))
            continue;
        const struct vector moved =
            subtract(qs->displacement[j].translation, qs->displacement[i].translation);
        append_pair(qs, grain_pair(&setup, i, j,
                                   subtract(nearest_image(&now, i, j),
                                            scale(qs->length, moved))));
    }
    for (int i = 0; i < qs->n && qs->setup.has_wall; i++) {
        const double height = qs->packing->position[i].z +
                              qs->length * qs->displacement[i].translation.z -
                              now.lower.z;
        const int32_t grains[2] = {-1, i};
        if (!qs->is_detached[i] && height <= (1 + SEARCH_RANGE) * now.radius[i] &&
            !(n_known > 0 &&
              bsearch(grains, known, (size_t)n_known, sizeof *known, compare_pairs)))
            append_pair(qs, wall_pair(&setup, i));
    }
    free(near);
    free(known);
    free(now.position);
}

bool detect_contacts(struct quasi_static *qs)
{
    struct large_state *large = qs->large;
    if (!may_touch(qs)) return false;
    for (int i = 0; i < qs->n; i++)
        large->searched_at[i] = qs->displacement[i].translation;
    const int before = qs->n_pair;
    append_near(qs);
    if (qs->n_pair == before) return false;
    large_state_allocate_pairs(qs);
    allocate_pair_arrays(qs);
    update_residual(qs);
    for (int j = before; j < qs->n_pair; j++)
        if (qs->response[j].contact.state) return true;
    return false;
}
