// SPDX-License-Identifier: GPL-3.0-or-later
// Replays the changes of a history once, stops at each level, and measures the liquid:
// saturation by slices over the depth, of the surface, and the sizes of clusters.
// Clusters are found with a disjoint-set forest: liquid throats at a node belong
// together unless gas has entered the node, or as enum liquid_paths says.
//
//     slice[s]  = sum of liquid / sum of V,   throats whose middles lie in slice s,
//     liquid    = S V;  with rings, of which a throat leaves `left`,
//                 left + S (V - left)      while it holds liquid,
//                 left (s_i + s_j) / 2     of the rings at its nodes, once gas has
//                 come,
//     surface   = the same over throats with a node on an open wall,
//     clusters[k] = components of 2^k to 2^(k+1) - 1 throats,
// with S the saturation of a throat and V its volume. For each level in turn: go_on_to
// replays changes to its step, then the three are measured, and all S copied if wanted.
//
// Nothing is interpolated within a step: a profile belongs to the step that is first at
// or below its level. Gas comes to a node only with a throat that has emptied there, so
// nodes of the open surface join until then, as in struct clusters.
#include "profiles.h"

#include "ring_history.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// The network at the step that the replay has come to, and room to measure it.
struct snapshot {
    const struct network *network;
    unsigned open_walls;
    enum liquid_paths paths;
    double *saturation;          // (n_throat) now
    int *slice;                  // (n_throat) -1: holds no liquid at any time
    double full[PROFILE_SLICES]; // m3 of throats in each slice
    int *parent;                 // (n_throat) of the clusters' forest
    int *size;                   // (n_throat)
    int *first;                  // (n_node) a liquid throat there, -1: none yet
    bool *gas;                   // (n_node)
    double *left;                // (n_throat) m3 that it leaves in rings; or NULL
    double *of_rings;            // (n_node) saturation of the rings there; or NULL
};

// 0 at the open wall, 1 at the one opposite; with several open, from the first.
static double depth_of(const struct snapshot *snapshot, int throat)
{
    const struct network *network = snapshot->network;
    const int wall = __builtin_ctz(snapshot->open_walls), axis = wall / 2;
    const double lower = component(network->packing.lower, axis);
    const double upper = component(network->packing.upper, axis);
    const int32_t *node = network->throat_nodes[throat];
    const double middle = (component(network->node_position[node[0]], axis) +
                           component(network->node_position[node[1]], axis)) /
                          2;
    const double height = (middle - lower) / (upper - lower);
    return wall % 2 ? 1 - height : height;
}

// Nodes outside of the box count in the outermost slices.
static int slice_of(const struct snapshot *snapshot, int throat)
{
    const int slice = (int)(depth_of(snapshot, throat) * PROFILE_SLICES);
    return slice < 0 ? 0 : slice < PROFILE_SLICES ? slice : PROFILE_SLICES - 1;
}

static void take_rings(struct snapshot *snapshot, const struct ring_history *rings)
{
    const struct network *network = snapshot->network;
    snapshot->left = NEW_ARRAY(double, network->n_throat);
    for (int64_t k = 0; k < rings->offset[rings->n]; k++)
        snapshot->left[rings->throat[k]] += rings->volume[k];
    snapshot->of_rings = NEW_ARRAY(double, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        snapshot->of_rings[i] = 1;
}

// Full to begin with; changes of step 0 take off what was missing at the start.
static struct snapshot snapshot_init(const struct network *network, unsigned open_walls,
                                     enum liquid_paths paths)
{
    struct snapshot snapshot = {.network = network,
                                .open_walls = open_walls,
                                .paths = paths,
                                .saturation = NEW_ARRAY(double, network->n_throat),
                                .slice = NEW_ARRAY(int, network->n_throat),
                                .parent = NEW_ARRAY(int, network->n_throat),
                                .size = NEW_ARRAY(int, network->n_throat),
                                .first = NEW_ARRAY(int, network->n_node),
                                .gas = NEW_ARRAY(bool, network->n_node)};
    for (int t = 0; t < network->n_throat; t++) {
        snapshot.slice[t] = -1;
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        snapshot.saturation[t] = 1;
        snapshot.slice[t] = slice_of(&snapshot, t);
        snapshot.full[snapshot.slice[t]] += throat_volume(network, t);
    }
    return snapshot;
}

static void snapshot_free(struct snapshot *snapshot)
{
    free(snapshot->saturation);
    free(snapshot->slice);
    free(snapshot->parent);
    free(snapshot->size);
    free(snapshot->first);
    free(snapshot->gas);
    free(snapshot->left);
    free(snapshot->of_rings);
}

// m3 in THROAT and in what it has left in rings.
static double liquid_of(const struct snapshot *snapshot, int throat)
{
    const double volume = throat_volume(snapshot->network, throat);
    const double saturation = snapshot->saturation[throat];
    if (!snapshot->left) return saturation * volume;
    const double left = snapshot->left[throat];
    if (saturation > 0) return left + saturation * (volume - left);
    const int32_t *node = snapshot->network->throat_nodes[throat];
    return left * (snapshot->of_rings[node[0]] + snapshot->of_rings[node[1]]) / 2;
}

// The surface is all throats with a node on an open wall. fmin: sums of parts may pass
// the whole by rounding.
static void cut_profile(const struct snapshot *snapshot, double *slice, double *surface)
{
    const struct network *network = snapshot->network;
    double liquid = 0, full = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (snapshot->slice[t] < 0) continue;
        const double held = liquid_of(snapshot, t);
        const int32_t *node = network->throat_nodes[t];
        slice[snapshot->slice[t]] += held;
        if ((network->node_walls[node[0]] | network->node_walls[node[1]]) &
            snapshot->open_walls) {
            liquid += held;
            full += throat_volume(network, t);
        }
    }
    for (int s = 0; s < PROFILE_SLICES; s++)
        slice[s] = snapshot->full[s] > 0 ? fmin(1, slice[s] / snapshot->full[s]) : 0;
    *surface = full > 0 ? fmin(1, liquid / full) : 0;
}

// Union-find without ranks: the root of the later throat wins; only sizes are wanted.
static void join(struct snapshot *snapshot, int throat, int node)
{
    if (snapshot->paths == PATHS_PARTED_BY_GAS && snapshot->gas[node]) return;
    if (snapshot->first[node] < 0) {
        snapshot->first[node] = throat;
        return;
    }
    const int a = set_root(snapshot->parent, throat);
    const int b = set_root(snapshot->parent, snapshot->first[node]);
    if (a == b) return;
    snapshot->parent[b] = a;
    snapshot->size[a] += snapshot->size[b];
}

// Whether THROAT may hold a cluster together.
static bool is_path(const struct snapshot *snapshot, int throat)
{
    return snapshot->paths == PATHS_FILMS ? snapshot->slice[throat] >= 0
                                          : snapshot->saturation[throat] > 0;
}

// Sizes count throats with liquid. Class k has the sizes from 2^k to 2^(k+1) - 1: the
// logarithm of a size by its highest bit.
static void count_clusters(struct snapshot *snapshot, int32_t *count)
{
    const struct network *network = snapshot->network;
    for (int i = 0; i < network->n_node; i++) {
        snapshot->first[i] = -1;
        snapshot->gas[i] = false;
    }
    for (int t = 0; t < network->n_throat; t++) {
        snapshot->parent[t] = t;
        snapshot->size[t] = snapshot->saturation[t] > 0;
        for (int end = 0; end < 2; end++)
            snapshot->gas[network->throat_nodes[t][end]] |=
                snapshot->slice[t] >= 0 && snapshot->saturation[t] == 0;
    }
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && is_path(snapshot, t); end++)
            join(snapshot, t, network->throat_nodes[t][end]);
    for (int t = 0; t < network->n_throat; t++)
        if (snapshot->parent[t] == t && snapshot->size[t] > 0)
            count[31 - __builtin_clz((unsigned)snapshot->size[t])]++;
}

static void apply_changes(struct snapshot *snapshot,
                          const struct drying_history *history, int step)
{
    for (int64_t c = history->change_offset[step]; c < history->change_offset[step + 1];
         c++)
        snapshot->saturation[history->change_throat[c]] = history->change_saturation[c];
    const struct ring_history *rings = history->rings;
    if (!rings) return;
    for (int64_t c = rings->change_offset[step]; c < rings->change_offset[step + 1];
         c++)
        snapshot->of_rings[rings->change_node[c]] = rings->change_saturation[c];
}

// The first step at or below LEVEL, or the last there is.
static int go_on_to(struct snapshot *snapshot, const struct drying_history *history,
                    int step, double level)
{
    while (!is_down_to(history->saturation[step], level) && step < history->n_step - 1)
        apply_changes(snapshot, history, ++step);
    return step;
}

// Levels must fall, since steps are replayed once.
struct profiles profiles_init(const struct network *network,
                              const struct drying_history *history, unsigned open_walls,
                              enum liquid_paths paths, int n_level, const double *level,
                              bool keep_throats)
{
    const size_t n = (size_t)n_level, n_throat = (size_t)network->n_throat;
    struct profiles profiles = {
        .n_level = n_level,
        .step = NEW_ARRAY(int, n),
        .depth = NEW_ARRAY(double, PROFILE_SLICES),
        .slice = NEW_ARRAY(double, n *PROFILE_SLICES),
        .surface = NEW_ARRAY(double, n),
        .clusters = NEW_ARRAY(int32_t, n * PROFILE_CLASSES),
        .throat_saturation = keep_throats ? NEW_ARRAY(double, n *n_throat) : NULL};
    for (int s = 0; s < PROFILE_SLICES; s++)
        profiles.depth[s] = (s + 0.5) / PROFILE_SLICES;
    struct snapshot snapshot = snapshot_init(network, open_walls, paths);
    if (history->rings) take_rings(&snapshot, history->rings);
    int step = 0;
    apply_changes(&snapshot, history, step);
    for (int k = 0; k < n_level; k++) {
        step = go_on_to(&snapshot, history, step, level[k]);
        profiles.step[k] = step;
        cut_profile(&snapshot, profiles.slice + (size_t)k * PROFILE_SLICES,
                    &profiles.surface[k]);
        count_clusters(&snapshot, profiles.clusters + (size_t)k * PROFILE_CLASSES);
        if (keep_throats)
            memcpy(profiles.throat_saturation + (size_t)k * n_throat,
                   snapshot.saturation, n_throat * sizeof(double));
    }
    snapshot_free(&snapshot);
    return profiles;
}

void profiles_free(struct profiles *profiles)
{
    free(profiles->step);
    free(profiles->depth);
    free(profiles->slice);
    free(profiles->surface);
    free(profiles->clusters);
    free(profiles->throat_saturation);
    *profiles = (struct profiles){0};
}
