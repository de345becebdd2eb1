// SPDX-License-Identifier: GPL-3.0-or-later
// What an elimination changes in the conductances to the air: those of all sites of a
// front. A large front knows the places of its sites.
#include "basics/memory.h"
#include "kron_fronts.h"
#include "kron_fronts_internal.h"

void air_find_places(struct front *front)
{
    front->air_place = NEW_ARRAY(int, front->capacity);
    for (int i = 0; i < front->n; i++)
        front->air_place[i] = -1;
}

void air_raise(struct kron_fronts *fronts, struct front *front, double share)
{
    struct air_links *air = &fronts->air;
    for (int i = 0; i < front->n && !front->air_place; i++)
        air_links_add(air, front->site[i], fronts->row[i] * share);
    for (int i = 0; i < front->n && front->air_place; i++) {
        const int place = front->air_place[i];
        if (place >= 0) {
            air->conductance[place] += fronts->row[i] * share;
            continue;
        }
        air_links_add(air, front->site[i], fronts->row[i] * share);
        front->air_place[i] = air->place[front->site[i]];
    }
}
