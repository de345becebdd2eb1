// SPDX-License-Identifier: GPL-3.0-or-later
// What fronts are made of; for kron_fronts*.c only.
#ifndef CRAQUELURE_KRON_FRONTS_INTERNAL_H
#define CRAQUELURE_KRON_FRONTS_INTERNAL_H

#include "dense_front.h"

struct membership {
    int front, place;
    int next; // of the site, or of those unused; -1: the last
};

struct front {
    int n, capacity;
    int *site;                // (n)
    struct dense_front dense; // of their links
    int next_unused;
};

struct pair {
    int a, b;
    double conductance;
};

#endif
