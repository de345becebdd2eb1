// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid of throats whose volumes have changed, cluster by cluster. With the
// saturations kept, a cluster has
//     surplus = sum of (liquid - saturation capacity)
// too much. A surplus fills throats at the cluster's edge, the narrowest first, as
// their suction is largest, and goes on from each throat that it has filled; a
// shortage empties throats at menisci, the widest first, and gas enters the nodes of
// those that empty. A priority queue of ranks in the order of entry
// (network/entry_order.h) has the throats that can be filled or emptied next.
//
// What rounding alone changes stays where it is: else it would wet empty throats, and
// join clusters.
//
// Throats that have closed hold nothing, nor do those that these shut in, as in dry:
// their liquid is surplus of their cluster.
//
// Clusters compete for the room between them: that with the widest throat is the first.
// So nothing depends on how throats are numbered.
#include "liquid.h"

#include "basics/compensated.h"
#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "basics/ranks.h"
#include "network/enclosed.h"
#include "network/entry_order.h"

#include <math.h>
#include <stdlib.h>

struct liquid_state {
    const struct network *network;
    const struct held_liquid *held;
    struct incidence incidence;
    double *capacity; // (n_throat) m3; 0 where no throat takes part
    double *liquid;   // (n_throat) m3, now
    double rounding;  // m3 of a throat, on average: less has not changed
    bool *gas;        // (n_node) a throat there is empty
    int *widest;      // (n_throat) throats in the order of entry
    int *rank;        // (n_throat) where each is in it
    int *cluster;     // (n_throat) widest throat of its liquid; -1 without
    struct rank_queue queue;
};

// (n_throat) The kinds that throats will have in dry. The caller frees it.
static uint8_t *kinds_in_dry(struct network network, unsigned open_walls)
{
    network.throat_kind = duplicate(network.throat_kind, (size_t)network.n_throat,
                                    sizeof *network.throat_kind);
    if (shut_closed_throats(&network)) empty_throats_cut_off(&network, open_walls);
    return network.throat_kind;
}

static struct liquid_state liquid_state_init(const struct network *network,
                                             const struct held_liquid *held)
{
    const int n = network->n_throat;
    struct liquid_state state = {.network = network,
                                 .held = held,
                                 .incidence = network_incidence(network),
                                 .capacity = NEW_ARRAY(double, n),
                                 .liquid = NEW_ARRAY(double, n),
                                 .gas = NEW_ARRAY(bool, network->n_node),
                                 .widest = NEW_ARRAY(int, n),
                                 .rank = NEW_ARRAY(int, n),
                                 .cluster = NEW_ARRAY(int, n),
                                 .queue = rank_queue_init(n)};
    order_throats(network, NULL, state.widest);
    for (int k = 0; k < n; k++)
        state.rank[state.widest[k]] = k;
    uint8_t *kind = kinds_in_dry(*network, held->open_walls);
    for (int t = 0; t < n; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        if (kind[t] == THROAT_NETWORK) state.capacity[t] = throat_volume(network, t);
        state.liquid[t] = held->saturation[t] * state.capacity[t];
        for (int end = 0; end < 2 && held->saturation[t] == 0; end++)
            state.gas[network->throat_nodes[t][end]] = true;
    }
    free(kind);
    struct compensated sum = {0};
    for (int t = 0; t < n; t++)
        compensated_add(&sum, state.capacity[t]);
    state.rounding = n > 0 ? 1e-12 * compensated_value(sum) / n : 0;
    return state;
}

static void liquid_state_free(struct liquid_state *state)
{
    incidence_free(&state->incidence);
    rank_queue_free(&state->queue);
    free(state->capacity);
    free(state->liquid);
    free(state->gas);
    free(state->widest);
    free(state->rank);
    free(state->cluster);
}

static bool is_wet(const struct liquid_state *state, int throat)
{
    return state->network->throat_kind[throat] == THROAT_NETWORK &&
           state->held->saturation[throat] > 0;
}

// Clusters: throats with liquid are connected through nodes without gas. Each is named
// by its widest throat.
static void find_clusters(struct liquid_state *state)
{
    const struct incidence *incidence = &state->incidence;
    const int n = state->network->n_throat;
    int *set = NEW_ARRAY(int, n), *name = NEW_ARRAY(int, n);
    for (int t = 0; t < n; t++) {
        set[t] = t;
        name[t] = -1;
    }
    for (int i = 0; i < state->network->n_node; i++) {
        int first = -1;
        for (int k = incidence->offset[i]; k < incidence->offset[i + 1]; k++) {
            const int t = incidence->throat[k];
            if (state->gas[i] || !is_wet(state, t)) continue;
            if (first < 0) first = t;
            unite_sets(set, first, t);
        }
    }
    for (int k = 0; k < n; k++) {
        const int t = state->widest[k], root = set_root(set, t);
        if (name[root] < 0) name[root] = t;
        state->cluster[t] = is_wet(state, t) ? name[root] : -1;
    }
    free(set);
    free(name);
}

// ---- too much -----------------------------------------------------------------------

// The rank counted from the narrowest throat: the queue takes the lowest first.
static int from_narrowest(const struct liquid_state *state, int throat)
{
    return state->network->n_throat - 1 - state->rank[throat];
}

static void queue_capacity(struct liquid_state *state, int throat)
{
    for (int end = 0; end < 2; end++) {
        const int node = state->network->throat_nodes[throat][end];
        for (int k = state->incidence.offset[node];
             k < state->incidence.offset[node + 1]; k++) {
            const int t = state->incidence.throat[k];
            if (state->liquid[t] < state->capacity[t])
                rank_queue_add(&state->queue, from_narrowest(state, t));
        }
    }
}

// Fills the queued throats from SURPLUS, until it is used up or no throat is left.
static void pour(struct liquid_state *state, struct compensated *surplus)
{
    for (int rank; (rank = rank_queue_take(&state->queue)) >= 0;) {
        const int t = state->widest[state->network->n_throat - 1 - rank];
        const double left = compensated_value(*surplus);
        if (!(left > 0)) continue; // empties the queue
        const double room = state->capacity[t] - state->liquid[t];
        const double poured = fmin(left, room);
        state->liquid[t] = left < room ? state->liquid[t] + left : state->capacity[t];
        compensated_add(surplus, -poured);
        if (left > room) queue_capacity(state, t);
    }
}

// ---- too little ---------------------------------------------------------------------

static bool has_meniscus(const struct liquid_state *state, int throat)
{
    const int32_t *end = state->network->throat_nodes[throat];
    const uint8_t *walls = state->network->node_walls;
    return state->gas[end[0]] || state->gas[end[1]] ||
           ((walls[end[0]] | walls[end[1]]) & state->held->open_walls);
}

static void queue_liquid(struct liquid_state *state, int node, int cluster)
{
    for (int k = state->incidence.offset[node]; k < state->incidence.offset[node + 1];
         k++)
        if (state->cluster[state->incidence.throat[k]] == cluster &&
            state->liquid[state->incidence.throat[k]] > 0)
            rank_queue_add(&state->queue, state->rank[state->incidence.throat[k]]);
}

static void drain(struct liquid_state *state, int cluster, struct compensated *shortage)
{
    for (int rank; (rank = rank_queue_take(&state->queue)) >= 0;) {
        const int t = state->widest[rank];
        const double left = compensated_value(*shortage);
        if (!(left > 0)) continue;
        const double drained = fmin(left, state->liquid[t]);
        state->liquid[t] = left < state->liquid[t] ? state->liquid[t] - left : 0;
        compensated_add(shortage, -drained);
        for (int end = 0; end < 2 && state->liquid[t] == 0; end++) {
            const int node = state->network->throat_nodes[t][end];
            state->gas[node] = true;
            queue_liquid(state, node, cluster);
        }
    }
}

// -------------------------------------------------------------------------------------

// Throats by clusters: those of cluster c are list[offset[c]] ..
struct members {
    int *offset, *list;
};

static struct members list_members(const struct liquid_state *state)
{
    const int n = state->network->n_throat;
    struct members members = {NEW_ARRAY(int, n + 2), NEW_ARRAY(int, n)};
    for (int t = 0; t < n; t++)
        if (state->cluster[t] >= 0) members.offset[state->cluster[t] + 2]++;
    for (int t = 0; t <= n; t++)
        members.offset[t + 1] += members.offset[t];
    for (int t = 0; t < n; t++)
        if (state->cluster[t] >= 0)
            members.list[members.offset[state->cluster[t] + 1]++] = t;
    return members;
}

// Redistributes one cluster. Returns the surplus (m3) that finds no room.
static double redistribute_cluster(struct liquid_state *state, int cluster,
                                   const int *member, int count)
{
    struct compensated surplus = {0};
    for (int k = 0; k < count; k++) {
        const int t = member[k];
        compensated_add(&surplus, state->held->liquid[t] -
                                      state->held->saturation[t] * state->capacity[t]);
    }
    if (fabs(compensated_value(surplus)) <= count * state->rounding) return 0;
    if (compensated_value(surplus) > 0) {
        for (int k = 0; k < count; k++)
            queue_capacity(state, member[k]);
        pour(state, &surplus);
        return fmax(0, compensated_value(surplus));
    }
    struct compensated shortage = {-surplus.value, -surplus.lost};
    bool meets_gas = false;
    for (int k = 0; k < count; k++)
        meets_gas |= has_meniscus(state, member[k]);
    for (int k = 0; k < count; k++)
        if (!meets_gas || has_meniscus(state, member[k]))
            rank_queue_add(&state->queue, state->rank[member[k]]);
    drain(state, cluster, &shortage);
    return 0;
}

double redistribute_liquid(const struct network *network,
                           const struct held_liquid *held, double *saturation)
{
    struct liquid_state state = liquid_state_init(network, held);
    find_clusters(&state);
    const struct members members = list_members(&state);
    struct compensated expelled = {0};
    for (int k = 0; k < network->n_throat; k++) {
        const int p = state.widest[k];
        const int begin = members.offset[p], count = members.offset[p + 1] - begin;
        if (count)
            compensated_add(&expelled, redistribute_cluster(
                                           &state, p, members.list + begin, count));
    }
    for (int t = 0; t < network->n_throat; t++) {
        const bool kept = state.liquid[t] == held->saturation[t] * state.capacity[t];
        saturation[t] = !(state.capacity[t] > 0) ? 0
                        : kept                   ? held->saturation[t]
                                                 : state.liquid[t] / state.capacity[t];
    }
    free(members.offset);
    free(members.list);
    liquid_state_free(&state);
    return compensated_value(expelled);
}
