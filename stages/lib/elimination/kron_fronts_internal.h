// SPDX-License-Identifier: GPL-3.0-or-later
// What fronts are made of; for kron_fronts*.c only.
#pragma once

#include "dense_front.h"
#include "kron_fronts.h"

// One for each site on each front, in a list per site (kron_fronts.first). Unused ones
// are a list of their own, so that no index ever moves.
struct membership {
    int front, place;
    int next; // of the site, or of those unused; -1: the last
};

// Sites that are all linked with each other: entry (i, j) of `dense` is the conductance
// between site[i] and site[j]. It owns its arrays and DENSE. NEXT_UNUSED links those
// that were merged into another.
struct front {
    int n, capacity;
    int *site;      // (n)
    int *air_place; // (n) of the site, -1: not known here; NULL if it is small
    struct dense_front dense; // of their links
    int next_unused;
};

// A front of two sites, as kron_fronts_list lists it.
struct pair {
    int a, b;
    double conductance;
};

// kron_fronts_air.c. AIR_FIND_PLACES makes front->air_place. AIR_RAISE adds SHARE of
// fronts->row to the conductances to the air of the front.
void air_raise(struct kron_fronts *fronts, struct front *front, double share);
void air_find_places(struct front *front);
