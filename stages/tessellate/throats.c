// SPDX-License-Identifier: GPL-3.0-or-later
// Throats: the edges of the diagram, dual to the facets of the triangulation. A facet
// between cells c and d is a throat from node(c) to node(d), with the
//     radius = least over grains of (distance to the throat - grain radius)
//     [K 3.7, 3.8].
// A facet is seen from both cells, from copies where the box is periodic, and in walls
// from several images of a grain. Each throat must be counted once: from the cell of
// its lower node, from the copy whose first corner is a grain itself, and throats with
// the same nodes are fused. Two passes, count and fill, so that each thread
// writes to places of its own and the result does not depend on the number of threads.
#include "assemble.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// A throat as seen from a facet, and from the first of its nodes.
struct candidate {
    int32_t second, image; // the other node, and the number of the image it is in
    double radius, length; // in units; the radius may be below 0 where grains overlap
};

// Candidates of nodes that several cells may share: those of node i from offset[i] to
// offset[i + 1]. Other nodes have only the candidates of their one cell.
struct candidates {
    int *offset; // (n_node + 2)
    struct candidate *at;
};

// The least clearance of the throat of the facet opposite corner K of CELL.
static double facet_clearance(const struct assembly *assembly, int cell, int k,
                              const struct vector end[2])
{
    struct clear_way way = nothing_beside;
    for (int m = 0; m < 4; m++) {
        const int32_t point = assembly->triangulation->cell[cell].vertex[m];
        if (m == k || assembly->generators->origin[point].wall >= 0) continue;
        way = clear_of(way, assembly->generators->point[point].at,
                       assembly->radius[point], end, assembly->clearance);
    }
    if (assembly->clearance != CLEARANCE_SEGMENT) return way.least;
    return least_clearance(&assembly->grains, end, way);
}

// In a periodic box each facet has many copies: the one whose first corner is a grain
// itself counts. Without copies every facet with a grain counts.
static bool facet_counts(const struct assembly *assembly, int cell, int k)
{
    const struct generators *generators = assembly->generators;
    const int32_t *corner = assembly->triangulation->cell[cell].vertex;
    int32_t first = -1;
    if (!has_copies(generators))
        return (k != 0 && is_grain(generators, corner[0])) ||
               (k != 1 && is_grain(generators, corner[1])) ||
               (k != 2 && is_grain(generators, corner[2])) ||
               (k != 3 && is_grain(generators, corner[3]));
    for (int m = 0; m < 4; m++)
        if (m != k &&
            (first < 0 || compare_generators(generators, corner[m], first) < 0))
            first = corner[m];
    return is_grain(generators, first);
}

// The facets of cell C, as bits, whose throat has the cell's node as its first. A
// throat that joins a node to its own image, around the box, counts where the number of
// that image is above 0.
static int find_facets(const struct assembly *assembly, int c)
{
    const struct triangulation *cells = assembly->triangulation;
    const int32_t node = cells->node[c];
    int facets = 0;
    for (int k = 0; k < 4 && node >= 0; k++) {
        const int32_t d = cells->cell[c].neighbour[k];
        if (d < 0 || node > cells->node[d] || !facet_counts(assembly, c, k)) continue;
        if (node < cells->node[d] ||
            image_number(image_difference(node_image(cells, d), node_image(cells, c))) >
                0)
            facets |= 1 << k;
    }
    return facets;
}

// Notes in each cell what its facets are. Counts the throats of nodes with one cell,
// one place on, and the candidates of those that are shared, two places on.
static void count_throats(const struct assembly *assembly, int *count, int *shared)
{
    const struct triangulation *cells = assembly->triangulation;
#pragma omp parallel for
    for (int c = 0; c < cells->n_cell; c++) {
        const int facets = find_facets(assembly, c);
        if (!facets) continue;
        const int more = __builtin_popcount((unsigned)facets);
        if (cells->seen[c] & SHARES_NODE)
#pragma omp atomic
            shared[cells->node[c] + 2] += more;
        else
            count[cells->node[c] + 1] = more;
        cells->seen[c] |= (uint8_t)facets;
    }
}

// Position of the node of cell C, in the image that the cell sees.
static struct vector node_of(const struct assembly *assembly, int c)
{
    const struct triangulation *cells = assembly->triangulation;
    const struct vector at = assembly->nodes->position[cells->node[c]];
    return cells->image ? position_in_image(assembly->generators, at, cells->image[c])
                        : at;
}

// The candidates from the facets of a cell. Returns how many.
static int gather(const struct assembly *assembly, int c, struct candidate at[4])
{
    const struct triangulation *cells = assembly->triangulation;
    struct vector end[2] = {node_of(assembly, c)};
    int count = 0;
    for (int k = 0; k < 4; k++) {
        if (!(cells->seen[c] & 1 << k)) continue;
        const int32_t d = cells->cell[c].neighbour[k];
        end[1] = node_of(assembly, d);
        at[count++] = (struct candidate){
            cells->node[d],
            image_number(image_difference(node_image(cells, d), node_image(cells, c))),
            facet_clearance(assembly, c, k, end), distance(end[0], end[1])};
    }
    return count;
}

// Filling moves each offset on, so that candidates of a node end where those of the
// next begin.
static void fill_candidates(const struct assembly *assembly,
                            struct candidates *candidates)
{
    const struct triangulation *cells = assembly->triangulation;
#pragma omp parallel for
    for (int c = 0; c < cells->n_cell; c++) {
        if (cells->seen[c] <= SHARES_NODE) continue; // no facets, or its own node
        struct candidate at[4];
        const int count = gather(assembly, c, at);
        int to;
#pragma omp atomic capture
        {
            to = candidates->offset[cells->node[c] + 1];
            candidates->offset[cells->node[c] + 1] += count;
        }
        memcpy(candidates->at + to, at, (size_t)count * sizeof *at);
    }
}

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *p = a, *q = b;
    if (p->second != q->second) return p->second < q->second ? -1 : 1;
    if (p->image != q->image) return p->image < q->image ? -1 : 1;
    if (p->radius != q->radius) return p->radius < q->radius ? -1 : 1;
    return (p->length > q->length) - (p->length < q->length);
}

static void sort_candidates(struct candidate *at, int count)
{
    enum { FEW = 32 };
    if (count > FEW) {
        qsort(at, (size_t)count, sizeof *at, compare_candidates);
        return;
    }
    for (int k = 1; k < count; k++) {
        const struct candidate candidate = at[k];
        int to = k;
        for (; to > 0 && compare_candidates(&at[to - 1], &candidate) > 0; to--)
            at[to] = at[to - 1];
        at[to] = candidate;
    }
}

// Throats between the same two nodes are one, as edges are straight: one in a wall is
// seen from the facets of several images, one from wall to wall past a square of grains
// from each triangle of the square. It has the smallest radius, which comes first.
// Returns how many of COUNT remain.
static int fuse_same(struct candidate *at, int count)
{
    int kept = 0;
    for (int k = 0; k < count; k++)
        if (!kept || at[kept - 1].second != at[k].second ||
            at[kept - 1].image != at[k].image)
            at[kept++] = at[k];
    return kept;
}

// The throats of one node, from throat TO on.
static void store(const struct candidate *at, int count, double unit, int node, int to,
                  struct network *network)
{
    for (int k = 0; k < count; k++) {
        network->throat_nodes[to + k][0] = node;
        network->throat_nodes[to + k][1] = at[k].second;
        network->throat_length[to + k] = unit * at[k].length;
        network->throat_radius[to + k] = unit * fmax(0, at[k].radius);
        if (network->throat_image)
            network->throat_image[to + k] = numbered_image(at[k].image);
    }
}

static void allocate_throats(struct network *network, int count)
{
    network->n_throat = count;
    const size_t n = (size_t)count;
    network->throat_nodes = allocate_uncleared(n, sizeof *network->throat_nodes);
    network->throat_radius = allocate_uncleared(n, sizeof *network->throat_radius);
    network->throat_length = allocate_uncleared(n, sizeof *network->throat_length);
    network->throat_kind = NEW_ARRAY(uint8_t, count);
    if (is_periodic(&network->packing))
        network->throat_image = NEW_ARRAY(struct image, count);
}

// Sorts and fuses what shared nodes have, and counts what is left.
static void fuse_candidates(const struct assembly *assembly,
                            const struct candidates *candidates, int *count)
{
    const int *offset = candidates->offset;
#pragma omp parallel for
    for (int i = 0; i < assembly->nodes->n; i++) {
        const int many = offset[i + 1] - offset[i];
        struct candidate *at = candidates->at + offset[i];
        if (!many) continue;
        sort_candidates(at, many);
        count[i + 1] = fuse_same(at, many);
    }
}

// Prefetches nodes and throats of later cells, which are scattered in memory.
PREFETCHING prefetch_nodes(const struct assembly *assembly, int c, const int *begin,
                           const struct network *network)
{
    enum { AHEAD = 12 };
    const struct triangulation *cells = assembly->triangulation;
    if (c + 2 * AHEAD >= cells->n_cell) return;
    const int32_t later = cells->node[c + 2 * AHEAD], next = cells->node[c + AHEAD];
    if (later >= 0) __builtin_prefetch(&begin[later]);
    if (next < 0) return;
    for (int k = 0; k < 4; k++) {
        const int32_t d = cells->cell[c + AHEAD].neighbour[k];
        if (d >= 0) __builtin_prefetch(&assembly->nodes->position[cells->node[d]].z);
    }
    __builtin_prefetch(&assembly->nodes->position[next].z);
    __builtin_prefetch(&network->throat_nodes[begin[next]], 1);
    __builtin_prefetch(&network->throat_radius[begin[next]], 1);
    __builtin_prefetch(&network->throat_length[begin[next]], 1);
}

// The throats of each node, from BEGIN of it on.
static void store_throats(const struct assembly *assembly,
                          const struct candidates *candidates, const int *begin,
                          struct network *network)
{
    const struct triangulation *cells = assembly->triangulation;
    const double unit = assembly->generators->unit;
#pragma omp parallel for
    for (int c = 0; c < cells->n_cell; c++) {
        prefetch_nodes(assembly, c, begin, network);
        if (cells->seen[c] && !(cells->seen[c] & SHARES_NODE)) {
            struct candidate at[4];
            const int count = gather(assembly, c, at), node = cells->node[c];
            sort_candidates(at, count);
            store(at, count, unit, node, begin[node], network);
        }
        cells->seen[c] = 0;
    }
#pragma omp parallel for
    for (int i = 0; i < assembly->nodes->n; i++)
        if (candidates->offset[i + 1] > candidates->offset[i])
            store(candidates->at + candidates->offset[i], begin[i + 1] - begin[i], unit,
                  i, begin[i], network);
}

void assemble_throats(const struct assembly *assembly, struct network *network)
{
    const int n = assembly->nodes->n;
    int *begin = allocate_aligned((size_t)n + 1, sizeof *begin);
    struct candidates candidates = {.offset = NEW_ARRAY(int, n + 2)};
    count_throats(assembly, begin, candidates.offset);
    for (int i = 0; i < n; i++)
        candidates.offset[i + 2] += candidates.offset[i + 1];
    candidates.at = NEW_ARRAY(struct candidate, candidates.offset[n + 1]);
    fill_candidates(assembly, &candidates);
    fuse_candidates(assembly, &candidates, begin);
    for (int i = 0; i < n; i++)
        begin[i + 1] += begin[i];
    allocate_throats(network, begin[n]);
    store_throats(assembly, &candidates, begin, network);
    free(candidates.offset);
    free(candidates.at);
    free(begin);
}
