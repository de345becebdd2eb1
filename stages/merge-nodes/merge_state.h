// SPDX-License-Identifier: GPL-3.0-or-later
// The state behind merge_nodes: which nodes are one, which throats they have, and
// which throat is the shortest.
#pragma once

#include "network/network.h"

#include <stdbool.h>

// Throats at one node; some may have been removed since.
struct throat_row {
    int *throat;
    int count, capacity;
};

// A throat in the queue; out of date when its stamp is not the throat's.
struct queued {
    double length;
    int32_t nodes[2]; // as they were numbered at first
    int throat, stamp;
};

struct merging {
    struct network *network;
    int *parent; // (n_node) union-find
    // (n_node) Where the box repeats: in which repetition of its parent a node is; of
    // roots, in which repetition of what POSITION says.
    struct image *image;
    struct vector *position; // (n_node) of roots
    double *weight; // (n_node) of roots: how many nodes its place is the mean of
    uint8_t *walls; // (n_node) of roots
    struct throat_row *row; // (n_node) of roots
    bool *gone;             // (n_throat)
    int *stamp;             // (n_throat) raised whenever its length changes
    struct queued *queue;   // binary heap
    int n_queue, queue_capacity;
    int removed;
};

// Starts with all throats of NETWORK in the queue, parallel ones fused. NETWORK is in
// use until merging_finish.
struct merging merging_begin(struct network *network);

// The two nodes that a throat joins now, and the image of the box in which the first
// sees the second.
struct merging_ends {
    int node[2];
    struct image image;
};
struct merging_ends merging_ends(struct merging *merging, int throat);

// The same as seen from the second node.
struct merging_ends merging_reversed(struct merging_ends ends);

// The vector from the first of ENDS to the second, m.
struct vector merging_vector(const struct merging *merging, struct merging_ends ends);

// Takes the shortest throat off the queue, LENGTH in m. False when none is left.
bool merging_shortest(struct merging *merging, int *throat, double *length);

// Removes the throat.
void merging_remove(struct merging *merging, int throat);

// Gives the VOLUME (m3) of a removed throat to the throats at ROOT, in proportion to
// theirs (equally if they have none). Returns what is lost: all of it, if ROOT has no
// throats, else 0.
double merging_share_volume(struct merging *merging, int root, double volume);

// Gives the throats of OTHER to ROOT, fuses those that have become parallel, and
// measures the lengths that have changed: of the throats given, and of all of ROOT if
// it MOVED.
void merging_move_throats(struct merging *merging, int root, int other, bool moved);

// Writes the merged network back, renumbered in the old order, and frees MERGING.
void merging_finish(struct merging *merging);
