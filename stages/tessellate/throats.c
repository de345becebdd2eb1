// SPDX-License-Identifier: GPL-3.0-or-later
// Throats: the edges of the diagram, dual to the facets of the triangulation.
#include "assemble.h"

#include "basics/memory.h"

#include <stdlib.h>

// A throat as seen from a facet, and from the first of its nodes.
struct candidate {
    int32_t second, image; // the other node, and the number of the image it is in
    double radius, length; // in units; the radius may be below 0 where grains overlap
};

// Candidates by their first nodes: those of node i from offset[i] to offset[i + 1].
struct candidates {
    int *offset; // (n_node + 1)
    struct candidate *at;
};

double clearance_of(struct vector centre, double radius, const struct vector end[2],
                    enum clearance how)
{
    const struct vector along = subtract(end[1], end[0]);
    const struct vector to = subtract(centre, end[0]);
    const double length2 = dot(along, along);
    double t = length2 > 0 ? dot(to, along) / length2 : 0;
    if (how == CLEARANCE_SEGMENT) t = t < 0 ? 0 : t > 1 ? 1 : t;
    return norm(subtract(to, scale(t, along))) - radius;
}

// The least clearance to the grains of the facet opposite corner K of CELL.
static double facet_clearance(const struct assembly *assembly, int cell, int k,
                              const struct vector end[2])
{
    double least = HUGE_VAL;
    for (int m = 0; m < 4; m++) {
        const int32_t point = assembly->triangulation->cell[cell].vertex[m];
        if (m == k || assembly->generators->wall[point] >= 0) continue;
        const int32_t grain = assembly->generators->particle[point];
        const double here =
            clearance_of(assembly->generators->position[point], assembly->radius[grain],
                         end, assembly->clearance);
        if (here < least) least = here;
    }
    return least;
}

// Each facet has many copies where the box repeats: the one whose first corner is a
// grain itself counts. Where nothing repeats, that is each facet with a grain.
static bool facet_counts(const struct assembly *assembly, int cell, int k)
{
    const struct generators *generators = assembly->generators;
    const int32_t *corner = assembly->triangulation->cell[cell].vertex;
    int32_t first = -1;
    if (generators->n == generators->n_base)
        return (k != 0 && corner[0] < generators->n_particle) ||
               (k != 1 && corner[1] < generators->n_particle) ||
               (k != 2 && corner[2] < generators->n_particle) ||
               (k != 3 && corner[3] < generators->n_particle);
    for (int m = 0; m < 4; m++)
        if (m != k &&
            (first < 0 || compare_generators(generators, corner[m], first) < 0))
            first = corner[m];
    return first < generators->n_particle;
}

// The facets of cell C, as bits, from which a throat is seen whose first node is that
// of the cell. A throat that joins a node to its own image, around the box, is seen
// from where the number of that image is above 0.
static int find_facets(const struct assembly *assembly, int c)
{
    const struct cell *cells = assembly->triangulation->cell, *from = &cells[c];
    int facets = 0;
    for (int k = 0; k < 4 && from->node >= 0; k++) {
        const int d = from->neighbour[k];
        if (d < 0 || from->node > cells[d].node || !facet_counts(assembly, c, k))
            continue;
        if (from->node < cells[d].node ||
            image_number(image_difference(cells[d].image, from->image)) > 0)
            facets |= 1 << k;
    }
    return facets;
}

// Adds MORE to the count of the node of a cell; returns what it was. Most cells have
// nodes of their own, and need not wait.
static int add_to_count(const struct cell *cell, int *count, int more)
{
    int before;
    if (cell->seen & SHARES_NODE) {
#pragma omp atomic capture
        {
            before = *count;
            *count += more;
        }
        return before;
    }
    before = *count;
    *count += more;
    return before;
}

// How many candidates there are of each first node, two places on.
static void count_candidates(const struct assembly *assembly, int *count)
{
#pragma omp parallel for
    for (int c = 0; c < assembly->triangulation->n_cell; c++) {
        struct cell *cell = &assembly->triangulation->cell[c];
        expect_neighbours(assembly->triangulation, c);
        const int facets = find_facets(assembly, c);
        cell->seen |= (uint8_t)facets; // until filling
        if (facets)
            add_to_count(cell, &count[cell->node + 2],
                         __builtin_popcount((unsigned)facets));
    }
}

// Filling moves each offset on, so that candidates of a node end where those of the
// next begin.
static void fill_candidates(const struct assembly *assembly,
                            struct candidates *candidates)
{
    const struct triangulation *cells = assembly->triangulation;
#pragma omp parallel for
    for (int c = 0; c < cells->n_cell; c++) {
        struct cell *from = &cells->cell[c];
        const int facets = from->seen & ~SHARES_NODE;
        expect_neighbours(cells, c);
        from->seen &= SHARES_NODE;
        if (!facets) continue;
        int to = add_to_count(from, &candidates->offset[from->node + 1],
                              __builtin_popcount((unsigned)facets));
        for (int k = 0; k < 4; k++) {
            if (!(facets & 1 << k)) continue;
            const struct cell *other = &cells->cell[from->neighbour[k]];
            const struct vector end[2] = {from->at, other->at};
            const struct image apart = image_difference(other->image, from->image);
            candidates->at[to++] = (struct candidate){
                other->node, image_number(apart), facet_clearance(assembly, c, k, end),
                distance(end[0], end[1])};
        }
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

// A throat in a wall is seen from the facets of several images: one throat, as wide as
// the narrowest of them says, which comes first. Returns how many of COUNT stay.
static int fuse_in_walls(const uint8_t *walls, int node, struct candidate *at,
                         int count)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        const bool same = kept && at[kept - 1].second == at[k].second &&
                          at[kept - 1].image == at[k].image &&
                          (walls[node] & walls[at[k].second]);
        if (!same) at[kept++] = at[k];
    }
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
    network->throat_nodes = allocate((size_t)count, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, count);
    network->throat_length = NEW_ARRAY(double, count);
    network->throat_kind = NEW_ARRAY(uint8_t, count);
    if (is_periodic(&network->packing))
        network->throat_image = NEW_ARRAY(struct image, count);
}

// Sorts and fuses what the nodes have, and stores it one node after the other.
static void store_candidates(const struct assembly *assembly,
                             const struct candidates *candidates,
                             struct network *network)
{
    const int n = assembly->nodes->n, *offset = candidates->offset;
    int *to = NEW_ARRAY(int, n + 1);
#pragma omp parallel for
    for (int i = 0; i < n; i++) {
        struct candidate *at = candidates->at + offset[i];
        sort_candidates(at, offset[i + 1] - offset[i]);
        to[i + 1] =
            fuse_in_walls(assembly->nodes->walls, i, at, offset[i + 1] - offset[i]);
    }
    for (int i = 0; i < n; i++)
        to[i + 1] += to[i];
    allocate_throats(network, to[n]);
#pragma omp parallel for
    for (int i = 0; i < n; i++)
        store(candidates->at + offset[i], to[i + 1] - to[i], assembly->generators->unit,
              i, to[i], network);
    free(to);
}

void assemble_throats(const struct assembly *assembly, struct network *network)
{
    const int n = assembly->nodes->n;
    struct candidates candidates = {.offset = NEW_ARRAY(int, n + 2)};
    count_candidates(assembly, candidates.offset);
    for (int i = 0; i < n; i++)
        candidates.offset[i + 2] += candidates.offset[i + 1];
    candidates.at =
        allocate_aligned((size_t)candidates.offset[n + 1], sizeof *candidates.at);
    fill_candidates(assembly, &candidates);
    store_candidates(assembly, &candidates, network);
    free(candidates.offset);
    free(candidates.at);
}
