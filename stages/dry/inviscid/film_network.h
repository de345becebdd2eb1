// SPDX-License-Identifier: GPL-3.0-or-later
// The films of a moment as a network. Its sites are nodes without liquid in throats,
// where rings are, and clusters of liquid. Its links are films: in the corners of
// throats that have emptied, between nodes that are wet.
//
// A node beside liquid counts as its cluster. Where several clusters are beside it, the
// film is divided among them in proportion to the cross-sections of their throats, as
// what the node evaporates is: so clusters are not joined at a node, only by films.
#pragma once

#include "dry/liquid/occupancy.h"
#include "elimination/conductance_matrix.h"

// A film between two places.
struct film_link {
    struct link link;
    double depth; // of the throat's middle, as film_depth says
    double ratio; // of what flows there to what would without gravity
};

// It owns its arrays. Only sites that films join to a cluster are there: clusters
// first, then nodes, those with few films before others, and of these in the order of
// CURVE. So rows of the matrix have one length for long, and sites beside each other
// are near in memory, which makes sweeps and products faster.
struct film_network {
    int n_site;
    int *place;                       // (n_site) a cluster, or n_throat + node
    int *root;                        // (n_site) the first site that films join to it
    struct conductance_matrix matrix; // (n_site) conductances, scaled
    int n_link;
    struct film_link *link; // (n_link) of sites
};

// Of OCCUPANCY, whose film law says what a throat conducts. CURVE (n_node): all nodes,
// in the order of order_along_curve. O(n_node). The caller frees it with
// film_network_free.
struct film_network film_network_init(const struct occupancy *occupancy,
                                      const int32_t *curve);

// How deep the middle of THROAT is below the top of the box, scaled; 0 without gravity.
double film_depth(const struct occupancy *occupancy, int throat);

// Under gravity: conductances as LEVELs (n_site) make them. Returns by how much the
// flows between sites with these levels change, in all.
double film_network_weigh(struct film_network *films, const struct film_law *law,
                          const struct compensated *level);

void film_network_free(struct film_network *films);
