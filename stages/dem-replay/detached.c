// SPDX-License-Identifier: GPL-3.0-or-later
// A grain that never had a bond did not detach from the body: it was none of its
// grains.
#include "detached.h"

#include "basics/memory.h"

#include <stdlib.h>

void count_detached(struct run *run, const bool *have_left, int first)
{
    const struct packing *packing = run->packing;
    struct response *response = run->response;
    bool *had_bond = NEW_ARRAY(bool, packing->n_particle);
    for (int b = 0; b < packing->n_bond; b++)
        for (int end = 0; end < 2; end++)
            had_bond[packing->bond[b][end]] = true;
    for (int i = 0; i < packing->n_particle; i++) {
        if (!have_left[i]) continue;
        if (!had_bond[i])
            response->n_unbonded++;
        else if (response->n_detached++ == 0)
            response->first_detached = first >= 0 && had_bond[first] ? first : i;
    }
    free(had_bond);
}
