// SPDX-License-Identifier: GPL-3.0-or-later
// A weighted graph from which vertices are eliminated one by one. Each vertex holds its
// edges in a row; now and then the rest is compacted.
#pragma once

#include "conductance_matrix.h"

#include <stdbool.h>
#include <stddef.h>

// An edge as one of its vertices sees it. Weights are relative to the largest at the
// start. A float: the factor only preconditions, and two fit where one double would.
struct half_edge {
    float weight;
    int to; // n of the graph or more: a place without a row
};

// A vertex: its edges are half[first] to half[first + count - 1], in no order, each
// neighbour once. A row that needs more than CAPACITY moves to the end of HALF.
//
// To look for one neighbour in the row of a hub costs as much as the row is long. So
// its row only grows until the graph is compacted, and until then is no use once a
// neighbour has been eliminated: eliminated ones stay, and one neighbour may be there
// twice.
struct vertex {
    int first, count, capacity;
    bool eliminated, neighbour_eliminated; // beside: a neighbour went since the graph
                                           // was last packed
    bool is_hub;
};

// Given places have no row. The first N_KEPT of them, n to n + n_kept - 1, keep their
// names, and links that elimination leaves between them are gathered in LINK; the
// others are one, n + n_kept: edges to it are ground. It owns its arrays. Compacting
// the graph gives its vertices new numbers; INDEX has their numbers in the matrix.
struct elimination_graph {
    int n, n_kept;
    struct vertex *vertex; // (n)
    int *index;            // (n+n_kept+1) of each in the matrix; the last: ground
    struct half_edge *half;
    size_t n_half, capacity;
    int n_link, link_capacity;
    struct link
        *link; // (n_link) conductances are weights; parallel ones are not merged
};

// The graph of MATRIX, whose largest conductance is MAX_WEIGHT. The caller frees it
// with elimination_graph_free. Parallel links become one edge.
struct elimination_graph elimination_graph_of(const struct conductance_matrix *matrix,
                                              int n_kept, double max_weight);
void elimination_graph_free(struct elimination_graph *graph);

// Replaces the edge from AT to ELIMINATED by one of WEIGHT between AT and OTHER, merged
// with one that is there already. Given places keep no edges.
void elimination_graph_replace_edge(struct elimination_graph *graph, int at,
                                    int eliminated, int other, float weight);

// Removes the edge from AT to ELIMINATED, which must be there; not the one back.
void elimination_graph_remove_edge(struct elimination_graph *graph, int at,
                                   int eliminated);

// Drops the eliminated vertices; the others are renumbered in the same order. INDEX
// follows.
void elimination_graph_compact(struct elimination_graph *graph);
