// SPDX-License-Identifier: GPL-3.0-or-later
// From the order of invasion to results. An event empties its throat, or with node
// invasion all throats at the node that are still liquid; or, where pores hold the
// liquid, the halves of all throats at the node it comes to. Saturation is a difference
// of compensated sums, and exactly 0 once nothing is left. The capillary pressure curve
// is the running maximum of the entry pressures. Liquid that stays is clustered by a
// disjoint-set forest over nodes without gas; a cluster without a node at the outlet is
// trapped.
//
//     saturation_k = (sum of all volumes - sum of those emptied by event k) / all.
// Trap: throats that gas has passed at both ends without entering are clusters of their
// own, without a node; or, where pores hold the liquid, none.
#include "outcome.h"

#include "basics/compensated.h"
#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <assert.h>
#include <stdlib.h>

enum { GAS_FROM_THE_START = 0, LIQUID = -1 };

// --- events ------------------------------------------------------------------------

static int32_t earlier(int32_t a, int32_t b)
{
    if (a == LIQUID || b == LIQUID) return a == LIQUID ? b : a;
    return a < b ? a : b;
}

static void number_events(const struct network *network,
                          const struct invasion_conditions *conditions,
                          const struct invasion *invasion, struct outcome *outcome)
{
    const bool throats = conditions->rule == INVADE_THROATS;
    assert(invasion->throat || !throats);
    int32_t *node_event = outcome->node_event, *throat_event = outcome->throat_event;
    for (int i = 0; i < network->n_node; i++)
        node_event[i] = throats && (network->node_walls[i] & conditions->inlet)
                            ? GAS_FROM_THE_START
                            : LIQUID;
    for (int k = 0; k < invasion->n; k++)
        if (invasion->node[k] >= 0) node_event[invasion->node[k]] = k + 1;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        throat_event[t] = network->throat_kind[t] != THROAT_NETWORK ? GAS_FROM_THE_START
                          : throats                                 ? LIQUID
                                    : earlier(node_event[ends[0]], node_event[ends[1]]);
    }
    for (int k = 0; throats && k < invasion->n; k++)
        throat_event[invasion->throat[k]] = k + 1;
}

// --- saturation and pressure -------------------------------------------------------

int events_of_pieces(const struct network *network, const struct outcome *outcome,
                     int throat, int32_t event[2])
{
    const int32_t *ends = network->throat_nodes[throat];
    const bool by_pores = outcome->held_by == HELD_BY_PORES;
    // Throats that take no part never had liquid, though their nodes may have it.
    const bool by_nodes = by_pores && network->throat_kind[throat] == THROAT_NETWORK;
    for (int end = 0; end < 2; end++)
        event[end] =
            by_nodes ? outcome->node_event[ends[end]] : outcome->throat_event[throat];
    return by_pores ? 2 : 1;
}

static void find_saturations(const struct network *network, struct outcome *outcome)
{
    double *lost = NEW_ARRAY(double, outcome->n);
    int last = -1; // after which nothing is left; n: never
    struct compensated all = {0}, gone = {0};
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        int32_t event[2];
        const int pieces = events_of_pieces(network, outcome, t, event);
        const double volume = throat_volume(network, t) / pieces;
        for (int k = 0; k < pieces; k++) {
            compensated_add(&all, volume);
            const int emptied = event[k] == LIQUID ? outcome->n : event[k] - 1;
            if (emptied > last) last = emptied;
            if (event[k] > 0) lost[event[k] - 1] += volume;
            if (event[k] == GAS_FROM_THE_START) compensated_add(&gone, volume);
        }
    }
    const double total = outcome->volume = compensated_value(all);
    outcome->at_first = fmax(0, compensated_difference(all, gone) / total);
    for (int k = 0; k < outcome->n; k++) {
        compensated_add(&gone, lost[k]);
        outcome->saturation[k] =
            k < last ? fmax(0, compensated_difference(all, gone) / total) : 0;
    }
    free(lost);
}

double saturation_after(const struct outcome *outcome, int event)
{
    return event > 0 ? outcome->saturation[event - 1] : outcome->at_first;
}

static void find_curve(struct outcome *outcome)
{
    outcome->n_curve = 0;
    for (int k = 0; k < outcome->n; k++) {
        int *n = &outcome->n_curve;
        if (*n == 0 || outcome->pressure[k] > outcome->curve_pressure[*n - 1])
            outcome->curve_pressure[(*n)++] = outcome->pressure[k];
        outcome->curve_saturation[*n - 1] = outcome->saturation[k];
        if (outcome->ring_saturation)
            outcome->curve_rings[*n - 1] = outcome->ring_saturation[k];
    }
}

void outcome_add_rings(struct outcome *outcome, const double *volume)
{
    outcome->ring_saturation = NEW_ARRAY(double, outcome->n);
    outcome->curve_rings = NEW_ARRAY(double, outcome->n);
    for (int k = 0; k < outcome->n; k++) {
        outcome->ring_saturation[k] = volume[k] / outcome->volume;
        outcome->saturation[k] =
            fmin(1, outcome->saturation[k] + outcome->ring_saturation[k]);
    }
    find_curve(outcome);
}

// --- what stays --------------------------------------------------------------------

// A liquid end of THROAT, which is in its cluster; -1 if both ends have gas.
static int liquid_end(const struct network *network, const struct outcome *outcome,
                      int throat)
{
    for (int end = 0; end < 2; end++) {
        const int node = network->throat_nodes[throat][end];
        if (outcome->node_event[node] == LIQUID) return node;
    }
    return -1;
}

// Whether any piece of THROAT is liquid in the end.
static bool is_left(const struct network *network, const struct outcome *outcome,
                    int throat)
{
    int32_t event[2];
    const int pieces = events_of_pieces(network, outcome, throat, event);
    return event[0] == LIQUID || event[pieces - 1] == LIQUID;
}

static void add_to_cluster(const struct network *network, struct outcome *outcome,
                           int throat, int cluster)
{
    outcome->throat_cluster[throat] = cluster;
    outcome->cluster_throats[cluster]++;
    int32_t event[2];
    const int pieces = events_of_pieces(network, outcome, throat, event);
    for (int k = 0; k < pieces; k++)
        if (event[k] == LIQUID)
            outcome->cluster_volume[cluster] += throat_volume(network, throat) / pieces;
    outcome->cluster_trapped[cluster] = 1;
}

static void find_clusters(const struct network *network, unsigned outlet,
                          struct outcome *outcome)
{
    const int n_node = network->n_node;
    int *parent = NEW_ARRAY(int, n_node), *cluster = NEW_ARRAY(int, n_node);
    for (int i = 0; i < n_node; i++) {
        parent[i] = i;
        cluster[i] = -1;
    }
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        if (outcome->throat_event[t] == LIQUID &&
            outcome->node_event[ends[0]] == LIQUID &&
            outcome->node_event[ends[1]] == LIQUID)
            unite_sets(parent, ends[0], ends[1]);
    }
    for (int t = 0; t < network->n_throat; t++) {
        outcome->throat_cluster[t] = -1;
        if (!is_left(network, outcome, t)) continue;
        const int node = liquid_end(network, outcome, t);
        int alone = -1;
        int *number = node < 0 ? &alone : &cluster[set_root(parent, node)];
        if (*number < 0) *number = outcome->n_cluster++;
        add_to_cluster(network, outcome, t, *number);
    }
    for (int i = 0; i < n_node; i++) {
        const int number = cluster[set_root(parent, i)];
        if ((network->node_walls[i] & outlet) && number >= 0)
            outcome->cluster_trapped[number] = 0;
    }
    free(parent);
    free(cluster);
}

// --- the whole ---------------------------------------------------------------------

struct outcome outcome_init(const struct network *network,
                            const struct invasion_conditions *conditions,
                            const struct invasion *invasion, const double *pressure,
                            enum held_by held_by)
{
    const int n = invasion->n, n_throat = network->n_throat;
    struct outcome outcome = {.held_by = held_by,
                              .throat_event = NEW_ARRAY(int32_t, n_throat),
                              .node_event = NEW_ARRAY(int32_t, network->n_node),
                              .n = n,
                              .pressure = NEW_ARRAY(double, n),
                              .saturation = NEW_ARRAY(double, n),
                              .curve_pressure = NEW_ARRAY(double, n),
                              .curve_saturation = NEW_ARRAY(double, n),
                              .throat_cluster = NEW_ARRAY(int32_t, n_throat),
                              .cluster_throats = NEW_ARRAY(int32_t, n_throat),
                              .cluster_volume = NEW_ARRAY(double, n_throat),
                              .cluster_trapped = NEW_ARRAY(uint8_t, n_throat)};
    const int32_t *entered = invasion->throat ? invasion->throat : invasion->node;
    for (int k = 0; k < n; k++)
        outcome.pressure[k] = pressure[entered[k]];
    number_events(network, conditions, invasion, &outcome);
    find_saturations(network, &outcome);
    find_curve(&outcome);
    find_clusters(network, conditions->outlet, &outcome);
    return outcome;
}

void outcome_free(struct outcome *outcome)
{
    free(outcome->throat_event);
    free(outcome->node_event);
    free(outcome->pressure);
    free(outcome->saturation);
    free(outcome->curve_pressure);
    free(outcome->curve_saturation);
    free(outcome->ring_saturation);
    free(outcome->curve_rings);
    free(outcome->throat_cluster);
    free(outcome->cluster_throats);
    free(outcome->cluster_volume);
    free(outcome->cluster_trapped);
    *outcome = (struct outcome){0};
}
