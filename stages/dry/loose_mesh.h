// SPDX-License-Identifier: GPL-3.0-or-later
// A star mesh (star_mesh.h) that is not exact in large fronts, with an error that is
// known: sites far from one that is eliminated, and far from each other, are not
// linked.
//
// Their links are kept as links to elsewhere, which is at 0 as the sites beyond are
// now. So what is known of links and of the air is never more than exact (the maximum
// principle), and what has flowed elsewhere since the air was last put right is all
// that is missing of it.
#ifndef CRAQUELURE_LOOSE_MESH_H
#define CRAQUELURE_LOOSE_MESH_H

#include "basics/compensated.h"

#include <stdbool.h>

struct front;
struct membership; // a site's being on a front

struct loose_mesh {
    int n_site;
    const int *key;   // (n_site)
    double threshold; // of sheets
    double report;    // part of what a patch gives off that may change unreported

    double *air;                // (n_site) conductance to the air, as far as known
    struct compensated all_air; // its sum
    double summed_air;          // the sum when all were last added up
    double *elsewhere;          // (n_site) conductance to sites left out
    double *reported;           // (n_site) of the conductance to the air
    struct compensated all_reported;
    double scale; // the sum of all conductances to the air, over that of those known
    double lost;  // of that sum: what has gone elsewhere

    int *first; // (n_site) its memberships, -1: none
    struct membership *membership;
    int n_membership, membership_capacity, unused_membership;
    struct front *front;
    int n_front, front_capacity, unused_front;

    // Sites whose air has been reported since the changes were last forgotten, each
    // once; some may have been eliminated themselves.
    int n_changed;
    int *changed;     // (n_changed)
    bool *is_changed; // (n_site)

    int row_capacity, left_out_capacity;
    double *row;      // of the site that is eliminated
    double *left_out; // of each of its patches
};

// No links yet. KEY (n_site), kept by the caller: sites near each other have the same.
// Links between patches are left out if their parts of the links of the site
// eliminated, multiplied, are THRESHOLD or less.
struct loose_mesh loose_mesh_make(int n_site, const int *key, double threshold,
                                  double report);

// Adds to the conductance between A and B, of which none has been eliminated, or
// between SITE and the air.
void loose_mesh_link(struct loose_mesh *mesh, int a, int b, double conductance);
void loose_mesh_link_air(struct loose_mesh *mesh, int site, double conductance);

// SITE leaves the mesh.
void loose_mesh_eliminate(struct loose_mesh *mesh, int site);

// Conductance of SITE to the air, as last reported, once multiplied by the scale, which
// all have in common; and the sum of all.
double loose_mesh_air(const struct loose_mesh *mesh, int site);
double loose_mesh_scale(const struct loose_mesh *mesh);
double loose_mesh_rate(const struct loose_mesh *mesh);

// Puts the air right. The conductance of each site that is left is told, one after the
// other, between begin and end; that of one from which no way leads stays 0. RATE:
// their sum, as it is known better.
void loose_mesh_begin_air(struct loose_mesh *mesh);
void loose_mesh_put_air(struct loose_mesh *mesh, int site, double conductance);
void loose_mesh_end_air(struct loose_mesh *mesh, double rate);

void loose_mesh_forget_changes(struct loose_mesh *mesh);

void loose_mesh_free(struct loose_mesh *mesh);

#endif
