// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments by disjoint sets of grains, joined over the intact bonds; the root of a set
// is its lowest grain, in whatever order bonds come (basics/disjoint_sets.h). As they
// are joined, of[i] only leads towards the root; fragments_end puts the root itself
// there, and then
//     is_held[root] = any of its grains is fixed;
// where no grain at all is fixed, the largest fragment is held (of equals that with the
// lowest root), so that a free body has one piece to stay. A single grain is not held
// for its size. Grains that are gone do not count for it, but keep their entries.
#include "fragments.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdlib.h>

struct fragments fragments_init(int n)
{
    return (struct fragments){
        .n = n, .of = NEW_ARRAY(int32_t, n), .is_held = NEW_ARRAY(bool, n)};
}

void fragments_free(struct fragments *fragments)
{
    free(fragments->of);
    free(fragments->is_held);
}

// Sizes are counted at the roots, which of[] holds by now. O(n).
static void hold_largest(struct fragments *fragments, const bool *is_gone)
{
    int *size = NEW_ARRAY(int, fragments->n);
    int largest = 0;
    for (int i = 0; i < fragments->n; i++)
        if (!is_gone || !is_gone[i]) size[fragments->of[i]]++;
    for (int i = 1; i < fragments->n; i++)
        if (size[i] > size[largest]) largest = i;
    if (fragments->n > 0 && size[largest] > 1) fragments->is_held[largest] = true;
    free(size);
}

void fragments_begin(struct fragments *fragments)
{
    for (int i = 0; i < fragments->n; i++) {
        fragments->of[i] = i;
        fragments->is_held[i] = false;
    }
}

void fragments_join(struct fragments *fragments, int grain, int other)
{
    unite_sets(fragments->of, grain, other);
}

void fragments_end(struct fragments *fragments, const uint8_t *fixed,
                   const bool *is_gone)
{
    int32_t *of = fragments->of;
    bool any = false;
    for (int i = 0; i < fragments->n; i++) {
        of[i] = set_root(of, i);
        if (fixed[i]) any = fragments->is_held[of[i]] = true;
    }
    if (!any) hold_largest(fragments, is_gone);
}
