// SPDX-License-Identifier: GPL-3.0-or-later
#include "liquid.h"

#include "basics/compensated.h"
#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "basics/ranks.h"

#include <stdlib.h>

struct scene {
    const struct network *network;
    const struct held_liquid *held;
    struct incidence incidence;
    double *capacity; // (n_throat) m3; 0 where no throat takes part
    double *liquid;   // (n_throat) m3, now
    bool *gas;        // (n_node) a throat there is empty
    int *widest;      // (n_throat) throats in the order of their widths
    int *rank;        // (n_throat) where each is in it
    int *piece;       // (n_throat) first throat of its liquid; -1 without
    struct rank_queue queue;
};

static struct scene make_scene(const struct network *network,
                               const struct held_liquid *held)
{
    const int n = network->n_throat;
    struct scene scene = {.network = network,
                          .held = held,
                          .incidence = network_incidence(network),
                          .capacity = NEW_ARRAY(double, n),
                          .liquid = NEW_ARRAY(double, n),
                          .gas = NEW_ARRAY(bool, network->n_node),
                          .widest = NEW_ARRAY(int, n),
                          .rank = NEW_ARRAY(int, n),
                          .piece = NEW_ARRAY(int, n),
                          .queue = rank_queue_make(n)};
    rank_descending(network->throat_radius, n, scene.widest, NULL);
    for (int k = 0; k < n; k++)
        scene.rank[scene.widest[k]] = k;
    for (int t = 0; t < n; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        scene.capacity[t] = throat_volume(network, t);
        scene.liquid[t] = held->saturation[t] * scene.capacity[t];
        for (int end = 0; end < 2 && held->saturation[t] == 0; end++)
            scene.gas[network->throat_nodes[t][end]] = true;
    }
    return scene;
}

static void free_scene(struct scene *scene)
{
    incidence_free(&scene->incidence);
    rank_queue_free(&scene->queue);
    free(scene->capacity);
    free(scene->liquid);
    free(scene->gas);
    free(scene->widest);
    free(scene->rank);
    free(scene->piece);
}

static bool is_wet(const struct scene *scene, int throat)
{
    return scene->network->throat_kind[throat] == THROAT_NETWORK &&
           scene->held->saturation[throat] > 0;
}

// Throats with liquid hang together through nodes that no gas has entered. The first
// throat of each piece stands for it.
static void find_pieces(struct scene *scene)
{
    const struct incidence *incidence = &scene->incidence;
    for (int t = 0; t < scene->network->n_throat; t++)
        scene->piece[t] = t;
    for (int i = 0; i < scene->network->n_node; i++) {
        int first = -1;
        for (int k = incidence->offset[i]; k < incidence->offset[i + 1]; k++) {
            const int t = incidence->throat[k];
            if (scene->gas[i] || !is_wet(scene, t)) continue;
            if (first < 0) first = t;
            unite_sets(scene->piece, first, t);
        }
    }
    for (int t = scene->network->n_throat - 1; t >= 0; t--)
        scene->piece[t] = is_wet(scene, t) ? set_root(scene->piece, t) : -1;
}

// ---- too much -----------------------------------------------------------------------

// The queue takes the lowest first: the narrowest throats have the highest ranks.
static int from_narrowest(const struct scene *scene, int throat)
{
    return scene->network->n_throat - 1 - scene->rank[throat];
}

static void offer_room(struct scene *scene, int throat)
{
    for (int end = 0; end < 2; end++) {
        const int node = scene->network->throat_nodes[throat][end];
        for (int k = scene->incidence.offset[node];
             k < scene->incidence.offset[node + 1]; k++) {
            const int t = scene->incidence.throat[k];
            if (scene->liquid[t] < scene->capacity[t])
                rank_queue_add(&scene->queue, from_narrowest(scene, t));
        }
    }
}

// Takes a piece's SURPLUS into the throats that the queue offers; what is left stays.
static void pour(struct scene *scene, struct compensated *surplus)
{
    for (int rank; (rank = rank_queue_take(&scene->queue)) >= 0;) {
        const int t = scene->widest[scene->network->n_throat - 1 - rank];
        const double left = compensated_value(*surplus);
        if (!(left > 0)) continue; // empties the queue
        const double room = scene->capacity[t] - scene->liquid[t];
        const double poured = fmin(left, room);
        scene->liquid[t] = left < room ? scene->liquid[t] + left : scene->capacity[t];
        compensated_add(surplus, -poured);
        if (left > room) offer_room(scene, t);
    }
}

// ---- too little ---------------------------------------------------------------------

static bool has_meniscus(const struct scene *scene, int throat)
{
    const int32_t *end = scene->network->throat_nodes[throat];
    const uint8_t *walls = scene->network->node_walls;
    return scene->gas[end[0]] || scene->gas[end[1]] ||
           ((walls[end[0]] | walls[end[1]]) & scene->held->open_walls);
}

static void offer_liquid(struct scene *scene, int node, int piece)
{
    for (int k = scene->incidence.offset[node]; k < scene->incidence.offset[node + 1];
         k++)
        if (scene->piece[scene->incidence.throat[k]] == piece &&
            scene->liquid[scene->incidence.throat[k]] > 0)
            rank_queue_add(&scene->queue, scene->rank[scene->incidence.throat[k]]);
}

static void drain(struct scene *scene, int piece, struct compensated *shortage)
{
    for (int rank; (rank = rank_queue_take(&scene->queue)) >= 0;) {
        const int t = scene->widest[rank];
        const double left = compensated_value(*shortage);
        if (!(left > 0)) continue;
        const double drained = fmin(left, scene->liquid[t]);
        scene->liquid[t] = left < scene->liquid[t] ? scene->liquid[t] - left : 0;
        compensated_add(shortage, -drained);
        for (int end = 0; end < 2 && scene->liquid[t] == 0; end++) {
            const int node = scene->network->throat_nodes[t][end];
            scene->gas[node] = true;
            offer_liquid(scene, node, piece);
        }
    }
}

// -------------------------------------------------------------------------------------

// Throats by pieces: those of PIECE are list[offset[piece]] ..
struct members {
    int *offset, *list;
};

static struct members list_members(const struct scene *scene)
{
    const int n = scene->network->n_throat;
    struct members members = {NEW_ARRAY(int, n + 2), NEW_ARRAY(int, n)};
    for (int t = 0; t < n; t++)
        if (scene->piece[t] >= 0) members.offset[scene->piece[t] + 2]++;
    for (int t = 0; t <= n; t++)
        members.offset[t + 1] += members.offset[t];
    for (int t = 0; t < n; t++)
        if (scene->piece[t] >= 0)
            members.list[members.offset[scene->piece[t] + 1]++] = t;
    return members;
}

// Gives back what finds no room.
static double settle_piece(struct scene *scene, int piece, const int *member, int count)
{
    struct compensated surplus = {0};
    for (int k = 0; k < count; k++) {
        const int t = member[k];
        compensated_add(&surplus, scene->held->liquid[t] -
                                      scene->held->saturation[t] * scene->capacity[t]);
    }
    if (compensated_value(surplus) > 0) {
        for (int k = 0; k < count; k++)
            offer_room(scene, member[k]);
        pour(scene, &surplus);
        return fmax(0, compensated_value(surplus));
    }
    struct compensated shortage = {-surplus.value, -surplus.lost};
    bool meets_gas = false;
    for (int k = 0; k < count; k++)
        meets_gas |= has_meniscus(scene, member[k]);
    for (int k = 0; k < count; k++)
        if (!meets_gas || has_meniscus(scene, member[k]))
            rank_queue_add(&scene->queue, scene->rank[member[k]]);
    drain(scene, piece, &shortage);
    return 0;
}

double settle_liquid(const struct network *network, const struct held_liquid *held,
                     double *saturation)
{
    struct scene scene = make_scene(network, held);
    find_pieces(&scene);
    const struct members members = list_members(&scene);
    struct compensated expelled = {0};
    for (int p = 0; p < network->n_throat; p++) {
        const int begin = members.offset[p], count = members.offset[p + 1] - begin;
        if (count)
            compensated_add(&expelled,
                            settle_piece(&scene, p, members.list + begin, count));
    }
    for (int t = 0; t < network->n_throat; t++) {
        const bool kept = scene.liquid[t] == held->saturation[t] * scene.capacity[t];
        saturation[t] = !(scene.capacity[t] > 0) ? 0
                        : kept                   ? held->saturation[t]
                                                 : scene.liquid[t] / scene.capacity[t];
    }
    free(members.offset);
    free(members.list);
    free_scene(&scene);
    return compensated_value(expelled);
}
