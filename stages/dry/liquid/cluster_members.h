// SPDX-License-Identifier: GPL-3.0-or-later
// The throats of each cluster in two lists: those that gas touches, and the others.
// When a throat empties only the lists of its neighbours and of moved throats change.
// Without lists each event would have to look at all throats of its cluster.
#pragma once

#include "clusters.h"

enum throat_list { LIST_INSIDE, LIST_MENISCI, LISTS };

// It owns its arrays. Each throat with liquid is on one list, doubly linked; a throat
// without is on none.
struct cluster_members {
    int *cluster;   // (n_throat) on whose lists it is, -1: none
    int *next;      // (n_throat) on its list, -1: the last
    int *before;    // (n_throat) -1: the first
    int *of_throat; // (n_throat) enum throat_list
    int capacity;
    int (*first)[LISTS]; // (capacity, of which n_id are given out) -1: none
};

// The caller frees it with cluster_members_free. O(n_throat).
struct cluster_members cluster_members_init(const struct clusters *clusters,
                                            int n_throat);

// Moves THROAT to the list where CLUSTERS has it now; off all lists once it is empty.
// O(1). Call it for every throat whose cluster or meniscus may have changed.
void cluster_members_follow(struct cluster_members *members,
                            const struct clusters *clusters, int throat);

// The first throat on LIST of CLUSTER, -1: none. The others by `next`. The order
// depends on what was moved before; the set does not.
static inline int cluster_members_first(const struct cluster_members *members,
                                        int cluster, enum throat_list list)
{
    return cluster < members->capacity ? members->first[cluster][list] : -1;
}

void cluster_members_free(struct cluster_members *members);
