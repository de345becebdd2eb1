// SPDX-License-Identifier: GPL-3.0-or-later
// Two doubly linked lists of throats for each cluster, menisci and others, so that a
// throat moves from list to list in O(1) when its cluster splits or gas reaches it.
// Every throat with liquid is on one list: of_throat says which kind, cluster whose.
// The trap: identities of clusters are used again. So whoever splits or empties a
// cluster must call cluster_members_follow for each throat that it moves.
#include "cluster_members.h"

#include "basics/memory.h"

#include <stdlib.h>

// GROW_ARRAY doubles; what is new gets empty lists.
static void reserve(struct cluster_members *members, int cluster)
{
    const int before = members->capacity;
    while (members->capacity <= cluster)
        GROW_ARRAY(members->first, members->capacity, members->capacity);
    for (int c = before; c < members->capacity; c++)
        for (int l = 0; l < LISTS; l++)
            members->first[c][l] = -1;
}

// The first of a list has no predecessor: then the head of the list moves.
static void take_out(struct cluster_members *members, int throat)
{
    const int next = members->next[throat], before = members->before[throat];
    if (next >= 0) members->before[next] = before;
    if (before >= 0)
        members->next[before] = next;
    else
        members->first[members->cluster[throat]][members->of_throat[throat]] = next;
}

static void put_first(struct cluster_members *members, int throat, int cluster,
                      int list)
{
    reserve(members, cluster);
    int *first = &members->first[cluster][list];
    members->cluster[throat] = cluster;
    members->of_throat[throat] = list;
    members->before[throat] = -1;
    members->next[throat] = *first;
    if (*first >= 0) members->before[*first] = throat;
    *first = throat;
}

// Nothing where the throat is where it should be; -1 as a cluster is that of empty
// throats.
void cluster_members_follow(struct cluster_members *members,
                            const struct clusters *clusters, int throat)
{
    const int cluster = clusters->of_throat[throat];
    const int list = clusters->meniscus[throat] ? LIST_MENISCI : LIST_INSIDE;
    const int old = members->cluster[throat];
    if (old == cluster && (old < 0 || members->of_throat[throat] == list)) return;
    if (old >= 0) take_out(members, throat);
    members->cluster[throat] = -1;
    if (cluster >= 0) put_first(members, throat, cluster, list);
}

// From the last throat, so that each list begins with its lowest one.
struct cluster_members cluster_members_init(const struct clusters *clusters,
                                            int n_throat)
{
    struct cluster_members members = {.cluster = NEW_ARRAY(int, n_throat),
                                      .next = NEW_ARRAY(int, n_throat),
                                      .before = NEW_ARRAY(int, n_throat),
                                      .of_throat = NEW_ARRAY(int, n_throat)};
    for (int t = n_throat - 1; t >= 0; t--) {
        members.cluster[t] = -1;
        cluster_members_follow(&members, clusters, t);
    }
    return members;
}

void cluster_members_free(struct cluster_members *members)
{
    free(members->cluster);
    free(members->next);
    free(members->before);
    free(members->of_throat);
    free(members->first);
    *members = (struct cluster_members){0};
}
