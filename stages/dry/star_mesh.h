// SPDX-License-Identifier: GPL-3.0-or-later
// Conductances between sites, and between each site and the air, from which sites are
// eliminated one by one. An eliminated site leaves links between all its neighbours,
//     c_jk += c_ij c_ik / sum_l c_il   (star-mesh transformation),
// so what is left carries the same flows. Sums and products of positive numbers only:
// every conductance keeps its digits over any range (Grassmann, Taksar and Heyman
// 1985).
//
// Sites are kept in tiles of eight, and conductances in blocks between tiles. Sites of
// one region, which should be near each other, share tiles.
#ifndef CRAQUELURE_STAR_MESH_H
#define CRAQUELURE_STAR_MESH_H

#include "compensated.h"

enum { TILE_LANES = 8 };

struct tile;

struct star_mesh {
    int n_site;
    const int *region; // (n_site)
    int *slot;         // (n_site) lane of a tile, -1 where the site is not in the mesh

    struct tile *tile;
    int n_tile, tile_capacity;
    double *air;                // (n_tile TILE_LANES) conductance to the air
    struct compensated all_air; // its sum
    int *site;                  // (n_tile TILE_LANES) -1 where free
    int *first_tile;            // (n_region) -1: none
    int *place;          // (n_tile) among the neighbours of the site eliminated, -1
    int *met;            // (n_tile) workspace, -1 between calls
    double (*block)[64]; // by lanes of the tile numbered higher, then lower
    int n_block, block_capacity;
    int *unused_block;
    int n_unused, unused_capacity;

    // New links below DROP are left out; DROPPED is their sum. No flow is then wrong by
    // more than that times the largest fall of the potential (Rayleigh).
    double drop, dropped;

    // What the last elimination changed.
    int n_changed, changed_capacity;
    int *changed; // (n_changed) sites whose conductance to the air has grown

    struct star *star; // workspace
};

// No site is in it. REGION (0..N_REGION-1) is kept and must live as long.
struct star_mesh star_mesh_make(int n_site, int n_region, const int *region);

// Adds to the conductance between A and B, which enter the mesh if they were not there.
void star_mesh_link(struct star_mesh *mesh, int a, int b, double conductance);
void star_mesh_link_air(struct star_mesh *mesh, int site, double conductance);

// SITE leaves the mesh. O(neighbours^2).
void star_mesh_eliminate(struct star_mesh *mesh, int site);

// Conductance between SITE and the air; 0 if it is not in the mesh.
double star_mesh_air(const struct star_mesh *mesh, int site);

void star_mesh_free(struct star_mesh *mesh);

#endif
