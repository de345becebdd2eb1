// SPDX-License-Identifier: GPL-3.0-or-later
#include "profiles.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

struct scene {
    const struct network *network;
    unsigned open_walls;
    bool gas_parts;
    double *saturation; // (n_throat) now
    int *slice;         // (n_throat) -1: holds no liquid at any time
    double full[PROFILE_SLICES];
    int *parent; // (n_throat) of the clusters' forest
    int *size;   // (n_throat)
    int *first;  // (n_node) a liquid throat there, -1: none yet
    bool *gas;   // (n_node)
};

// 0 at an open wall, 1 at the one opposite. With several open, of the first.
static double depth_of(const struct scene *scene, int throat)
{
    const struct network *network = scene->network;
    const int wall = __builtin_ctz(scene->open_walls), axis = wall / 2;
    const double lower = component(network->packing.lower, axis);
    const double upper = component(network->packing.upper, axis);
    const int32_t *node = network->throat_nodes[throat];
    const double middle = (component(network->node_position[node[0]], axis) +
                           component(network->node_position[node[1]], axis)) /
                          2;
    const double height = (middle - lower) / (upper - lower);
    return wall % 2 ? 1 - height : height;
}

static int slice_of(const struct scene *scene, int throat)
{
    const int slice = (int)(depth_of(scene, throat) * PROFILE_SLICES);
    return slice < 0 ? 0 : slice < PROFILE_SLICES ? slice : PROFILE_SLICES - 1;
}

static struct scene make_scene(const struct network *network, unsigned open_walls,
                               bool gas_parts)
{
    struct scene scene = {.network = network,
                          .open_walls = open_walls,
                          .gas_parts = gas_parts,
                          .saturation = NEW_ARRAY(double, network->n_throat),
                          .slice = NEW_ARRAY(int, network->n_throat),
                          .parent = NEW_ARRAY(int, network->n_throat),
                          .size = NEW_ARRAY(int, network->n_throat),
                          .first = NEW_ARRAY(int, network->n_node),
                          .gas = NEW_ARRAY(bool, network->n_node)};
    for (int t = 0; t < network->n_throat; t++) {
        scene.slice[t] = -1;
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        scene.saturation[t] = 1;
        scene.slice[t] = slice_of(&scene, t);
        scene.full[scene.slice[t]] += throat_volume(network, t);
    }
    return scene;
}

static void free_scene(struct scene *scene)
{
    free(scene->saturation);
    free(scene->slice);
    free(scene->parent);
    free(scene->size);
    free(scene->first);
    free(scene->gas);
}

static void cut_profile(const struct scene *scene, double *slice, double *surface)
{
    const struct network *network = scene->network;
    double liquid = 0, full = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (scene->slice[t] < 0) continue;
        const double volume = throat_volume(network, t);
        const int32_t *node = network->throat_nodes[t];
        slice[scene->slice[t]] += scene->saturation[t] * volume;
        if ((network->node_walls[node[0]] | network->node_walls[node[1]]) &
            scene->open_walls) {
            liquid += scene->saturation[t] * volume;
            full += volume;
        }
    }
    for (int s = 0; s < PROFILE_SLICES; s++)
        slice[s] = scene->full[s] > 0 ? fmin(1, slice[s] / scene->full[s]) : 0;
    *surface = full > 0 ? fmin(1, liquid / full) : 0;
}

static void join(struct scene *scene, int throat, int node)
{
    if (scene->gas_parts && scene->gas[node]) return;
    if (scene->first[node] < 0) {
        scene->first[node] = throat;
        return;
    }
    const int a = set_root(scene->parent, throat);
    const int b = set_root(scene->parent, scene->first[node]);
    if (a == b) return;
    scene->parent[b] = a;
    scene->size[a] += scene->size[b];
}

// Liquid throats are connected through nodes that gas has not entered.
static void count_clusters(struct scene *scene, int32_t *count)
{
    const struct network *network = scene->network;
    for (int i = 0; i < network->n_node; i++) {
        scene->first[i] = -1;
        scene->gas[i] = false;
    }
    for (int t = 0; t < network->n_throat; t++) {
        scene->parent[t] = t;
        scene->size[t] = 1;
        for (int end = 0; end < 2; end++)
            scene->gas[network->throat_nodes[t][end]] |=
                scene->slice[t] >= 0 && scene->saturation[t] == 0;
    }
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && scene->saturation[t] > 0; end++)
            join(scene, t, network->throat_nodes[t][end]);
    for (int t = 0; t < network->n_throat; t++)
        if (scene->saturation[t] > 0 && scene->parent[t] == t)
            count[31 - __builtin_clz((unsigned)scene->size[t])]++;
}

static void apply_changes(struct scene *scene, const struct drying_history *history,
                          int step)
{
    for (int64_t c = history->change_offset[step]; c < history->change_offset[step + 1];
         c++)
        scene->saturation[history->change_throat[c]] = history->change_saturation[c];
}

static int go_on_to(struct scene *scene, const struct drying_history *history, int step,
                    double level)
{
    while (history->saturation[step] > level && step < history->n_step - 1)
        apply_changes(scene, history, ++step);
    return step;
}

struct profiles profiles_make(const struct network *network,
                              const struct drying_history *history, unsigned open_walls,
                              bool gas_parts, int n_level, const double *level,
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
    struct scene scene = make_scene(network, open_walls, gas_parts);
    int step = 0;
    apply_changes(&scene, history, step);
    for (int k = 0; k < n_level; k++) {
        step = go_on_to(&scene, history, step, level[k]);
        profiles.step[k] = step;
        cut_profile(&scene, profiles.slice + k * PROFILE_SLICES, &profiles.surface[k]);
        count_clusters(&scene, profiles.clusters + k * PROFILE_CLASSES);
        if (keep_throats)
            memcpy(profiles.throat_saturation + (size_t)k * n_throat, scene.saturation,
                   n_throat * sizeof(double));
    }
    free_scene(&scene);
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
