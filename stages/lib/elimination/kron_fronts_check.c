// SPDX-License-Identifier: GPL-3.0-or-later
// Consistency of a restored state: each membership stands for a place of its own on a
// front that holds its site there, and unused entries are listed once. A damaged file
// is refused before anything reads past an array.
#include "basics/memory.h"
#include "kron_fronts.h"
#include "kron_fronts_internal.h"

#include <stdlib.h>

// Each membership stands for a place on a front that holds its site there.
static bool memberships_fit(const struct kron_fronts *fronts, bool *is_used)
{
    int used = 0, places = 0;
    for (int site = 0; site < fronts->n_site; site++)
        for (int k = fronts->first[site]; k >= 0; k = fronts->membership[k].next) {
            const struct membership *m = &fronts->membership[k];
            const struct front *front = &fronts->front[m->front];
            if (is_used[k] || m->place >= front->n || front->site[m->place] != site)
                return false;
            is_used[k] = true;
            used++;
        }
    for (int f = 0; f < fronts->n_front; f++)
        places += fronts->front[f].n;
    for (int k = fronts->unused_membership; k >= 0; k = fronts->membership[k].next) {
        if (is_used[k]) return false;
        is_used[k] = true;
        used++;
    }
    return used == fronts->n_membership && places <= used;
}

// No place is held twice: as many memberships are on fronts as there are places.
static bool places_fit(const struct kron_fronts *fronts)
{
    int *held = NEW_ARRAY(int, fronts->n_front);
    bool fits = true;
    for (int site = 0; site < fronts->n_site; site++)
        for (int k = fronts->first[site]; k >= 0; k = fronts->membership[k].next)
            held[fronts->membership[k].front]++;
    for (int f = 0; f < fronts->n_front; f++)
        fits &= held[f] == fronts->front[f].n;
    free(held);
    return fits;
}

// Unused fronts are listed once each and have no sites; others have two or more.
static bool fronts_fit(const struct kron_fronts *fronts)
{
    int empty = 0, listed = 0;
    for (int f = 0; f < fronts->n_front; f++) {
        empty += fronts->front[f].n == 0;
        if (fronts->front[f].n == 1) return false;
    }
    for (int f = fronts->unused_front; f >= 0 && listed <= empty;
         f = fronts->front[f].next_unused, listed++)
        if (fronts->front[f].n > 0) return false;
    return listed == empty;
}

bool kron_fronts_fit(const struct kron_fronts *fronts)
{
    for (int i = 0; i < fronts->n_site; i++)
        if (!(kron_fronts_air(fronts, i) >= 0)) return false;
    if (!fronts_fit(fronts)) return false;
    bool *is_used = NEW_ARRAY(bool, fronts->n_membership);
    const bool fits = memberships_fit(fronts, is_used) && places_fit(fronts);
    free(is_used);
    return fits;
}
