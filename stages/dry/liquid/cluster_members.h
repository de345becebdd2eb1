// SPDX-License-Identifier: GPL-3.0-or-later
// The throats of each cluster in two lists: those that gas touches, and the others. As
// a throat empties, only those lists change that it or its neighbours are on.
#ifndef CRAQUELURE_THROAT_LISTS_H
#define CRAQUELURE_THROAT_LISTS_H

#include "clusters.h"

enum throat_list { LIST_INSIDE, LIST_MENISCI, LISTS };

struct throat_lists {
    int *cluster;   // (n_throat) on whose lists it is, -1: none
    int *next;      // (n_throat) on its list, -1: the last
    int *before;    // (n_throat) -1: the first
    int *of_throat; // (n_throat) enum throat_list
    int capacity;
    int (*first)[LISTS]; // (capacity, of which n_id are given out) -1: none
};

// The caller frees it with throat_lists_free.
struct throat_lists throat_lists_make(const struct clusters *clusters, int n_throat);

// Puts THROAT where CLUSTERS has it now.
void throat_lists_follow(struct throat_lists *lists, const struct clusters *clusters,
                         int throat);

static inline int throat_lists_first(const struct throat_lists *lists, int cluster,
                                     enum throat_list list)
{
    return cluster < lists->capacity ? lists->first[cluster][list] : -1;
}

void throat_lists_free(struct throat_lists *lists);

#endif
