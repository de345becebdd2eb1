// SPDX-License-Identifier: GPL-3.0-or-later
// Conductances between sites, and between each site and the air, from which sites are
// eliminated one by one. An eliminated site leaves links between all its neighbours,
//     c_jk += c_ij c_ik / sum_l c_il   (star-mesh transformation, Kron reduction),
// so the remaining network carries the same flows. Sums, products and quotients of
// positive numbers only: every conductance keeps its digits over any range (Grassmann,
// Taksar and Heyman 1985).
//
// All sites beside one connected piece of eliminated ones are linked with each other;
// such a front is stored as a dense triangle. A site may be on several fronts, which
// are merged when it is eliminated (the multifrontal method, in an order that is given
// as it goes).
#pragma once

#include "air_links.h"

#include <stdbool.h>

struct front;
struct membership; // a site's place on a front

// It owns its arrays, with room for the capacities named beside them.
struct kron_fronts {
    int n_site;
    bool is_rounded; // links on large fronts are floats
    int *first;      // (n_site) its memberships, -1: none

    struct air_links air; // of the sites that remain

    struct membership *membership;
    int n_membership, membership_capacity, unused_membership;
    struct front *front;
    int n_front, front_capacity, unused_front;

    double *row; // of the site that is eliminated
    int *place;  // on a front, of the members of one that joins it
    int row_capacity, place_capacity;

    // As listed last.
    int n_pair, pair_capacity, n_wide, wide_capacity;
    struct pair *pair; // (n_pair) fronts of two sites
    int *wide;         // (n_wide) those of more
    int widest;        // sites on one
};

// No links yet. ROUNDED: links on large fronts are kept as floats. The caller frees it
// with kron_fronts_free.
struct kron_fronts kron_fronts_init(int n_site, bool is_rounded);

// Adds to the conductance between A and B, of which none has been eliminated, or
// between SITE and the air. CONDUCTANCE > 0, in any one unit.
void kron_fronts_link(struct kron_fronts *fronts, int a, int b, double conductance);
void kron_fronts_link_air(struct kron_fronts *fronts, int site, double conductance);

// Conductance between SITE and the air.
static inline double kron_fronts_air(const struct kron_fronts *fronts, int site)
{
    return air_links_of(&fronts->air, site);
}

// Eliminates SITE. O(n^2) for a front of n sites.
void kron_fronts_eliminate(struct kron_fronts *fronts, int site);

// Adds the pending updates of the fronts of SITE; before kron_fronts_list_links.
void kron_fronts_flush(struct kron_fronts *fronts, int site);

// Does that everywhere, and lists all links; before kron_fronts_add_flows. Lists hold
// until the next elimination.
void kron_fronts_list(struct kron_fronts *fronts);

// Adds to FLOW (n_site) the flow to each site from the others when sites have the
// potential LEVEL (n_site). Not where links are floats.
void kron_fronts_add_flows(const struct kron_fronts *fronts, const double *level,
                           double *flow);

// Lists in OTHER the sites that SITE is linked with, and in LINK (n_site), which is 0
// before, the conductances at their places. Returns how many there are.
int kron_fronts_list_links(const struct kron_fronts *fronts, int site, int *other,
                           double *link);

// Keeps or restores all of it.
void kron_fronts_state(struct kron_fronts *fronts, struct checkpoint_stream *stream);

// Whether fronts and memberships of a restored state agree.
bool kron_fronts_fit(const struct kron_fronts *fronts);

void kron_fronts_free(struct kron_fronts *fronts);
