// SPDX-License-Identifier: GPL-3.0-or-later
// What a star mesh is made of; for star_mesh*.c only.
#ifndef CRAQUELURE_STAR_MESH_FRONTS_H
#define CRAQUELURE_STAR_MESH_FRONTS_H

#include "dense_front.h"

struct membership {
    int front, place;
    int next; // of the site, or of those unused; -1: the last
};

struct front {
    int n, capacity;
    int *site;                // (n)
    struct triangle triangle; // of their links
    int next_unused;
};

struct pair {
    int a, b;
    double conductance;
};

#endif
