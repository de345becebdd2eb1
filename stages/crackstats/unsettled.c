// SPDX-License-Identifier: GPL-3.0-or-later
// A response says how many loads did not come to rest, not which. By cycles a load that
// did not has an unbalanced ratio above the tolerance, so that those are the ones with
// the largest ratios; equilibria have next to none under the others.
#include "unsettled.h"

#include "basics/memory.h"

#include <stdlib.h>

struct load {
    double ratio;
    int step;
};

static int by_falling_ratio(const void *a, const void *b)
{
    const struct load *x = a, *y = b;
    if (x->ratio != y->ratio) return x->ratio < y->ratio ? 1 : -1;
    return x->step - y->step;
}

static bool has_load(const struct loads *loads, int step)
{
    return loads->dry_is_loaded || loads->saturation[step] > 0;
}

// (n) whether each came to no rest; the caller frees it.
static bool *find_unsettled(const struct loads *loads, int n_unsettled)
{
    struct load *order = NEW_ARRAY(struct load, loads->n);
    bool *unsettled = NEW_ARRAY(bool, loads->n);
    int count = 0;
    for (int k = 0; k < loads->n; k++)
        if (has_load(loads, k)) order[count++] = (struct load){loads->ratio[k], k};
    qsort(order, (size_t)count, sizeof *order, by_falling_ratio);
    for (int k = 0; k < count && k < n_unsettled; k++)
        unsettled[order[k].step] = true;
    free(order);
    return unsettled;
}

int unsettled_cracks(const struct run *run, const struct loads *loads)
{
    if (run->n_unsettled == 0) return 0;
    bool *unsettled = find_unsettled(loads, run->n_unsettled);
    int count = 0;
    for (int k = 0, step = 0; k < run->n_crack; k++) {
        while (loads->time[step] < run->time[k])
            step++; // never past the last: no crack is later
        count += unsettled[step];
    }
    free(unsettled);
    return count;
}
