// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

void find_fragments(struct equilibrium *e)
{
    fragments_begin(&e->fragments);
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].is_bonded && !e->joint[j].is_gone)
            fragments_join(&e->fragments, e->joint[j].grain[0], e->joint[j].grain[1]);
    fragments_end(&e->fragments, e->setup.fixed, e->is_gone);
}

// What is marked leaves: its load counts no more, and nothing touches it.
void let_go(struct equilibrium *e, const bool *leaves)
{
    for (int i = 0; i < e->n; i++) {
        if (!leaves[e->fragments.of[i]] || e->is_gone[i]) continue;
        e->is_gone[i] = true;
        if (e->n_gone++ == 0) e->first_gone = i;
    }
    load_grains(e);
    for (int j = 0; j < e->n_joint; j++)
        for (int end = 0; end < 2; end++) {
            const int32_t grain = e->joint[j].grain[end];
            if (grain >= 0 && e->is_gone[grain]) e->joint[j].is_gone = true;
        }
    resist(e);
}

bool let_go_beyond(struct equilibrium *e, const struct displacement *moves, double most)
{
    bool *leaves = NEW_ARRAY(bool, e->n);
    bool any = false;
    for (int i = 0; i < e->n; i++) {
        const int fragment = e->fragments.of[i];
        if (e->is_gone[i] || e->fragments.is_held[fragment]) continue;
        if (!(size_of(moves[i]) <= most)) any = leaves[fragment] = true;
    }
    if (any) let_go(e, leaves);
    free(leaves);
    return any;
}
