// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments, grains that intact bonds join, and how they leave the aggregate: those
// that nothing holds and that would move too far lose their load, their pairs are
// detached, and the residual of the rest is found again.
//
// A fragment is held that has a fixed grain; without any fixed grain, the largest is
// (geometry/fragments.h). detach_beyond takes displacements or residuals alike: what it
// compares is the larger of the linear and the angular part. A value that is not a
// number counts as too far.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

void update_fragments(struct quasi_static *qs)
{
    fragments_begin(&qs->fragments);
    for (int j = 0; j < qs->n_pair; j++)
        if (qs->pair[j].is_bonded && !qs->pair[j].is_detached)
            fragments_join(&qs->fragments, qs->pair[j].grain[0], qs->pair[j].grain[1]);
    fragments_end(&qs->fragments, qs->setup.fixed, qs->is_detached);
}

void detach_fragments(struct quasi_static *qs, const bool *leaves)
{
    for (int i = 0; i < qs->n; i++) {
        if (!leaves[qs->fragments.of[i]] || qs->is_detached[i]) continue;
        qs->is_detached[i] = true;
        if (!qs->large) qs->displacement[i] = qs->previous[i];
        if (qs->n_detached++ == 0) qs->first_detached = i;
    }
    apply_external_load(qs);
    for (int j = 0; j < qs->n_pair; j++)
        for (int end = 0; end < 2; end++) {
            const int32_t grain = qs->pair[j].grain[end];
            if (grain >= 0 && qs->is_detached[grain]) qs->pair[j].is_detached = true;
        }
    update_residual(qs);
}

bool detach_beyond(struct quasi_static *qs, const struct displacement *moves,
                   double most)
{
    bool *leaves = NEW_ARRAY(bool, qs->n);
    bool any = false;
    for (int i = 0; i < qs->n; i++) {
        const int fragment = qs->fragments.of[i];
        if (qs->is_detached[i] || qs->fragments.is_held[fragment]) continue;
        if (!(displacement_size(moves[i]) <= most)) any = leaves[fragment] = true;
    }
    if (any) detach_fragments(qs, leaves);
    free(leaves);
    return any;
}

void leave_detached_grains(struct quasi_static *qs)
{
    for (int i = 0; i < qs->n; i++)
        if (qs->is_detached[i]) qs->step[i] = no_displacement;
}
