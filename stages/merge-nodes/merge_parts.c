// SPDX-License-Identifier: GPL-3.0-or-later
#include "merge_parts.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// ---- the queue: a binary heap, shortest first, then lowest nodes --------------------

static bool comes_before(const struct queued *a, const struct queued *b)
{
    if (a->length != b->length) return a->length < b->length;
    for (int end = 0; end < 2; end++)
        if (a->nodes[end] != b->nodes[end]) return a->nodes[end] < b->nodes[end];
    return a->throat < b->throat;
}

static void push(struct merging *merging, int throat, double length)
{
    const int32_t *nodes = merging->network->throat_nodes[throat];
    const struct queued item = {
        length, {nodes[0], nodes[1]}, throat, merging->stamp[throat]};
    GROW_ARRAY(merging->queue, merging->n_queue, merging->queue_capacity);
    int at = merging->n_queue++;
    for (; at > 0 && comes_before(&item, &merging->queue[(at - 1) / 2]);
         at = (at - 1) / 2)
        merging->queue[at] = merging->queue[(at - 1) / 2];
    merging->queue[at] = item;
}

static struct queued pop(struct merging *merging)
{
    const struct queued top = merging->queue[0];
    const struct queued last = merging->queue[--merging->n_queue];
    int at = 0;
    for (int child; (child = 2 * at + 1) < merging->n_queue; at = child) {
        if (child + 1 < merging->n_queue &&
            comes_before(&merging->queue[child + 1], &merging->queue[child]))
            child++;
        if (!comes_before(&merging->queue[child], &last)) break;
        merging->queue[at] = merging->queue[child];
    }
    if (merging->n_queue) merging->queue[at] = last;
    return top;
}

bool merging_shortest(struct merging *merging, int *throat, double *length)
{
    while (merging->n_queue) {
        const struct queued next = pop(merging);
        if (merging->gone[next.throat] || next.stamp != merging->stamp[next.throat])
            continue;
        *throat = next.throat;
        *length = next.length;
        return true;
    }
    return false;
}

// ---- nodes and throats --------------------------------------------------------------

int merging_node(struct merging *merging, int node)
{
    int *parent = merging->parent;
    while (parent[node] != node)
        node = parent[node] = parent[parent[node]];
    return node;
}

static int other_end(struct merging *merging, int throat, int root)
{
    const int a = merging_node(merging, merging->network->throat_nodes[throat][0]);
    return a != root ? a
                     : merging_node(merging, merging->network->throat_nodes[throat][1]);
}

static void append(struct throat_row *row, int throat)
{
    GROW_ARRAY(row->throat, row->count, row->capacity);
    row->throat[row->count++] = throat;
}

void merging_remove(struct merging *merging, int throat)
{
    merging->gone[throat] = true;
    merging->removed++;
}

static void fuse(struct merging *merging, int kept, int removed)
{
    double *radius = merging->network->throat_radius;
    double *volume = merging->network->throat_volume;
    radius[kept] = fmax(radius[kept], radius[removed]);
    if (volume) volume[kept] += volume[removed];
    merging_remove(merging, removed);
}

double merging_share(struct merging *merging, int root, double volume)
{
    const struct throat_row *row = &merging->row[root];
    double *of = merging->network->throat_volume, sum = 0;
    for (int k = 0; k < row->count; k++)
        sum += of[row->throat[k]];
    for (int k = 0; k < row->count; k++) {
        double *share = &of[row->throat[k]];
        *share += sum > 0 ? volume * (*share / sum) : volume / row->count;
    }
    return row->count ? 0 : volume;
}

// A tessellation unites nodes on walls, and so may bring throats that are parallel.
static void fuse_parallel(struct merging *merging)
{
    for (int t = 0; t < merging->network->n_throat; t++) {
        const int32_t *ends = merging->network->throat_nodes[t];
        const struct throat_row *row = &merging->row[ends[0]];
        for (int k = 0; k < row->count && !merging->gone[t]; k++) {
            const int other = row->throat[k];
            if (other > t && !merging->gone[other] &&
                other_end(merging, other, ends[0]) == ends[1])
                fuse(merging, t, other);
        }
    }
}

// As merging_finish will write it: a length from elsewhere may differ in its last
// digit, and so fall on the other side of a threshold when merged again.
static double node_distance(const struct network *network, int throat)
{
    const int32_t *nodes = network->throat_nodes[throat];
    return distance(network->node_position[nodes[0]], network->node_position[nodes[1]]);
}

struct merging merging_begin(struct network *network)
{
    const size_t n_node = (size_t)network->n_node;
    struct merging merging = {
        .network = network,
        .parent = NEW_ARRAY(int, n_node),
        .position = duplicate(network->node_position, n_node, sizeof(struct vector)),
        .weight = NEW_ARRAY(double, n_node),
        .walls = duplicate(network->node_walls, n_node, 1),
        .row = NEW_ARRAY(struct throat_row, n_node),
        .gone = NEW_ARRAY(bool, network->n_throat),
        .stamp = NEW_ARRAY(int, network->n_throat)};
    for (int i = 0; i < network->n_node; i++) {
        merging.parent[i] = i;
        merging.weight[i] = 1;
    }
    for (int t = 0; t < network->n_throat; t++) {
        append(&merging.row[network->throat_nodes[t][0]], t);
        append(&merging.row[network->throat_nodes[t][1]], t);
        push(&merging, t, node_distance(network, t));
    }
    fuse_parallel(&merging);
    return merging;
}

static void measure_again(struct merging *merging, int root, int throat)
{
    const int other = other_end(merging, throat, root);
    const double length = distance(merging->position[root], merging->position[other]);
    merging->network->throat_length[throat] = length;
    merging->stamp[throat]++;
    push(merging, throat, length);
}

static void drop_gone(struct merging *merging, struct throat_row *row)
{
    int kept = 0;
    for (int k = 0; k < row->count; k++)
        if (!merging->gone[row->throat[k]]) row->throat[kept++] = row->throat[k];
    row->count = kept;
}

// The throat of ROW that ends at NODE as THROAT does, or -1. Nodes have a handful of
// throats, so looking through them costs less than any index.
static int parallel_to(struct merging *merging, const struct throat_row *row, int root,
                       int throat)
{
    const int end = other_end(merging, throat, root);
    for (int k = 0; k < row->count; k++)
        if (row->throat[k] != throat && other_end(merging, row->throat[k], root) == end)
            return row->throat[k];
    return -1;
}

void merging_move_throats(struct merging *merging, int root, int other, bool moved)
{
    struct throat_row *row = &merging->row[root], *from = &merging->row[other];
    drop_gone(merging, row);
    drop_gone(merging, from);
    const int before = row->count;
    for (int k = 0; k < from->count; k++) {
        const int throat = from->throat[k];
        if (other_end(merging, throat, root) == root) { // parallel to the merged one
            merging_remove(merging, throat);
            continue;
        }
        const int twin = parallel_to(merging, row, root, throat);
        if (twin >= 0) {
            fuse(merging, twin < throat ? twin : throat, twin < throat ? throat : twin);
            if (twin < throat) continue;
        }
        append(row, throat);
        measure_again(merging, root, throat);
    }
    drop_gone(merging, row);
    for (int k = 0; moved && k < row->count && k < before; k++)
        measure_again(merging, root, row->throat[k]);
    free(from->throat);
    *from = (struct throat_row){0};
}

// ---- writing back -------------------------------------------------------------------

static int renumber_nodes(struct merging *merging, int *number)
{
    struct network *network = merging->network;
    int kept = 0;
    for (int i = 0; i < network->n_node; i++)
        number[i] = -1;
    for (int i = 0; i < network->n_node; i++) { // by the first of the nodes merged
        const int root = merging_node(merging, i);
        if (number[root] < 0) number[root] = kept++;
    }
    for (int i = 0; i < network->n_node; i++)
        number[i] = number[merging_node(merging, i)];
    return kept;
}

static void write_nodes(struct merging *merging, const int *number, int kept)
{
    struct network *network = merging->network;
    for (int i = 0; i < network->n_node; i++) {
        if (merging->parent[i] != i) continue;
        network->node_position[number[i]] = merging->position[i];
        network->node_walls[number[i]] = merging->walls[i];
    }
    network->n_node = kept;
}

static void write_throats(struct merging *merging, const int *number)
{
    struct network *network = merging->network;
    int kept = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (merging->gone[t]) continue;
        const int a = number[network->throat_nodes[t][0]];
        const int b = number[network->throat_nodes[t][1]];
        network->throat_nodes[kept][0] = a < b ? a : b;
        network->throat_nodes[kept][1] = a < b ? b : a;
        network->throat_radius[kept] = network->throat_radius[t];
        if (network->throat_volume)
            network->throat_volume[kept] = network->throat_volume[t];
        network->throat_length[kept] =
            distance(network->node_position[a], network->node_position[b]);
        network->throat_kind[kept++] = network->throat_kind[t];
    }
    network->n_throat = kept;
}

// A loop without repeats and without spikes (there and back again); returns its length.
static int clean_loop(int32_t *loop, int count)
{
    for (bool changed = true; changed && count > 0;) {
        changed = false;
        for (int k = 0; k < count && count > 1; k++) {
            const int next = (k + 1) % count;
            const bool spike = loop[(k + count - 1) % count] == loop[next];
            if (loop[k] != loop[next] && !spike) continue;
            for (int m = k; m + 1 < count; m++)
                loop[m] = loop[m + 1];
            count--;
            changed = true;
        }
    }
    return count;
}

static void write_faces(struct network *network, const int *number)
{
    int kept = 0;
    int64_t end = 0, begin = 0;
    for (int f = 0; f < network->n_face; f++) {
        const int64_t next = network->face_offset[f + 1];
        const int count = (int)(next - begin);
        for (int k = 0; k < count;
             k++) // end <= begin: never overtakes what is still read
            network->face_nodes[end + k] = number[network->face_nodes[begin + k]];
        begin = next;
        const int left = clean_loop(&network->face_nodes[end], count);
        if (left < 3) continue;
        end += left;
        for (int side = 0; side < 2; side++)
            network->face_particles[kept][side] = network->face_particles[f][side];
        network->face_offset[++kept] = end;
    }
    network->n_face = kept;
}

void merging_finish(struct merging *merging)
{
    int *number = NEW_ARRAY(int, merging->network->n_node);
    const int n_node = merging->network->n_node;
    const int kept = renumber_nodes(merging, number);
    write_nodes(merging, number, kept);
    write_throats(merging, number);
    write_faces(merging->network, number);
    for (int i = 0; i < n_node; i++)
        free(merging->row[i].throat);
    free(number);
    free(merging->parent);
    free(merging->position);
    free(merging->weight);
    free(merging->walls);
    free(merging->row);
    free(merging->gone);
    free(merging->stamp);
    free(merging->queue);
    *merging = (struct merging){0};
}
