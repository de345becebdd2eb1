// SPDX-License-Identifier: GPL-3.0-or-later
// What large displacements add to an engine: frames of all pairs at the start, the last
// equilibrium and the iterate, and their geometric stiffness, which the factor counts:
//     K = sum over pairs of B^T k B + geometric(load / (1 + damping)).
#include "large_state.h"

#include "basics/memory.h"

#include <stdlib.h>

// The regularisation of translations would make straight rows buckle later.
struct large_state *large_state_create(struct quasi_static *qs)
{
    struct large_state *large = NEW_ARRAY(struct large_state, 1);
    struct pair_frame **const of_pairs[] = {&large->start, &large->previous,
                                            &large->current};
    for (size_t k = 0; k < sizeof of_pairs / sizeof *of_pairs; k++) {
        *of_pairs[k] = NEW_ARRAY(struct pair_frame, qs->n_pair);
        for (int j = 0; j < qs->n_pair; j++)
            (*of_pairs[k])[j] = frame_of(&qs->pair[j]);
    }
    large->geometric = NEW_ARRAY(struct pair_stiffness, qs->n_pair);
    large->acceleration = anderson_init(6 * qs->n);
    anderson_begin(&large->acceleration, 6 * qs->n);
    large->searched_at = NEW_ARRAY(struct vector, qs->n);
    large->residual_at_start = NEW_ARRAY(struct displacement, qs->n);
    qs->regularisation[0] *= 1e-3;
    large->load_factor = 1;
    large->work_limit = 20000 + 20. * qs->n_pair;
    large->factor_is_stale = true;
    return large;
}

void large_state_free(struct large_state *large)
{
    if (!large) return;
    free(large->start);
    free(large->previous);
    free(large->current);
    free(large->geometric);
    anderson_free(&large->acceleration);
    free(large->searched_at);
    free(large->residual_at_start);
    free(large);
}

void large_state_allocate_pairs(struct quasi_static *qs)
{
    struct large_state *large = qs->large;
    const size_t count = (size_t)qs->n_pair;
    large->start = reallocate(large->start, count, sizeof *large->start);
    large->previous = reallocate(large->previous, count, sizeof *large->previous);
    large->current = reallocate(large->current, count, sizeof *large->current);
    large->geometric = reallocate(large->geometric, count, sizeof *large->geometric);
}

struct displacement displacement_since_previous(const struct quasi_static *qs,
                                                int grain)
{
    return displacement_between(&qs->previous[grain], &qs->displacement[grain]);
}

// Dashpots, (1 + damping) K in all, have no geometric part: it is divided by as much.
// Where nothing resists torsion only the normal force has one: the part of the shear
// force is not symmetric there, and its symmetric half would look like a mechanism.
void large_linearise(struct quasi_static *qs)
{
    struct large_state *large = qs->large;
    anderson_begin(&large->acceleration, 6 * qs->n);
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        const bool twists = pair->is_bonded && pair->bond_stiffness[TORSION] > 0;
        double load[COMPONENTS] = {0};
        for (int k = 0; k < (twists ? COMPONENTS : 1); k++)
            load[k] = qs->response[j].load[k] / (1 + qs->damping);
        set_frame(&qs->pair[j], &large->current[j]);
        geometric_stiffness(&qs->pair[j], &large->current[j], load,
                            &large->geometric[j]);
    }
}
