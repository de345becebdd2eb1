// SPDX-License-Identifier: GPL-3.0-or-later
#include "invasion.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "ranks.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Throats go by their ranks, and what is asked of one lies together: in large networks
// each look elsewhere costs a hundred operations.
struct front {
    const struct network *network;
    struct incidence incidence;
    int *order;          // (n_throat) throat of each rank
    int32_t (*nodes)[2]; // (n_throat) of each rank
    int *rank;           // (2 n_throat) beside incidence.throat; -1: takes no part
    bool *gas;           // (n_node)
    struct rank_queue queue;
};

// FROM is the throat through which gas comes, -1: from outside. The others may be in
// the queue already; none has been taken from it, for that brings gas to both ends.
static void reach_node(struct front *front, int node, int from)
{
    if (front->gas[node]) return;
    front->gas[node] = true;
    for (int k = front->incidence.offset[node]; k < front->incidence.offset[node + 1];
         k++)
        if (front->rank[k] >= 0 && front->rank[k] != from)
            rank_queue_add(&front->queue, front->rank[k]);
}

// Whether a throat that takes part has a node on one of WALLS.
static bool has_throat(const struct network *network, unsigned walls)
{
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            for (int end = 0; end < 2; end++)
                if (network->node_walls[network->throat_nodes[t][end]] & walls)
                    return true;
    return false;
}

static struct front front_make(const struct network *network, unsigned inlet)
{
    const int n = network->n_throat;
    struct front front = {.network = network,
                          .incidence = network_incidence(network),
                          .order = NEW_ARRAY(int, n),
                          .nodes = allocate((size_t)n, sizeof *front.nodes),
                          .rank = NEW_ARRAY(int, 2 * (size_t)n),
                          .gas = NEW_ARRAY(bool, network->n_node),
                          .queue = rank_queue_make(n)};
    rank_descending(network->throat_radius, n, front.order);
    int *rank = NEW_ARRAY(int, n);
    for (int k = 0; k < n; k++) {
        const int throat = front.order[k];
        rank[throat] = network->throat_kind[throat] == THROAT_NETWORK ? k : -1;
        memcpy(front.nodes[k], network->throat_nodes[throat], sizeof *front.nodes);
    }
    for (int k = 0; k < 2 * n; k++)
        front.rank[k] = rank[front.incidence.throat[k]];
    free(rank);
    for (int i = 0; i < network->n_node; i++)
        if (network->node_walls[i] & inlet) reach_node(&front, i, -1);
    return front;
}

static void front_free(struct front *front)
{
    incidence_free(&front->incidence);
    free(front->order);
    free(front->nodes);
    free(front->rank);
    free(front->gas);
    rank_queue_free(&front->queue);
}

// --- trapping, backwards -----------------------------------------------------------

// Liquid that returns to NODE, number N_NODE below, joins that in its throats.
static void restore_node(const struct front *front, const bool *liquid, int *parent,
                         bool *has_liquid, int node)
{
    has_liquid[node] = true;
    for (int k = front->incidence.offset[node]; k < front->incidence.offset[node + 1];
         k++) {
        const int throat = front->incidence.throat[k];
        if (!liquid[throat]) continue;
        const int32_t *ends = front->network->throat_nodes[throat];
        const int other = ends[0] == node ? ends[1] : ends[0];
        if (has_liquid[other]) unite_sets(parent, node + 1, other + 1);
    }
}

// Gives the invaded throats back from the last to the first. A throat was trapped if no
// liquid led from either of its nodes to the outlet just before gas entered it.
static void remove_trapped(const struct front *front, unsigned inlet, unsigned outlet,
                           struct invasion *invasion)
{
    const struct network *network = front->network;
    const int n_node = network->n_node;
    int *parent = NEW_ARRAY(int, n_node + 1); // 0 is the outlet, then the nodes
    int *entered = NEW_ARRAY(int, n_node);    // at which throat gas came to the node
    bool *liquid = NEW_ARRAY(bool, network->n_throat);
    bool *has_liquid = NEW_ARRAY(bool, n_node);
    bool *trapped = NEW_ARRAY(bool, invasion->n);
    for (int i = 0; i <= n_node; i++)
        parent[i] = i;
    for (int i = 0; i < n_node; i++) {
        entered[i] = network->node_walls[i] & inlet ? -1 : invasion->n;
        if (network->node_walls[i] & outlet) unite_sets(parent, 0, i + 1);
    }
    for (int k = invasion->n - 1; k >= 0; k--)
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[invasion->throat[k]][end];
            if (entered[node] >= 0) entered[node] = k;
        }
    for (int k = invasion->n - 1; k >= 0; k--) {
        const int throat = invasion->throat[k];
        liquid[throat] = true;
        trapped[k] = true;
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[throat][end];
            if (entered[node] == k)
                restore_node(front, liquid, parent, has_liquid, node);
        }
        for (int end = 0; end < 2; end++) {
            const int node = network->throat_nodes[throat][end];
            if (has_liquid[node] && set_root(parent, node + 1) == 0) trapped[k] = false;
        }
    }
    int n = 0, breakthrough = -1;
    for (int k = 0; k < invasion->n; k++) {
        if (!trapped[k]) invasion->throat[n++] = invasion->throat[k];
        if (k + 1 == invasion->breakthrough) breakthrough = n;
    }
    invasion->n = n;
    invasion->breakthrough = breakthrough;
    free(parent);
    free(entered);
    free(liquid);
    free(has_liquid);
    free(trapped);
}

// --- the whole ---------------------------------------------------------------------

static void follow(struct front *front, unsigned outlet, struct invasion *invasion)
{
    const uint8_t *walls = front->network->node_walls;
    for (int rank; (rank = rank_queue_take(&front->queue)) >= 0;) {
        invasion->throat[invasion->n++] = rank;
        for (int end = 0; end < 2; end++) {
            const int node = front->nodes[rank][end];
            if (front->gas[node]) continue;
            reach_node(front, node, rank);
            if (invasion->breakthrough < 0 && (walls[node] & outlet))
                invasion->breakthrough = invasion->n;
        }
    }
    for (int k = 0; k < invasion->n; k++)
        invasion->throat[k] = front->order[invasion->throat[k]];
}

enum status invade(const struct network *network, unsigned inlet, unsigned outlet,
                   bool trapping, struct invasion *invasion, struct reason *reason)
{
    *invasion = (struct invasion){.breakthrough = -1};
    if (!has_throat(network, inlet))
        return refuse(reason, STATUS_BAD_DATA, "no throat reaches the inlet");
    if (trapping && !has_throat(network, outlet))
        return refuse(reason, STATUS_BAD_DATA, "no throat reaches the outlet");
    struct front front = front_make(network, inlet);
    invasion->throat = NEW_ARRAY(int32_t, network->n_throat);
    follow(&front, outlet, invasion);
    if (trapping) remove_trapped(&front, inlet, outlet, invasion);
    front_free(&front);
    return STATUS_OK;
}

void invasion_free(struct invasion *invasion)
{
    free(invasion->throat);
    *invasion = (struct invasion){0};
}
