// SPDX-License-Identifier: GPL-3.0-or-later
// The bookkeeping behind merge_nodes: which nodes are one, which throats they have,
// which throat is the shortest.
#ifndef CRAQUELURE_MERGE_STATE_H
#define CRAQUELURE_MERGE_STATE_H

#include "network/network.h"

#include <stdbool.h>

// Throats at one node, those removed since still among them.
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

// All throats of NETWORK in the queue; merging_finish gives it back.
struct merging merging_begin(struct network *network);

// The two nodes that a throat joins now, and where the box repeats the second as seen
// from the first.
struct merging_ends {
    int node[2];
    struct image image;
};
struct merging_ends merging_ends(struct merging *merging, int throat);

// The same, seen from the second.
struct merging_ends merging_reversed(struct merging_ends ends);

// From the first of ENDS to the second.
struct vector merging_vector(const struct merging *merging, struct merging_ends ends);

// Takes the shortest throat left off the queue. False when none is left.
bool merging_shortest(struct merging *merging, int *throat, double *length);

// From now on the throat is gone.
void merging_remove(struct merging *merging, int throat);

// Hands the VOLUME of a throat that is gone to those at ROOT, in proportion to what
// they have (equally where they have none). Returns what no throat was there to take.
double merging_share_volume(struct merging *merging, int root, double volume);

// Gives the throats of OTHER to ROOT, fusing those that have become parallel, and
// measures again what has changed: the moved ones, and all of ROOT if it MOVED itself.
void merging_move_throats(struct merging *merging, int root, int other, bool moved);

// Writes what is left back into the network, renumbered in the old order, and frees.
void merging_finish(struct merging *merging);

#endif
