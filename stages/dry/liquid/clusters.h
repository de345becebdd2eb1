// SPDX-License-Identifier: GPL-3.0-or-later
// The connected clusters of liquid, kept up to date as throats empty, and the throat
// where gas enters each [K 3.4.2, steps 1 and 2].
//
// Liquid throats are connected through nodes. When one empties, only its neighbours can
// be separated: searches start from each of them and advance in turn; those that meet
// are united, one that is exhausted has found a new cluster, and the last keeps the old
// identity without a search to its end. So a split costs as much as its smaller parts.
#pragma once

#include "checkpoint/stream.h"
#include "network/network.h"

#include <stdbool.h>

// A binary heap of throat ranks, lowest (gas enters it first) on top. Throats that have
// left the cluster stay until they come to the top.
struct rank_heap {
    int *rank;
    int n, capacity;
};

struct search; // one of the searches that take turns

struct clusters {
    const struct network *network;
    const struct incidence *incidence;
    bool gas_parts;         // whether gas in a node separates the liquid around it
    bool never_part;        // films keep together what was a cluster at the start
    bool *joins;            // (n_node) liquid is connected through this node
    int *of_throat;         // (n_throat) its cluster, -1 if it holds no liquid
    bool *meniscus;         // (n_throat) gas touches one of its ends
    int count;              // of clusters
    int n_id;               // cluster identities given out so far, the unused included
    int *size;              // (n_id) throats
    struct rank_heap *heap; // (n_id) menisci
    int *unused;            // identities to give out again
    int n_unused, capacity, unused_capacity;

    int *rank;           // (n_throat) 0: gas enters it first; ties by index
    int *throat_at_rank; // (n_throat)

    int n_moved, moved_capacity;
    int *moved; // (n_moved) throats that changed cluster when the last throat emptied

    int *found_by; // (n_throat) search that has been there, -1: none
    struct search *search;
    int n_search, search_capacity;
};

// All throats of kind THROAT_NETWORK hold liquid, all nodes join, no menisci yet. Gas
// enters throats as order_throats says for ENTRY_PRIORITY (n_throat; NULL: their
// radii). Keeps NETWORK and INCIDENCE, which must live as long. O(n log n). The caller
// frees it with clusters_free.
struct clusters clusters_init(const struct network *network,
                              const struct incidence *incidence,
                              const double *entry_priority, bool gas_parts);

// Gas has come to NODE from outside: its liquid throats have menisci there, and the
// liquid is connected through it as before.
void clusters_add_menisci(struct clusters *clusters, int node);

// THROAT has emptied and gas fills both its nodes: splits its cluster, lists the
// throats of new clusters in MOVED, adds menisci at both nodes. O(smaller parts).
void clusters_empty_throat(struct clusters *clusters, int throat);

// The meniscus throat of CLUSTER that gas enters first; -1 if no gas touches it.
// Removes outdated entries from the heap: amortised O(log n).
int clusters_invasion_throat(struct clusters *clusters, int cluster);

// Writes the clusters to STREAM, or restores them. Ranks and searches are not in it.
void clusters_state(struct clusters *clusters, struct checkpoint_stream *stream);

void clusters_free(struct clusters *clusters);
