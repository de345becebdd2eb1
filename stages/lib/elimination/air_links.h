// SPDX-License-Identifier: GPL-3.0-or-later
// The conductance of each site to the air, or what it evaporates into air at potential
// 1. Those above 0 lie side by side, few enough for the cache.
#pragma once

#include "basics/compensated.h"
#include "checkpoint/stream.h"

// It owns its arrays, with room for the capacities named beside them. Unused places
// have 0.
struct air_links {
    int n_site;
    int *place; // (n_site) -1: none
    int n, capacity;
    double *conductance; // (n)
    int *site;           // (n) whose place it is, or was last
    int n_unused;
    int *unused;            // (n_unused) places
    struct compensated all; // the sum of all conductances
    double summed;          // the sum when all were last added up

    // Sites that have come to have a conductance to the air since N_REACHED was last
    // set to 0; some may have left.
    int n_reached;
    int *reached; // (n_reached)
};

// No site has any. The caller frees it with air_links_free.
struct air_links air_links_init(int n_site);
void air_links_free(struct air_links *air);

// Of SITE, 0 if it has none.
static inline double air_links_of(const struct air_links *air, int site)
{
    const int place = air->place[site];
    return place < 0 ? 0 : air->conductance[place];
}

// Adds to that of SITE, and, with _link, to the sum of all. CONDUCTANCE >= 0.
void air_links_add(struct air_links *air, int site, double conductance);
void air_links_link(struct air_links *air, int site, double conductance);

// SITE leaves; returns what it had. The sum stays.
double air_links_take(struct air_links *air, int site);

// Takes DROP from the sum of all.
void air_links_lower(struct air_links *air, double drop);

// All conductances become 0; places stay.
void air_links_clear(struct air_links *air);

// Keeps or restores all but the sites just reached.
void air_links_state(struct air_links *air, struct checkpoint_stream *stream);
