// SPDX-License-Identifier: GPL-3.0-or-later
// What fronts are made of; for kron_fronts*.c only.
#ifndef CRAQUELURE_KRON_FRONTS_INTERNAL_H
#define CRAQUELURE_KRON_FRONTS_INTERNAL_H

#include "dense_front.h"

// One for each site on each front, in a list per site (kron_fronts.first). Unused ones
// are a list of their own, so that no index ever moves.
struct membership {
    int front, place;
    int next; // of the site, or of those unused; -1: the last
};

// Sites that are all linked with each other: entry (i, j) of `dense` is the conductance
// between site[i] and site[j]. It owns SITE and DENSE. NEXT_UNUSED links those that
// were merged into another.
struct front {
    int n, capacity;
    int *site;                // (n)
    struct dense_front dense; // of their links
    int next_unused;
};

// A front of two sites, as kron_fronts_list lists it.
struct pair {
    int a, b;
    double conductance;
};

#endif
