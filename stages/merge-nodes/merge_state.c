// SPDX-License-Identifier: GPL-3.0-or-later
// The state of merging: a union-find of nodes with periodic images (each node knows in
// which image of its parent it lies, and path halving adds these up), the throats of
// each root, and a binary heap of throats by length. A throat whose length changes is
// pushed again with a higher stamp; older entries are skipped when they come up, which
// is simpler than moving them. When two nodes unite, the shorter list of throats moves
// to the other, and a throat that has become parallel to another is fused with it.
#include "merge_state.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// ---- the queue: a binary heap, shortest first, then lowest nodes --------------------
// Throats of the boundary layer hold nothing and stay.

static bool comes_before(const struct queued *a, const struct queued *b)
{
    if (a->length != b->length) return a->length < b->length;
    for (int end = 0; end < 2; end++)
        if (a->nodes[end] != b->nodes[end]) return a->nodes[end] < b->nodes[end];
    return a->throat < b->throat;
}

static void push(struct merging *merging, int throat, double length)
{
    if (merging->network->throat_kind[throat] == THROAT_BOUNDARY_LAYER) return;
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

// The root of NODE, and the image of it that NODE lies in. Halves the path.
static int root_of(struct merging *merging, int node, struct image *image)
{
    int *parent = merging->parent;
    struct image *within = merging->image;
    *image = within[node];
    while (parent[node] != node) {
        const int above = parent[node];
        if (parent[above] != above) {
            within[node] = image_sum(within[node], within[above]);
            parent[node] = parent[above];
        }
        *image = image_sum(*image, within[above]);
        node = above;
    }
    return node;
}

struct merging_ends merging_ends(struct merging *merging, int throat)
{
    const struct network *network = merging->network;
    struct merging_ends ends;
    struct image image[2];
    for (int end = 0; end < 2; end++)
        ends.node[end] =
            root_of(merging, network->throat_nodes[throat][end], &image[end]);
    ends.image = image_difference(image[1], image[0]);
    if (network->throat_image)
        ends.image = image_sum(ends.image, network->throat_image[throat]);
    return ends;
}

struct merging_ends merging_reversed(struct merging_ends ends)
{
    return (struct merging_ends){{ends.node[1], ends.node[0]},
                                 image_opposite(ends.image)};
}

// The ends of THROAT as seen from ROOT, which is one of them.
static struct merging_ends ends_from(struct merging *merging, int root, int throat)
{
    const struct merging_ends ends = merging_ends(merging, throat);
    return ends.node[0] == root ? ends : merging_reversed(ends);
}

static bool same_ends(struct merging_ends a, struct merging_ends b)
{
    return a.node[0] == b.node[0] && a.node[1] == b.node[1] &&
           same_image(a.image, b.image);
}

static bool parallel(struct merging_ends a, struct merging_ends b)
{
    return same_ends(a, b) || same_ends(a, merging_reversed(b));
}

struct vector merging_vector(const struct merging *merging, struct merging_ends ends)
{
    return image_apart(&merging->network->packing, merging->position[ends.node[0]],
                       merging->position[ends.node[1]], ends.image);
}

static void append(struct throat_row *row, int throat)
{
    GROW_ARRAY(row->throat, row->count, row->capacity);
    row->throat[row->count++] = throat;
}

void merging_remove(struct merging *merging, int throat)
{
    merging->gone[throat] = true;
    merging->removed += merging->network->throat_kind[throat] != THROAT_BOUNDARY_LAYER;
}

// Parallel throats conduct side by side: their conductances add up, and walls count in
// each for what diffuses through it.
static void add_shapes(struct network *network, int kept, int removed)
{
    double *diffusion = network->throat_diffusion, *flow = network->throat_flow;
    double *radius = network->throat_hydraulic_radius;
    if (radius && diffusion && diffusion[kept] + diffusion[removed] > 0)
        radius[kept] =
            (diffusion[kept] * radius[kept] + diffusion[removed] * radius[removed]) /
            (diffusion[kept] + diffusion[removed]);
    if (diffusion) diffusion[kept] += diffusion[removed];
    if (flow) flow[kept] += flow[removed];
}

static void fuse(struct merging *merging, int kept, int removed)
{
    double *radius = merging->network->throat_radius;
    double *volume = merging->network->throat_volume;
    radius[kept] = fmax(radius[kept], radius[removed]);
    if (volume) volume[kept] += volume[removed];
    add_shapes(merging->network, kept, removed);
    merging_remove(merging, removed);
}

double merging_share_volume(struct merging *merging, int root, double volume)
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

// Fuses throats that are parallel at the start: a tessellation unites nodes on walls,
// and imported networks may have any.
static void fuse_parallel(struct merging *merging)
{
    for (int t = 0; t < merging->network->n_throat; t++) {
        const struct merging_ends ends = merging_ends(merging, t);
        const struct throat_row *row = &merging->row[ends.node[0]];
        for (int k = 0; k < row->count && !merging->gone[t]; k++) {
            const int other = row->throat[k];
            if (other > t && !merging->gone[other] &&
                parallel(ends, merging_ends(merging, other)))
                fuse(merging, t, other);
        }
    }
}

struct merging merging_begin(struct network *network)
{
    const size_t n_node = (size_t)network->n_node;
    struct merging merging = {
        .network = network,
        .parent = NEW_ARRAY(int, n_node),
        .image = NEW_ARRAY(struct image, n_node),
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
        const int32_t *ends = network->throat_nodes[t];
        append(&merging.row[ends[0]], t);
        if (ends[1] != ends[0]) append(&merging.row[ends[1]], t);
        // As merging_finish will write it: a length from elsewhere may differ in its
        // last digit, and so fall on the other side of a threshold when merged again.
        push(&merging, t, norm(along_throat(network, t)));
    }
    fuse_parallel(&merging);
    return merging;
}

static void measure_again(struct merging *merging, int throat)
{
    const double length = norm(merging_vector(merging, merging_ends(merging, throat)));
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

// The throat of ROW parallel to THROAT, or -1. Nodes have a handful of throats, so
// looking through them costs less than any index.
static int parallel_to(struct merging *merging, const struct throat_row *row, int root,
                       int throat)
{
    const struct merging_ends ends = ends_from(merging, root, throat);
    for (int k = 0; k < row->count; k++)
        if (row->throat[k] != throat && !merging->gone[row->throat[k]] &&
            parallel(ends, ends_from(merging, root, row->throat[k])))
            return row->throat[k];
    return -1;
}

// Whether THROAT is in ROW: in a periodic box two nodes may be joined on both sides.
static bool holds(const struct throat_row *row, int throat)
{
    for (int k = 0; k < row->count; k++)
        if (row->throat[k] == throat) return true;
    return false;
}

void merging_move_throats(struct merging *merging, int root, int other, bool moved)
{
    struct throat_row *row = &merging->row[root], *from = &merging->row[other];
    drop_gone(merging, row);
    drop_gone(merging, from);
    const int before = row->count;
    for (int k = 0; k < from->count; k++) {
        const int throat = from->throat[k];
        if (merging->gone[throat]) continue;
        const int twin = parallel_to(merging, row, root, throat);
        if (twin >= 0) {
            fuse(merging, twin < throat ? twin : throat, twin < throat ? throat : twin);
            if (twin < throat) continue;
        }
        if (!holds(row, throat)) append(row, throat);
        measure_again(merging, throat);
    }
    drop_gone(merging, row);
    for (int k = 0; moved && k < row->count && k < before; k++)
        measure_again(merging, row->throat[k]);
    free(from->throat);
    *from = (struct throat_row){0};
}

// ---- writing back -------------------------------------------------------------------

// Gives every node its new NUMBER, and in merging->image the image it lies in of the
// new node. Returns how many nodes remain.
static int renumber_nodes(struct merging *merging, int *number)
{
    const int n_node = merging->network->n_node;
    struct image *image = NEW_ARRAY(struct image, n_node);
    int kept = 0;
    for (int i = 0; i < n_node; i++)
        number[i] = -1;
    for (int i = 0; i < n_node; i++) { // by the first of the nodes merged
        const int root = root_of(merging, i, &image[i]);
        if (number[root] < 0) number[root] = kept++;
    }
    struct image unused;
    for (int i = 0; i < n_node; i++)
        number[i] = number[root_of(merging, i, &unused)];
    free(merging->image);
    merging->image = image;
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

// Writes the ends of a throat, the lower node first; a throat from a node to its own
// image in the direction whose image number is positive.
static void write_ends(struct merging *merging, const int *number, int throat, int kept)
{
    struct network *network = merging->network;
    const int32_t *ends = network->throat_nodes[throat];
    const int a = number[ends[0]], b = number[ends[1]];
    bool turn = a > b;
    if (network->throat_image) {
        struct image image = image_sum(
            network->throat_image[throat],
            image_difference(merging->image[ends[1]], merging->image[ends[0]]));
        turn |= a == b && image_number(image) < 0;
        network->throat_image[kept] = turn ? image_opposite(image) : image;
    }
    network->throat_nodes[kept][0] = turn ? b : a;
    network->throat_nodes[kept][1] = turn ? a : b;
}

static void write_throats(struct merging *merging, const int *number)
{
    struct network *network = merging->network;
    int kept = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (merging->gone[t]) continue;
        write_ends(merging, number, t, kept);
        network->throat_radius[kept] = network->throat_radius[t];
        if (network->throat_volume)
            network->throat_volume[kept] = network->throat_volume[t];
        copy_throat_shape(network, t, kept);
        network->throat_length[kept] = norm(along_throat(network, kept));
        network->throat_kind[kept++] = network->throat_kind[t];
    }
    network->n_throat = kept;
}

// A closed path along nodes, and the image of each node (NULL if nothing is periodic).
struct loop {
    int32_t *node;
    struct image *image;
    int count;
};

static bool same_corner(const struct loop *loop, int a, int b)
{
    return loop->node[a] == loop->node[b] &&
           (!loop->image || same_image(loop->image[a], loop->image[b]));
}

// Removes repeated corners, and spikes (a corner between two equal ones).
static void clean_loop(struct loop *loop)
{
    for (bool changed = true; changed && loop->count > 0;) {
        changed = false;
        for (int k = 0; k < loop->count && loop->count > 1; k++) {
            const int next = (k + 1) % loop->count;
            const int last = (k + loop->count - 1) % loop->count;
            if (!same_corner(loop, k, next) && !same_corner(loop, last, next)) continue;
            for (int m = k; m + 1 < loop->count; m++) {
                loop->node[m] = loop->node[m + 1];
                if (loop->image) loop->image[m] = loop->image[m + 1];
            }
            loop->count--;
            changed = true;
        }
    }
}

// The loop of the face that began at BEGIN, renumbered and moved to END (which never
// overtakes what is still to be read).
static struct loop move_loop(struct merging *merging, const int *number, int64_t begin,
                             int64_t end, int count)
{
    struct network *network = merging->network;
    struct image *image = network->face_node_image;
    for (int k = 0; k < count; k++) {
        const int32_t node = network->face_nodes[begin + k];
        network->face_nodes[end + k] = number[node];
        if (image) image[end + k] = image_sum(image[begin + k], merging->image[node]);
    }
    return (struct loop){network->face_nodes + end, image ? image + end : NULL, count};
}

static void write_faces(struct merging *merging, const int *number)
{
    struct network *network = merging->network;
    int kept = 0;
    int64_t end = 0, begin = 0;
    for (int f = 0; f < network->n_face; f++) {
        const int64_t next = network->face_offset[f + 1];
        struct loop loop = move_loop(merging, number, begin, end, (int)(next - begin));
        begin = next;
        clean_loop(&loop);
        if (loop.count < 3) continue;
        end += loop.count;
        for (int side = 0; side < 2; side++)
            network->face_particles[kept][side] = network->face_particles[f][side];
        if (network->face_image) network->face_image[kept] = network->face_image[f];
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
    write_faces(merging, number);
    for (int i = 0; i < n_node; i++)
        free(merging->row[i].throat);
    free(number);
    free(merging->parent);
    free(merging->image);
    free(merging->position);
    free(merging->weight);
    free(merging->walls);
    free(merging->row);
    free(merging->gone);
    free(merging->stamp);
    free(merging->queue);
    *merging = (struct merging){0};
}
