// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster_members.h"

#include "basics/memory.h"

#include <stdlib.h>

static void reserve(struct cluster_members *lists, int cluster)
{
    const int before = lists->capacity;
    while (lists->capacity <= cluster)
        GROW_ARRAY(lists->first, lists->capacity, lists->capacity);
    for (int c = before; c < lists->capacity; c++)
        for (int l = 0; l < LISTS; l++)
            lists->first[c][l] = -1;
}

static void take_out(struct cluster_members *lists, int throat)
{
    const int next = lists->next[throat], before = lists->before[throat];
    if (next >= 0) lists->before[next] = before;
    if (before >= 0)
        lists->next[before] = next;
    else
        lists->first[lists->cluster[throat]][lists->of_throat[throat]] = next;
}

static void put_first(struct cluster_members *lists, int throat, int cluster, int list)
{
    reserve(lists, cluster);
    int *first = &lists->first[cluster][list];
    lists->cluster[throat] = cluster;
    lists->of_throat[throat] = list;
    lists->before[throat] = -1;
    lists->next[throat] = *first;
    if (*first >= 0) lists->before[*first] = throat;
    *first = throat;
}

void cluster_members_follow(struct cluster_members *lists,
                            const struct clusters *clusters, int throat)
{
    const int cluster = clusters->of_throat[throat];
    const int list = clusters->meniscus[throat] ? LIST_MENISCI : LIST_INSIDE;
    const int old = lists->cluster[throat];
    if (old == cluster && (old < 0 || lists->of_throat[throat] == list)) return;
    if (old >= 0) take_out(lists, throat);
    lists->cluster[throat] = -1;
    if (cluster >= 0) put_first(lists, throat, cluster, list);
}

struct cluster_members cluster_members_make(const struct clusters *clusters,
                                            int n_throat)
{
    struct cluster_members lists = {.cluster = NEW_ARRAY(int, n_throat),
                                    .next = NEW_ARRAY(int, n_throat),
                                    .before = NEW_ARRAY(int, n_throat),
                                    .of_throat = NEW_ARRAY(int, n_throat)};
    for (int t = n_throat - 1; t >= 0; t--) {
        lists.cluster[t] = -1;
        cluster_members_follow(&lists, clusters, t);
    }
    return lists;
}

void cluster_members_free(struct cluster_members *lists)
{
    free(lists->cluster);
    free(lists->next);
    free(lists->before);
    free(lists->of_throat);
    free(lists->first);
    *lists = (struct cluster_members){0};
}
