// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "kron_fronts.h"
#include "kron_fronts_internal.h"

#include <stdlib.h>

// Each is for a place of its own on a front that holds its site there.
static bool memberships_fit(const struct kron_fronts *mesh, bool *is_used)
{
    int used = 0, places = 0;
    for (int site = 0; site < mesh->n_site; site++)
        for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next) {
            const struct membership *m = &mesh->membership[k];
            const struct front *front = &mesh->front[m->front];
            if (is_used[k] || m->place >= front->n || front->site[m->place] != site)
                return false;
            is_used[k] = true;
            used++;
        }
    for (int f = 0; f < mesh->n_front; f++)
        places += mesh->front[f].n;
    for (int k = mesh->unused_membership; k >= 0; k = mesh->membership[k].next) {
        if (is_used[k]) return false;
        is_used[k] = true;
        used++;
    }
    return used == mesh->n_membership && places <= used;
}

// No place is held twice: as many memberships are on fronts as there are places.
static bool places_fit(const struct kron_fronts *mesh)
{
    int *held = NEW_ARRAY(int, mesh->n_front);
    bool fits = true;
    for (int site = 0; site < mesh->n_site; site++)
        for (int k = mesh->first[site]; k >= 0; k = mesh->membership[k].next)
            held[mesh->membership[k].front]++;
    for (int f = 0; f < mesh->n_front; f++)
        fits &= held[f] == mesh->front[f].n;
    free(held);
    return fits;
}

// Those that are not used are listed once each, and have no sites; others have two or
// more.
static bool fronts_fit(const struct kron_fronts *mesh)
{
    int empty = 0, listed = 0;
    for (int f = 0; f < mesh->n_front; f++) {
        empty += mesh->front[f].n == 0;
        if (mesh->front[f].n == 1) return false;
    }
    for (int f = mesh->unused_front; f >= 0 && listed <= empty;
         f = mesh->front[f].next_unused, listed++)
        if (mesh->front[f].n > 0) return false;
    return listed == empty;
}

bool kron_fronts_fit(const struct kron_fronts *mesh)
{
    for (int i = 0; i < mesh->n_site; i++)
        if (!(mesh->air_conductance[i] >= 0)) return false;
    if (!fronts_fit(mesh)) return false;
    bool *is_used = NEW_ARRAY(bool, mesh->n_membership);
    const bool fits = memberships_fit(mesh, is_used) && places_fit(mesh);
    free(is_used);
    return fits;
}
