// SPDX-License-Identifier: GPL-3.0-or-later
// Incremental insertion (Bowyer 1981, Watson 1981). For each point e, in a spatial
// order:
//     locate       walk to the cell that holds e,
//     find_cavity  all cells whose sphere takes e (power of e to the cell's centre
//                  below that of its vertices), and the facets around them (`rim`),
//     fill_cavity  one new cell for each facet of the rim with e, linked by a hash
//                  table of the directed edges of the rim.
// Cells with the vertex INFINITE close the hull; between walls, negative vertices name
// walls as limit planes (triangulation_in_walls.h), which CGAL does not offer.
// Decisions are exact (insertion_predicates.c), so the result does not depend on the
// order.
#include "geometry/triangulation/regular_triangulation.h"

#include "basics/memory.h"
#include "geometry/triangulation/insertion.h"

#include <stdlib.h>
#include <string.h>

enum { NOWHERE = -2 };

// ---- one point ----------------------------------------------------------------------

// The cell that point E is in: from the last, across facets that it is beyond. Such
// walks end in regular triangulations.
static int32_t locate(const struct insertion *insertion, int32_t e)
{
    int32_t at = insertion->last, before = NOWHERE;
    for (;;) {
        const struct live_cell *cell = &insertion->cell[at];
        int k = 0;
        if (cell->error < 0) { // infinite: stay, or start from the finite one beside
            if (before != NOWHERE) return at;
            while (cell->vertex[k] != INFINITE)
                k++;
            at = cell->neighbour[k];
            continue;
        }
        while (k < 4 && (cell->neighbour[k] == before ||
                         orientation_with(insertion, cell->vertex, k, e) >= 0))
            k++;
        if (k == 4) return at;
        before = at;
        at = cell->neighbour[k];
    }
}

// For four more in the cavity, or in the rim.
static void make_room(struct insertion *insertion)
{
    if (insertion->n_cavity + 4 > insertion->cavity_capacity)
        insertion->cavity =
            reallocate(insertion->cavity, (size_t)(insertion->cavity_capacity *= 2),
                       sizeof *insertion->cavity);
    if (insertion->n_rim + 4 > insertion->rim_capacity)
        insertion->rim =
            reallocate(insertion->rim, (size_t)(insertion->rim_capacity *= 2),
                       sizeof *insertion->rim);
}

// Gathers the cells that point E takes, from START on, and the rim around them. What
// comes next depends on the data alone: entries are written in any case, and count or
// not.
static void find_cavity(struct insertion *insertion, int32_t start, int32_t e)
{
    static const uint8_t facing[4][3] = {{1, 3, 2}, {3, 0, 2}, {1, 0, 3}, {0, 1, 2}};
    insertion->n_rim = 0;
    insertion->n_cavity = 1;
    insertion->cavity[0] = start;
    insertion->cell[start].seen = 1;
    for (int at = 0; at < insertion->n_cavity; at++) {
        int n_cavity = insertion->n_cavity, n_rim = insertion->n_rim;
        make_room(insertion);
        const int32_t from = insertion->cavity[at];
        const struct live_cell *cell = &insertion->cell[from];
        for (int k = 0; k < 4; k++) {
            const int32_t next = cell->neighbour[k];
            struct live_cell *beyond = &insertion->cell[next];
            const bool fresh = !beyond->seen;
            const bool taken = fresh & takes(insertion, beyond, e);
            beyond->seen |= taken;
            insertion->cavity[n_cavity] = next;
            n_cavity += taken;
            insertion->rim[n_rim] = (struct facet){
                .vertex = {cell->vertex[facing[k][0]], cell->vertex[facing[k][1]],
                           cell->vertex[facing[k][2]]},
                .beyond = next,
                .back = index_among(beyond->neighbour, from)};
            n_rim += fresh & !taken;
        }
        insertion->n_cavity = n_cavity;
        insertion->n_rim = n_rim;
    }
    insertion->n_test += insertion->n_cavity + insertion->n_rim;
}

// Where the edge is in the table, or would be.
static struct edge *find_edge(const struct insertion *insertion, int32_t from,
                              int32_t to, int32_t inserted)
{
    uint32_t hash = (uint32_t)from * 0x9e3779b1u ^ (uint32_t)to * 0x85ebca77u;
    for (hash ^= hash >> 15;; hash++) {
        struct edge *edge = &insertion->edge[hash & insertion->edge_mask];
        if (edge->inserted != inserted || (edge->from == from && edge->to == to))
            return edge;
    }
}

// The table three times as long as the rim has edges, at least, and then empty.
static void widen_edge_table(struct insertion *insertion, uint32_t least)
{
    if (insertion->edge_mask >= least) return;
    while (insertion->edge_mask < least)
        insertion->edge_mask = 2 * insertion->edge_mask + 1;
    const size_t length = (size_t)insertion->edge_mask + 1;
    insertion->edge = reallocate(insertion->edge, length, sizeof *insertion->edge);
    memset(insertion->edge, 0xff, length * sizeof *insertion->edge);
}

static int32_t add_cell(struct insertion *insertion)
{
    if (insertion->n_unused) return insertion->unused[--insertion->n_unused];
    if (insertion->n_cell == insertion->cell_capacity) {
        struct live_cell *cell =
            allocate_uncleared((size_t)(insertion->cell_capacity *= 2), sizeof *cell);
        memcpy(cell, insertion->cell, (size_t)insertion->n_cell * sizeof *cell);
        free(insertion->cell);
        insertion->cell = cell;
    }
    return insertion->n_cell++;
}

// Cells for all of the rim: those taken, then others.
static void make_cells(struct insertion *insertion)
{
    if (insertion->n_rim > insertion->cavity_capacity)
        insertion->cavity = reallocate(
            insertion->cavity, (size_t)(insertion->cavity_capacity = insertion->n_rim),
            sizeof *insertion->cavity);
    for (int k = insertion->n_cavity; k < insertion->n_rim; k++)
        insertion->cavity[k] = add_cell(insertion);
    for (int k = insertion->n_rim; k < insertion->n_cavity; k++) {
        GROW_ARRAY(insertion->unused, insertion->n_unused, insertion->unused_capacity);
        insertion->unused[insertion->n_unused++] = insertion->cavity[k];
    }
}

// Joins point E to the rim: cells in the place of those taken, next to each other where
// their facets share an edge.
static void fill_cavity(struct insertion *insertion, int32_t e)
{
    const int n_rim = insertion->n_rim;
    widen_edge_table(insertion, 9 * (uint32_t)n_rim);
    make_cells(insertion);
    for (int f = 0; f < n_rim; f++) {
        const struct facet *facet = &insertion->rim[f];
        const int32_t *v = facet->vertex, i = insertion->cavity[f];
        for (int k = 0; k < 3; k++) {
            const int32_t from = v[(k + 1) % 3], to = v[(k + 2) % 3];
            *find_edge(insertion, from, to, e) = (struct edge){from, to, e, i};
        }
        insertion->cell[i] = (struct live_cell){.vertex = {v[0], v[1], v[2], e},
                                                .neighbour = {[3] = facet->beyond}};
        insertion->cell[facet->beyond].neighbour[facet->back] = i;
    }
    for (int f = 0; f < n_rim; f++) {
        const int32_t *v = insertion->rim[f].vertex;
        for (int k = 0; k < 3; k++)
            insertion->cell[insertion->cavity[f]].neighbour[k] =
                find_edge(insertion, v[(k + 2) % 3], v[(k + 1) % 3], e)->cell;
    }
    find_centres(insertion->point, insertion->box, insertion->cell, insertion->cavity,
                 n_rim);
    insertion->last = insertion->cavity[0];
}

static bool same_place(struct vector a, struct vector b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// A point is engulfed when it does not even take the cell it is in, or lies on a vertex
// as heavy.
static void insert(struct insertion *insertion, int32_t e)
{
    const int32_t start = locate(insertion, e);
    const struct live_cell *cell = &insertion->cell[start];
    const struct weighted_point *point = insertion->point;
    for (int k = 0; k < 4; k++)
        if (cell->vertex[k] >= 0 &&
            same_place(point[cell->vertex[k]].at, point[e].at) &&
            point[e].weight <= point[cell->vertex[k]].weight)
            return;
    if (!takes(insertion, cell, e)) return;
    find_cavity(insertion, start, e);
    fill_cavity(insertion, e);
}

// ---- all points ---------------------------------------------------------------------

// Four points that are not in one plane, the first of all among them, positively
// oriented. False when there are none.
static bool find_corners(const struct weighted_point *point, int n, int32_t corner[4])
{
    int i = 1;
    while (i < n && same_place(point[0].at, point[i].at))
        i++;
    const int second = i;
    while (i < n && exact_collinear(&point[0].at, &point[second].at, &point[i].at))
        i++;
    const int third = i;
    for (int turn = 0; i < n; i++) {
        const struct weighted_point *p[4] = {&point[0], &point[second], &point[third],
                                             &point[i]};
        turn = orientation(p);
        if (!turn) continue;
        memcpy(corner,
               (int32_t[]){turn > 0 ? 0 : second, turn > 0 ? second : 0, third, i},
               4 * sizeof *corner);
        return true;
    }
    return false;
}

// The first cell, and the four infinite ones around it, in which two corners change
// places.
static void surround(struct insertion *insertion, const int32_t corner[4])
{
    for (int c = 0; c < 5; c++) {
        const int32_t added = add_cell(insertion); // may move the cells
        struct live_cell *cell = &insertion->cell[added];
        *cell = (struct live_cell){0};
        int32_t beside[4] = {1, 2, 3, 4};
        memcpy(cell->vertex, corner, sizeof cell->vertex);
        if (c > 0) {
            const int k = c - 1, a = (k + 1) % 4, b = (k + 2) % 4;
            cell->vertex[k] = INFINITE;
            beside[k] = 0;
            cell->vertex[a] = corner[b];
            cell->vertex[b] = corner[a];
            beside[a] = 1 + b;
            beside[b] = 1 + a;
        }
        memcpy(cell->neighbour, beside, sizeof cell->neighbour);
    }
    find_centres(insertion->point, insertion->box, insertion->cell,
                 (int32_t[]){0, 1, 2, 3, 4}, 5);
}

// The first point and three walls each: one cell in every corner of the box. What lies
// beyond is cell 0, which nothing takes.
static void surround_by_walls(struct insertion *insertion)
{
    for (int c = 0; c < 9; c++) {
        const int32_t added = add_cell(insertion); // may move the cells
        insertion->cell[added] = (struct live_cell){
            .vertex = {INFINITE, INFINITE, INFINITE, INFINITE}, .error = -1};
    }
    for (int corner = 0; corner < 8; corner++) {
        struct live_cell *cell = &insertion->cell[1 + corner];
        const bool turned =
            __builtin_parity((unsigned)corner); // else negatively oriented
        for (int axis = 0; axis < 3; axis++) {
            const int k = turned && axis < 2 ? 1 - axis : axis;
            cell->vertex[k] = FIRST_WALL - 2 * axis - (corner >> axis & 1);
            cell->neighbour[k] = 1 + (corner ^ 1 << axis);
        }
        cell->vertex[3] = 0;
    }
    find_centres(insertion->point, insertion->box, insertion->cell,
                 (int32_t[]){1, 2, 3, 4, 5, 6, 7, 8}, 8);
    insertion->last = 1;
}

static int32_t last_point(const struct live_cell *cell)
{
    int32_t last = cell->vertex[0];
    for (int k = 1; k < 4; k++)
        if (cell->vertex[k] > last) last = cell->vertex[k];
    return last;
}

// Whether all walls of a cell are among WALLS.
static bool is_wanted(const struct live_cell *cell, unsigned walls)
{
    for (int k = 0; k < 4; k++)
        if (cell->vertex[k] <= FIRST_WALL &&
            !(walls >> (FIRST_WALL - cell->vertex[k]) & 1))
            return false;
    return true;
}

// Puts the finite cells at no walls but WALLS in the order in which their last points
// came. Frees the cells that were.
static struct triangulation pack_cells(struct insertion *insertion, int n,
                                       unsigned walls)
{
    int32_t *number = NEW_ARRAY(int32_t, insertion->n_cell);
    int32_t *next = NEW_ARRAY(int32_t, n + 1);
    for (int c = 0; c < insertion->n_cell; c++) {
        const struct live_cell *cell = &insertion->cell[c];
        number[c] = cell->seen || cell->error < 0 || !is_wanted(cell, walls)
                        ? -1
                        : last_point(cell);
        if (number[c] >= 0) next[number[c] + 1]++;
    }
    for (int i = 0; i < n; i++)
        next[i + 1] += next[i];
    const int32_t count = next[n];
    struct cell *packed = allocate_uncleared((size_t)count, sizeof *packed);
    for (int c = 0; c < insertion->n_cell; c++)
        if (number[c] >= 0) number[c] = next[number[c]]++;
    for (int c = 0; c < insertion->n_cell; c++) {
        if (number[c] < 0) continue;
        const struct live_cell *from = &insertion->cell[c];
        struct cell *cell = &packed[number[c]];
        for (int k = 0; k < 4; k++) {
            const int32_t vertex = from->vertex[k];
            cell->vertex[k] = vertex <= FIRST_WALL ? vertex - FIRST_WALL - 1 : vertex;
            cell->neighbour[k] = number[from->neighbour[k]];
        }
    }
    free(number);
    free(next);
    free(insertion->cell);
    return (struct triangulation){.n_cell = count,
                                  .cell = packed,
                                  .n_test = insertion->n_test,
                                  .n_exact = insertion->n_exact};
}

static struct insertion insertion_begin(const struct weighted_point *point, int n,
                                        const struct wall_box *box)
{
    enum { USUAL = 1 << 10 };
    const int room = 7 * n + n / 4 + 64; // points that fill space have 6.77 a point
    struct insertion insertion = {
        .point = point,
        .box = box,
        .cell = allocate_uncleared((size_t)room, sizeof *insertion.cell),
        .cavity = NEW_ARRAY(int32_t, USUAL),
        .rim = NEW_ARRAY(struct facet, USUAL),
        .cell_capacity = room,
        .cavity_capacity = USUAL,
        .rim_capacity = USUAL};
    widen_edge_table(&insertion, USUAL);
    return insertion;
}

static void insertion_free(struct insertion *insertion)
{
    free(insertion->cavity);
    free(insertion->rim);
    free(insertion->unused);
    free(insertion->edge);
}

int triangulate(const struct weighted_point *points, int n,
                struct triangulation *triangulation)
{
    int32_t corner[4];
    if (!find_corners(points, n, corner)) return -1;
    struct insertion insertion = insertion_begin(points, n, NULL);
    surround(&insertion, corner);
    for (int32_t e = 1; e < n; e++)
        if (e != corner[0] && e != corner[1] && e != corner[2] && e != corner[3])
            insert(&insertion, e);
    *triangulation = pack_cells(&insertion, n, 0);
    insertion_free(&insertion);
    return 0;
}

struct triangulation triangulate_between(const struct weighted_point *points, int n,
                                         const struct wall_box *box, unsigned walls)
{
    struct insertion insertion = insertion_begin(points, n, box);
    surround_by_walls(&insertion);
    for (int32_t e = 1; e < n; e++)
        insert(&insertion, e);
    const struct triangulation triangulation = pack_cells(&insertion, n, walls);
    insertion_free(&insertion);
    return triangulation;
}

void triangulation_free(struct triangulation *triangulation)
{
    free(triangulation->cell);
    free(triangulation->node);
    free(triangulation->image);
    free(triangulation->seen);
    *triangulation = (struct triangulation){0};
}
