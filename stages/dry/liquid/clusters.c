// SPDX-License-Identifier: GPL-3.0-or-later
// Connected clusters of liquid as throats empty, without searching the whole network
// at each event. When a throat empties its cluster can only split at its two nodes.
// Breadth-first searches start from each neighbouring throat and advance by one
// throat in turn (Even and Shiloach 1981 interleave searches alike). Two that meet are
// united; one that is exhausted has found a new cluster; when one search is left its
// throats keep the old identity. So an event costs O(size of the smaller parts), and
// most cost O(1), since neighbours soon meet.
//
// What holds between events:
//     of_throat[t] = c   and   size[c] = how many t have it,
//     heap[c] has the rank of every meniscus of c, and maybe of throats that have left,
//     found_by[t] = -1   and   n_search = 0.
// The last is restored by forgetting what was found, throat by throat: clearing all of
// found_by would cost O(n_throat) an event. Arrays of searches are used again.
//
// Traps: an identity that has ended is given out again, so whoever remembers something
// by identity must follow each event (`moved`). Which part keeps the old identity
// depends on the order of the incidence, so runs repeat.
#include "clusters.h"

#include "basics/memory.h"
#include "network/entry_order.h"

#include <stdlib.h>
#include <string.h>

// The throats that one search has found, in order; those before NEXT are expanded.
struct search {
    int *throat;
    int n, next, capacity;
    int joined; // the search it was united with first, or itself
    int active; // of a root: searches united in it that have not run dry
};

// --- heap --------------------------------------------------------------------------

// A rank at most once in a heap: add_meniscus pushes it once, found_cluster once more,
// into the heap of a cluster just made.
static void heap_push(struct rank_heap *heap, int rank)
{
    GROW_ARRAY(heap->rank, heap->n, heap->capacity);
    int place = heap->n++;
    for (; place > 0 && heap->rank[(place - 1) / 2] > rank; place = (place - 1) / 2)
        heap->rank[place] = heap->rank[(place - 1) / 2];
    heap->rank[place] = rank;
}

static void heap_pop(struct rank_heap *heap)
{
    const int rank = heap->rank[--heap->n];
    int place = 0;
    for (int child = 1; child < heap->n; child = 2 * place + 1) {
        if (child + 1 < heap->n && heap->rank[child + 1] < heap->rank[child]) child++;
        if (heap->rank[child] >= rank) break;
        heap->rank[place] = heap->rank[child];
        place = child;
    }
    heap->rank[place] = rank;
}

// --- identities --------------------------------------------------------------------

// Both arrays have one capacity: the first grows by a copy, so that the second still
// sees the old one. Identities that have ended are given out first, so there are never
// more than there once were clusters at a time.
static int new_cluster(struct clusters *clusters)
{
    clusters->count++;
    if (clusters->n_unused > 0) return clusters->unused[--clusters->n_unused];
    int capacity = clusters->capacity;
    GROW_ARRAY(clusters->size, clusters->n_id, capacity);
    GROW_ARRAY(clusters->heap, clusters->n_id, clusters->capacity);
    clusters->size[clusters->n_id] = 0;
    clusters->heap[clusters->n_id] = (struct rank_heap){0};
    return clusters->n_id++;
}

static void end_cluster(struct clusters *clusters, int cluster)
{
    clusters->heap[cluster].n = 0;
    GROW_ARRAY(clusters->unused, clusters->n_unused, clusters->unused_capacity);
    clusters->unused[clusters->n_unused++] = cluster;
    clusters->count--;
}

static void add_meniscus(struct clusters *clusters, int throat)
{
    if (clusters->meniscus[throat]) return;
    clusters->meniscus[throat] = true;
    heap_push(&clusters->heap[clusters->of_throat[throat]], clusters->rank[throat]);
}

// --- searches ----------------------------------------------------------------------

// Searches are few, as many as throats at two nodes: no path is shortened.
static int root_of(const struct clusters *clusters, int search)
{
    while (clusters->search[search].joined != search)
        search = clusters->search[search].joined;
    return search;
}

static void find(struct clusters *clusters, int search, int throat)
{
    struct search *finder = &clusters->search[search];
    clusters->found_by[throat] = search;
    GROW_ARRAY(finder->throat, finder->n, finder->capacity);
    finder->throat[finder->n++] = throat;
}

static void start_search(struct clusters *clusters, int throat)
{
    const int old_capacity = clusters->search_capacity;
    GROW_ARRAY(clusters->search, clusters->n_search, clusters->search_capacity);
    for (int s = old_capacity; s < clusters->search_capacity; s++)
        clusters->search[s] = (struct search){0};

    const int search = clusters->n_search++;
    struct search *new = &clusters->search[search];
    new->n = new->next = 0;
    new->joined = search;
    new->active = 1;
    find(clusters, search, throat);
}

// Returns 1 if A and B were apart, 0 if they were one already.
static int unite(struct clusters *clusters, int a, int b)
{
    a = root_of(clusters, a);
    b = root_of(clusters, b);
    if (a == b) return 0;
    const int root = a < b ? a : b, other = a < b ? b : a;
    clusters->search[other].joined = root;
    clusters->search[root].active += clusters->search[other].active;
    return 1;
}

// Expands one more throat. Returns how many searches were united with this one.
static int advance_search(struct clusters *clusters, int search)
{
    const int throat = clusters->search[search].throat[clusters->search[search].next++];
    int united = 0;
    for (int end = 0; end < 2; end++) {
        const int node = clusters->network->throat_nodes[throat][end];
        if (!clusters->joins[node]) continue;
        for (int k = clusters->incidence->offset[node];
             k < clusters->incidence->offset[node + 1]; k++) {
            const int next = clusters->incidence->throat[k];
            if (clusters->of_throat[next] < 0) continue;
            if (clusters->found_by[next] < 0)
                find(clusters, search, next);
            else
                united += unite(clusters, search, clusters->found_by[next]);
        }
    }
    return united;
}

// Makes a cluster of the throats that the searches united in ROOT have found.
static void found_cluster(struct clusters *clusters, int root, int old)
{
    const int cluster = new_cluster(clusters);
    clusters->size[cluster] = 0;
    for (int s = 0; s < clusters->n_search; s++) {
        if (root_of(clusters, s) != root) continue;
        const struct search *search = &clusters->search[s];
        for (int k = 0; k < search->n; k++) {
            const int throat = search->throat[k];
            clusters->of_throat[throat] = cluster;
            GROW_ARRAY(clusters->moved, clusters->n_moved, clusters->moved_capacity);
            clusters->moved[clusters->n_moved++] = throat;
            if (clusters->meniscus[throat])
                heap_push(&clusters->heap[cluster], clusters->rank[throat]);
        }
        clusters->size[cluster] += search->n;
        clusters->size[old] -= search->n;
    }
}

// Advances the searches in turn until at most one part is unfinished; it stays OLD.
// UNFINISHED counts roots that still have a search to advance: it falls when two unite
// and when all of a root have run dry.
static void split(struct clusters *clusters, int old)
{
    int unfinished = clusters->n_search;
    for (int s = 0; unfinished > 1; s = (s + 1) % clusters->n_search) {
        const struct search *search = &clusters->search[s];
        if (search->next == search->n) continue;
        unfinished -= advance_search(clusters, s);
        search = &clusters->search[s];
        if (search->next < search->n) continue;
        const int root = root_of(clusters, s);
        if (--clusters->search[root].active == 0 && unfinished > 1) {
            found_cluster(clusters, root, old);
            unfinished--;
        }
    }
    for (int s = 0; s < clusters->n_search; s++)
        for (int k = 0; k < clusters->search[s].n; k++)
            clusters->found_by[clusters->search[s].throat[k]] = -1;
    clusters->n_search = 0;
}

// A search from each throat at NODE; from only one where the node still joins them.
static void start_searches(struct clusters *clusters, int node)
{
    for (int k = clusters->incidence->offset[node];
         k < clusters->incidence->offset[node + 1]; k++) {
        const int throat = clusters->incidence->throat[k];
        if (clusters->of_throat[throat] < 0) continue;
        if (clusters->found_by[throat] < 0) start_search(clusters, throat);
        if (clusters->joins[node]) return;
    }
}

// --- what others call --------------------------------------------------------------

void clusters_empty_throat(struct clusters *clusters, int throat)
{
    const int32_t *node = clusters->network->throat_nodes[throat];
    const int old = clusters->of_throat[throat];
    clusters->of_throat[throat] = -1;
    clusters->n_moved = 0;
    if (--clusters->size[old] == 0) {
        end_cluster(clusters, old);
        return;
    }
    // At a node that had gas before, liquid was parted then.
    bool search_here[2];
    for (int end = 0; end < 2; end++) {
        search_here[end] = clusters->joins[node[end]] && !clusters->never_part;
        clusters->joins[node[end]] &= !clusters->gas_parts;
    }
    for (int end = 0; end < 2; end++)
        if (search_here[end]) start_searches(clusters, node[end]);
    split(clusters, old);
    for (int end = 0; end < 2; end++)
        clusters_add_menisci(clusters, node[end]);
}

void clusters_add_menisci(struct clusters *clusters, int node)
{
    for (int k = clusters->incidence->offset[node];
         k < clusters->incidence->offset[node + 1]; k++)
        if (clusters->of_throat[clusters->incidence->throat[k]] >= 0)
            add_meniscus(clusters, clusters->incidence->throat[k]);
}

// Throats that have left the cluster are dropped here, when they come to the top.
int clusters_invasion_throat(struct clusters *clusters, int cluster)
{
    struct rank_heap *heap = &clusters->heap[cluster];
    while (heap->n > 0) {
        const int throat = clusters->throat_at_rank[heap->rank[0]];
        if (clusters->of_throat[throat] == cluster) return throat;
        heap_pop(heap);
    }
    return -1;
}

static void rank_throats(struct clusters *clusters, const double *entry_priority)
{
    const int n = clusters->network->n_throat;
    order_throats(clusters->network, entry_priority, clusters->throat_at_rank);
    for (int k = 0; k < n; k++)
        clusters->rank[clusters->throat_at_rank[k]] = k;
}

// The clusters of the full network, each by one complete search.
static void find_clusters(struct clusters *clusters)
{
    const int none = -1, unassigned = 0;
    for (int t = 0; t < clusters->network->n_throat; t++) {
        clusters->found_by[t] = none;
        clusters->of_throat[t] =
            clusters->network->throat_kind[t] == THROAT_NETWORK ? unassigned : none;
    }
    bool *seen = NEW_ARRAY(bool, clusters->network->n_throat);
    for (int t = 0; t < clusters->network->n_throat; t++) {
        if (clusters->of_throat[t] == none || seen[t]) continue;
        start_search(clusters, t);
        while (clusters->search[0].next < clusters->search[0].n)
            advance_search(clusters, 0);
        const int cluster = new_cluster(clusters);
        clusters->size[cluster] = clusters->search[0].n;
        for (int k = 0; k < clusters->search[0].n; k++) {
            clusters->of_throat[clusters->search[0].throat[k]] = cluster;
            seen[clusters->search[0].throat[k]] = true;
        }
        clusters->n_search = 0;
    }
    for (int t = 0; t < clusters->network->n_throat; t++)
        clusters->found_by[t] = none;
    free(seen);
}

struct clusters clusters_init(const struct network *network,
                              const struct incidence *incidence,
                              const double *entry_priority, bool gas_parts)
{
    struct clusters clusters = {.network = network,
                                .incidence = incidence,
                                .gas_parts = gas_parts,
                                .joins = NEW_ARRAY(bool, network->n_node),
                                .of_throat = NEW_ARRAY(int, network->n_throat),
                                .meniscus = NEW_ARRAY(bool, network->n_throat),
                                .rank = NEW_ARRAY(int, network->n_throat),
                                .throat_at_rank = NEW_ARRAY(int, network->n_throat),
                                .found_by = NEW_ARRAY(int, network->n_throat)};
    for (int i = 0; i < network->n_node; i++)
        clusters.joins[i] = true;
    rank_throats(&clusters, entry_priority);
    find_clusters(&clusters);
    return clusters;
}

void clusters_free(struct clusters *clusters)
{
    for (int c = 0; c < clusters->n_id; c++)
        free(clusters->heap[c].rank);
    for (int s = 0; s < clusters->search_capacity; s++)
        free(clusters->search[s].throat);
    free(clusters->joins);
    free(clusters->of_throat);
    free(clusters->meniscus);
    free(clusters->size);
    free(clusters->heap);
    free(clusters->unused);
    free(clusters->rank);
    free(clusters->throat_at_rank);
    free(clusters->moved);
    free(clusters->found_by);
    free(clusters->search);
    *clusters = (struct clusters){0};
}

// --- state -------------------------------------------------------------------------

static void heap_state(struct rank_heap *heap, int n_throat,
                       struct checkpoint_stream *stream)
{
    int64_t n = heap->n;
    stream_count(stream, &n);
    heap->rank = stream_room(stream, heap->rank, n, sizeof *heap->rank);
    if (stream->restoring) heap->n = heap->capacity = (int)n;
    stream_integers(stream, heap->rank, heap->n, 0, n_throat - 1);
}

// Heaps are kept as they are, the outdated entries too, which run_fits lets pass.
static void identities_state(struct clusters *clusters,
                             struct checkpoint_stream *stream)
{
    int64_t n = clusters->n_id;
    if (stream->restoring)
        for (int c = 0; c < clusters->n_id; c++)
            free(clusters->heap[c].rank);
    stream_count(stream, &n);
    clusters->size = stream_room(stream, clusters->size, n, sizeof *clusters->size);
    clusters->heap = stream_room(stream, clusters->heap, n, sizeof *clusters->heap);
    if (stream->restoring) {
        memset(clusters->heap, 0, (size_t)n * sizeof *clusters->heap);
        clusters->n_id = clusters->capacity = (int)n;
    }
    const int n_throat = clusters->network->n_throat;
    stream_integers(stream, clusters->size, n, 0, n_throat);
    for (int c = 0; c < clusters->n_id; c++)
        heap_state(&clusters->heap[c], n_throat, stream);
    n = clusters->n_unused;
    stream_count(stream, &n);
    clusters->unused = stream_room(stream, clusters->unused, n, sizeof(int));
    if (stream->restoring) clusters->n_unused = clusters->unused_capacity = (int)n;
    stream_integers(stream, clusters->unused, n, 0, clusters->n_id - 1);
}

// Identities before throats: their number bounds what throats may refer to.
void clusters_state(struct clusters *clusters, struct checkpoint_stream *stream)
{
    const struct network *network = clusters->network;
    identities_state(clusters, stream);
    stream_integer(stream, &clusters->count, 0, clusters->n_id);
    stream_flags(stream, clusters->joins, network->n_node);
    stream_integers(stream, clusters->of_throat, network->n_throat, -1,
                    clusters->n_id - 1);
    stream_flags(stream, clusters->meniscus, network->n_throat);
}
