// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation (Wilkinson and Willemsen 1983). A queue by rank holds what gas
// touches; each step enters the first, and adds what lies beyond it (`enter`). Trapping
// is found backwards (Masson 2016): gas is taken back from the last event to the first,
// liquid regions grow together in disjoint sets with the outlet as set 0, and what was
// not connected to it just before its event had been trapped.
#include "network/invasion.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "basics/ranks.h"
#include "network/entry_order.h"

#include <stdlib.h>

// What a node sees of a throat. All of a node's lie together: in large networks each
// look elsewhere costs a hundred operations.
struct link {
    int32_t rank;  // of the throat
    int32_t other; // the node beyond it
};

struct front {
    const struct network *network;
    const struct invasion_conditions *conditions;
    int *offset; // (n_node+1) into link
    struct link *link;
    int *order;     // throat, or node, of each rank
    int *rank;      // the reverse
    int32_t *ahead; // (n_throat), by rank: node beyond the throat, seen from gas
    bool *gas;      // (n_node); where it enters nodes: those it touches as well
    struct rank_queue queue;
};

// --- what it touches ---------------------------------------------------------------

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

static void link_nodes(struct front *front)
{
    const struct network *network = front->network;
    const int n_node = network->n_node, n_throat = network->n_throat;
    front->offset = NEW_ARRAY(int, n_node + 2);
    front->link = allocate_aligned(2 * (size_t)n_throat, sizeof *front->link);
    int *end = front->offset + 1; // of what is there already
    for (int t = 0; t < n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            for (int side = 0; side < 2; side++)
                end[network->throat_nodes[t][side] + 1]++;
    for (int i = 0; i < n_node; i++)
        end[i + 1] += end[i];
    for (int t = 0; t < n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const int32_t *node = network->throat_nodes[t];
        const int rank = front->conditions->rule == INVADE_THROATS ? front->rank[t] : t;
        for (int side = 0; side < 2; side++)
            front->link[end[node[side]]++] = (struct link){rank, node[1 - side]};
    }
}

static void touch_throats(struct front *front, int node, int from)
{
    for (int k = front->offset[node]; k < front->offset[node + 1]; k++) {
        const struct link link = front->link[k];
        if (link.rank == from) continue;
        front->ahead[link.rank] = link.other;
        rank_queue_add(&front->queue, link.rank);
    }
}

static void touch_node(struct front *front, int node)
{
    if (front->gas[node] || front->offset[node] == front->offset[node + 1]) return;
    front->gas[node] = true;
    rank_queue_add(&front->queue, front->rank[node]);
}

static struct front front_init(const struct network *network,
                               const struct invasion_conditions *conditions)
{
    const bool throats = conditions->rule == INVADE_THROATS;
    const int n = throats ? network->n_throat : network->n_node;
    struct front front = {.network = network,
                          .conditions = conditions,
                          .order = NEW_ARRAY(int, n),
                          .rank = NEW_ARRAY(int, n),
                          .ahead = NEW_ARRAY(int32_t, throats ? n : 0),
                          .gas = NEW_ARRAY(bool, network->n_node),
                          .queue = rank_queue_init(n)};
    if (throats)
        order_throats(network, conditions->entry_priority, front.order);
    else
        order_nodes(network, conditions->entry_priority, front.order);
    for (int k = 0; k < n; k++)
        front.rank[front.order[k]] = k;
    link_nodes(&front);
    return front;
}

static void front_free(struct front *front)
{
    free(front->offset);
    free(front->link);
    free(front->order);
    free(front->rank);
    free(front->ahead);
    free(front->gas);
    rank_queue_free(&front->queue);
}

// --- forwards ----------------------------------------------------------------------

static void begin(struct front *front, struct invasion *invasion)
{
    const struct invasion_conditions *conditions = front->conditions;
    for (int i = 0; i < front->network->n_node; i++) {
        const unsigned walls = front->network->node_walls[i];
        if (!(walls & conditions->inlet)) continue;
        if (conditions->rule == INVADE_NODES) {
            touch_node(front, i);
        } else {
            front->gas[i] = true;
            touch_throats(front, i, -1);
            if (walls & conditions->outlet) invasion->breakthrough = 0;
        }
    }
}

// Gas enters what has RANK; returns the node that it comes to, or -1.
static int enter(struct front *front, int rank)
{
    if (front->conditions->rule == INVADE_NODES) {
        const int node = front->order[rank];
        for (int k = front->offset[node]; k < front->offset[node + 1]; k++)
            touch_node(front, front->link[k].other);
        return node;
    }
    const int node = front->ahead[rank];
    if (front->gas[node]) return -1;
    front->gas[node] = true;
    touch_throats(front, node, rank);
    return node;
}

static void follow(struct front *front, struct invasion *invasion)
{
    const struct invasion_conditions *conditions = front->conditions;
    begin(front, invasion);
    while (!(conditions->until_breakthrough && invasion->breakthrough >= 0)) {
        const int rank = rank_queue_take(&front->queue);
        if (rank < 0) break;
        const int node = enter(front, rank);
        if (invasion->throat) invasion->throat[invasion->n] = front->order[rank];
        invasion->node[invasion->n++] = node;
        if (invasion->breakthrough < 0 && node >= 0 &&
            (front->network->node_walls[node] & conditions->outlet))
            invasion->breakthrough = invasion->n;
    }
}

// --- trapping, backwards -----------------------------------------------------------

// Liquid that returns to NODE joins that of its neighbours. PARENT: disjoint sets, 0
// the outlet, then the nodes; -1: gas. Throats between nodes with liquid are full.
static void restore(const struct front *front, int *parent, int node)
{
    const bool out = front->network->node_walls[node] & front->conditions->outlet;
    int root = parent[node + 1] = out ? 0 : node + 1;
    for (int k = front->offset[node]; k < front->offset[node + 1]; k++) {
        const int other = front->link[k].other + 1;
        if (parent[other] < 0) continue;
        const int root_of_other = set_root(parent, other);
        if (root_of_other == root) continue;
        parent[root < root_of_other ? root_of_other : root] =
            root < root_of_other ? root : root_of_other;
        root = root < root_of_other ? root : root_of_other;
    }
}

// -1 where gas is in the end, else restored.
static int *liquid_left(const struct front *front, const struct invasion *invasion)
{
    const int n_node = front->network->n_node;
    const unsigned inlet = front->conditions->inlet;
    const bool throats = front->conditions->rule == INVADE_THROATS;
    int *parent = NEW_ARRAY(int, n_node + 1);
    bool *dry = NEW_ARRAY(bool, n_node);
    for (int i = 0; i < n_node; i++) {
        dry[i] = throats && (front->network->node_walls[i] & inlet);
        parent[i + 1] = -1;
    }
    for (int k = 0; k < invasion->n; k++)
        if (invasion->node[k] >= 0) dry[invasion->node[k]] = true;
    for (int i = 0; i < n_node; i++)
        if (!dry[i]) restore(front, parent, i);
    free(dry);
    return parent;
}

// Takes what gas has entered back from the last to the first. A throat or node was
// trapped if no liquid led from it to the outlet just before gas came; one between two
// nodes with gas always was.
static void remove_trapped(const struct front *front, struct invasion *invasion)
{
    int *parent = liquid_left(front, invasion);
    bool *trapped = NEW_ARRAY(bool, invasion->n);
    for (int k = invasion->n - 1; k >= 0; k--) {
        const int node = invasion->node[k];
        if (node >= 0) restore(front, parent, node);
        trapped[k] = node < 0 || set_root(parent, node + 1) != 0;
    }
    int n = 0, breakthrough = -1;
    for (int k = 0; k < invasion->n; k++) {
        if (!trapped[k]) {
            if (invasion->throat) invasion->throat[n] = invasion->throat[k];
            invasion->node[n++] = invasion->node[k];
        }
        if (k + 1 == invasion->breakthrough) breakthrough = n;
    }
    invasion->n = n;
    if (invasion->breakthrough > 0) invasion->breakthrough = breakthrough;
    free(parent);
    free(trapped);
}

// --- the whole ---------------------------------------------------------------------

enum status invade(const struct network *network,
                   const struct invasion_conditions *conditions,
                   struct invasion *invasion, struct reason *reason)
{
    const bool throats = conditions->rule == INVADE_THROATS;
    *invasion = (struct invasion){.breakthrough = -1};
    if (!has_throat(network, conditions->inlet))
        return refuse(reason, STATUS_BAD_DATA, "no throat reaches the inlet");
    if (conditions->trapping && !has_throat(network, conditions->outlet))
        return refuse(reason, STATUS_BAD_DATA, "no throat reaches the outlet");
    struct front front = front_init(network, conditions);
    if (throats) invasion->throat = NEW_ARRAY(int32_t, network->n_throat);
    invasion->node = NEW_ARRAY(int32_t, throats ? network->n_throat : network->n_node);
    follow(&front, invasion);
    if (conditions->trapping) remove_trapped(&front, invasion);
    front_free(&front);
    return STATUS_OK;
}

void invasion_free(struct invasion *invasion)
{
    free(invasion->throat);
    free(invasion->node);
    *invasion = (struct invasion){0};
}
