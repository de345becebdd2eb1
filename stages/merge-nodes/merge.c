// SPDX-License-Identifier: GPL-3.0-or-later
// Merging of short throats, the shortest first [K 3.3.7]. Two nodes at x_a and x_b,
// means of w_a and w_b of the original nodes, become one at
//     x = (w_a x_a + w_b x_b) / (w_a + w_b),   weight w_a + w_b,
// where only the node on more walls counts if they differ, and x is moved exactly onto
// all their walls. So merging is a greedy clustering whose order is that of a queue by
// length (merge_state.h): lengths change with the nodes, so a throat that was long may
// come up next. A throat from wall to opposite wall, or around a periodic box, is
// kept: its two nodes cannot be one point.
#include "merge.h"

#include "basics/memory.h"
#include "merge_state.h"

#include <math.h>

static double mean(const double *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += values[i];
    return count ? sum / count : 0;
}

// Number of throats, those of the boundary layer left out, and their mean length.
static int count_throats(const struct network *network, double *length)
{
    int n = 0;
    double sum = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] == THROAT_BOUNDARY_LAYER) continue;
        sum += network->throat_length[t];
        n++;
    }
    *length = n ? sum / n : 0;
    return n;
}

// Relative thresholds refer to the network before its first merging, so that merging it
// again changes nothing.
static void remember_unmerged(struct network *network)
{
    if (network->unmerged_throats) return;
    network->unmerged_throats = count_throats(network, &network->unmerged_length);
}

// The length below which throats are merged, and how many may be removed at most.
static void limits(const struct network *network, enum merge_measure measure,
                   double threshold, double *length, int *most)
{
    double now;
    const int gone = network->unmerged_throats - count_throats(network, &now);
    *most = network->n_throat;
    switch (measure) {
    case MERGE_GRAIN_RADIUS:
        *length =
            threshold * mean(network->packing.radius, network->packing.n_particle);
        break;
    case MERGE_MEAN_LENGTH:
        *length = threshold * network->unmerged_length;
        break;
    case MERGE_ABSOLUTE:
        *length = threshold;
        break;
    case MERGE_FRACTION:
        *length = HUGE_VAL;
        *most = (int)floor(threshold * network->unmerged_throats) - gone;
        break;
    }
}

static int count_walls(uint8_t walls)
{
    return __builtin_popcount(walls);
}

static bool spans_box(uint8_t walls)
{
    return (walls & 3) == 3 || (walls & 12) == 12 || (walls & 48) == 48 ||
           (walls & 192) == 192;
}

// Whether AT is on WALL. A node with the wall's bit may lie away from it (where cells
// were left out): it must not be moved there.
static bool is_on_wall(const struct network *network, int wall, struct vector at)
{
    const struct packing *packing = &network->packing;
    return distance(at, nearest_on_wall(packing, wall, at)) <=
           1e-9 * distance(packing->lower, packing->upper);
}

// Moves the node at ROOT into a periodic box, and notes the image it was in.
static void wrap(struct merging *merging, int root)
{
    const struct packing *packing = &merging->network->packing;
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double lower = component(packing->lower, axis);
        const double edge = component(packing->upper, axis) - lower;
        const double at = component(merging->position[root], axis);
        const double boxes = floor((at - lower) / edge);
        set_component(&merging->position[root], axis, at - boxes * edge);
        merging->image[root].along[axis] += (int8_t)boxes;
    }
}

// Moves the first node of ENDS to the place of their union; the second becomes part of
// it.
static void unite(struct merging *merging, struct merging_ends ends)
{
    const int root = ends.node[0], other = ends.node[1];
    const int difference =
        count_walls(merging->walls[root]) - count_walls(merging->walls[other]);
    const double a = difference < 0 ? 0 : merging->weight[root];
    const double b = difference > 0 ? 0 : merging->weight[other];
    const struct network *network = merging->network;
    const struct vector from = merging->position[root];
    const struct vector apart = merging_vector(merging, ends);
    merging->position[root] = add(from, scale(b / (a + b), apart));
    merging->weight[root] = a + b;
    merging->walls[root] |= merging->walls[other];
    merging->parent[other] = root;
    merging->image[other] = image_difference(
        image_difference(merging->image[other], ends.image), merging->image[root]);
    wrap(merging, root);
    for (int wall = 0; wall <= WALL_INNER; wall++)
        if (merging->walls[root] >> wall & 1 &&
            (is_on_wall(network, wall, from) ||
             is_on_wall(network, wall, merging->position[other])))
            merging->position[root] =
                nearest_on_wall(&network->packing, wall, merging->position[root]);
}

// Unites the two nodes of throat T. False when it must stay. If no throat is left to
// take its volume, that is added to LOST.
static bool merge_ends(struct merging *merging, int t, double *lost)
{
    struct merging_ends ends = merging_ends(merging, t);
    if (ends.node[0] == ends.node[1]) return false; // around a box that repeats
    if (spans_box(merging->walls[ends.node[0]] | merging->walls[ends.node[1]]))
        return false;
    if (merging->row[ends.node[0]].count < merging->row[ends.node[1]].count)
        ends = merging_reversed(ends); // the shorter list moves
    const int root = ends.node[0];
    const struct vector before = merging->position[root];
    unite(merging, ends);
    merging_remove(merging, t);
    merging_move_throats(merging, root, ends.node[1],
                         distance(before, merging->position[root]) > 0);
    const double *volume = merging->network->throat_volume;
    if (volume) *lost += merging_share_volume(merging, root, volume[t]);
    return true;
}

void merge_nodes(struct network *network, enum merge_measure measure, double threshold,
                 struct merge_report *report)
{
    double shortest_kept = 0;
    int most;
    remember_unmerged(network);
    limits(network, measure, threshold, &shortest_kept, &most);
    *report = (struct merge_report){.nodes_before = network->n_node,
                                    .throats_before = network->n_throat};
    struct merging merging = merging_begin(network);
    int throat;
    double length;
    while (merging.removed < most && merging_shortest(&merging, &throat, &length)) {
        if (!(length < shortest_kept)) break;
        if (merge_ends(&merging, throat, &report->lost_volume))
            report->merged++;
        else
            report->kept++;
    }
    report->fused = merging.removed - report->merged;
    merging_finish(&merging);
}
