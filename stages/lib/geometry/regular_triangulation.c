// SPDX-License-Identifier: GPL-3.0-or-later
// Incremental insertion [Bowyer 1981, Watson 1981]: each point in turn takes away the
// cells whose spheres it lies in, and is joined to the rim of the cavity they leave.
#include "geometry/regular_triangulation.h"

#include "basics/memory.h"
#include "geometry/exact.h"
#include "geometry/live_cell.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { NOWHERE = -2 };

// A facet between a cell that goes and one that stays. Its vertices come so that with
// the new point they are positively oriented.
struct facet {
    int32_t vertex[3];
    int32_t beyond; // the cell that stays
    int32_t back;   // its neighbour across the facet
};

// An entry of a hash table of the directed edges of the rim; those of other points than
// the one being inserted count as empty.
struct edge {
    int32_t from, to;
    int32_t inserted;
    int32_t cell;
};

struct insertion {
    const struct weighted_point *point;
    const struct wall_box *box; // NULL: no walls
    struct live_cell *cell;
    int32_t *cavity; // cells
    struct facet *rim;
    int32_t *unused; // cells
    struct edge *edge;
    int n_cell, cell_capacity;
    int n_cavity, cavity_capacity;
    int n_rim, rim_capacity;
    int n_unused, unused_capacity;
    uint32_t edge_mask; // length of the table, a power of two, less one
    int32_t last;       // a cell made last
    int64_t n_test, n_exact;
};

// ---- predicates ---------------------------------------------------------------------

static double largest(struct vector v)
{
    const double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
    const double more = x > y ? x : y;
    return more > z ? more : z;
}

static int orientation(const struct weighted_point *const p[4])
{
    const struct vector a = subtract(p[0]->at, p[3]->at),
                        b = subtract(p[1]->at, p[3]->at),
                        c = subtract(p[2]->at, p[3]->at);
    const double determinant = dot(a, cross(c, b));
    const double bound = 32 * DBL_EPSILON * largest(a) * largest(b) * largest(c);
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
    return exact_orientation(p);
}

static bool has_wall(const int32_t vertex[4])
{
    return vertex[0] <= FIRST_WALL || vertex[1] <= FIRST_WALL ||
           vertex[2] <= FIRST_WALL || vertex[3] <= FIRST_WALL;
}

static struct corner_between corner_of(const struct insertion *insertion,
                                       int32_t vertex)
{
    if (vertex <= FIRST_WALL) return wall_corner(insertion->box, vertex);
    return (struct corner_between){.point = &insertion->point[vertex]};
}

// Seen from E, a wall lies along its normal.
static int orientation_between(const struct insertion *insertion,
                               const int32_t vertex[4], int k, int32_t e)
{
    const struct weighted_point *from = &insertion->point[e];
    struct corner_between corner[3];
    struct vector to[3] = {{0}};
    for (int m = 0, n = 0; m < 4; m++) {
        if (m == k) continue;
        corner[n] = corner_of(insertion, vertex[m]);
        if (corner[n].point)
            to[n] = subtract(corner[n].point->at, from->at);
        else
            set_component(&to[n], corner[n].axis, corner[n].sign);
        n++;
    }
    const double determinant = dot(to[0], cross(to[1], to[2]));
    const double bound =
        32 * DBL_EPSILON * largest(to[0]) * largest(to[1]) * largest(to[2]);
    const int turn = determinant > bound    ? 1
                     : determinant < -bound ? -1
                                            : exact_turn_between(corner, from);
    return k % 2 ? -turn : turn;
}

// With point E in place of corner K.
static int orientation_with(const struct insertion *insertion, const int32_t vertex[4],
                            int k, int32_t e)
{
    if (insertion->box && has_wall(vertex))
        return orientation_between(insertion, vertex, k, e);
    const struct weighted_point *p[4];
    for (int m = 0; m < 4; m++)
        p[m] = &insertion->point[m == k ? e : vertex[m]];
    return orientation(p);
}

static bool comes_before(struct vector a, struct vector b)
{
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

// Whether E is in the sphere of a cell that it lies on, once each weight is less by a
// little that is more by far for each lexicographically later point [Devillers and
// Teillaud 2011].
static bool takes_perturbed(const struct insertion *insertion, const int32_t vertex[4],
                            int32_t e)
{
    const struct weighted_point *point = insertion->point;
    int order[5], n = 0;
    for (int k = 0; k < 5; k++) {
        if (k < 4 && vertex[k] < 0) continue; // walls stay as they are
        int to = n++;
        for (; to > 0 && comes_before(point[k < 4 ? vertex[k] : e].at,
                                      point[vertex[order[to - 1]]].at);
             to--)
            order[to] = order[to - 1];
        order[to] = k;
    }
    for (int k = n - 1; k >= 0 && order[k] < 4; k--) {
        const int turn = orientation_with(insertion, vertex, order[k], e);
        if (turn) return turn > 0;
    }
    return false;
}

// Whether a wall across an axis mirrors A to B and C to D: then the four lie on a
// circle, and any fifth on a sphere with them.
static bool mirror(const struct weighted_point *a, const struct weighted_point *b,
                   const struct weighted_point *c, const struct weighted_point *d)
{
    if (a->weight != b->weight || c->weight != d->weight) return false;
    const struct vector apart = subtract(a->at, b->at), other = subtract(c->at, d->at);
    const int axis = apart.x != 0 ? 0 : apart.y != 0 ? 1 : 2;
    for (int k = 0; k < 3; k++)
        if (k != axis && (component(apart, k) != 0 || component(other, k) != 0))
            return false;
    return component(a->at, axis) + component(b->at, axis) ==
           component(c->at, axis) + component(d->at, axis);
}

// Nearly all that exact arithmetic would be needed for where grains are reflected.
static bool is_mirrored(const struct weighted_point *const p[5])
{
    for (int without = 0; without < 5; without++) {
        const struct weighted_point *q[4];
        for (int k = 0; k < 4; k++)
            q[k] = p[k + (k >= without)];
        if (mirror(q[0], q[1], q[2], q[3]) || mirror(q[0], q[2], q[1], q[3]) ||
            mirror(q[0], q[3], q[1], q[2]))
            return true;
    }
    return false;
}

static bool takes(struct insertion *insertion, const struct live_cell *cell, int32_t e);

static bool takes_between(struct insertion *insertion, const int32_t vertex[4],
                          int32_t e)
{
    struct corner_between corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = corner_of(insertion, vertex[k]);
    insertion->n_exact++;
    const int side = exact_side_between(corner, &insertion->point[e]);
    return side ? side > 0 : takes_perturbed(insertion, vertex, e);
}

// When rounding could decide, and for infinite cells: they take what lies beyond their
// finite facet and, in its plane, what the cell this side of it takes.
static __attribute__((noinline)) bool
takes_exactly(struct insertion *insertion, const struct live_cell *cell, int32_t e)
{
    if (cell->seen) return true;
    const int32_t *vertex = cell->vertex;
    if (insertion->box) {
        if (vertex[0] == INFINITE) return false;
        if (has_wall(vertex)) return takes_between(insertion, vertex, e);
    }
    for (int k = 0; k < 4; k++) {
        if (vertex[k] != INFINITE) continue;
        const int turn = orientation_with(insertion, vertex, k, e);
        if (turn) return turn > 0;
        return takes(insertion, &insertion->cell[cell->neighbour[k]], e);
    }
    const struct weighted_point *p[5];
    for (int k = 0; k < 5; k++)
        p[k] = &insertion->point[k < 4 ? vertex[k] : e];
    if (is_mirrored(p)) return takes_perturbed(insertion, vertex, e);
    insertion->n_exact++;
    const int side = exact_power_side(p);
    return side ? side > 0 : takes_perturbed(insertion, vertex, e);
}

// Whether point E takes a cell away: whether it has less power to the cell's centre
// than the vertices have.
static inline bool takes(struct insertion *insertion, const struct live_cell *cell,
                         int32_t e)
{
    const bool infinite = cell->error < 0;
    const struct weighted_point *p = &insertion->point[e];
    const struct weighted_point *last =
        &insertion->point[infinite ? e : cell->vertex[3]];
    const struct vector to = subtract(p->at, last->at);
    const double square = dot(to, to), lighter = last->weight - p->weight;
    const double power = square + lighter - 2 * dot(to, cell->at);
    const double bound =
        2 * (double)cell->error * (fabs(to.x) + fabs(to.y) + fabs(to.z)) +
        8 * DBL_EPSILON * (square + fabs(lighter));
    if (__builtin_expect(infinite || !(fabs(power) > bound), 0))
        return takes_exactly(insertion, cell, e);
    return power < 0;
}

// ---- one point ----------------------------------------------------------------------

// The cell that point E is in: from the last, across facets that it is beyond. Such
// walks end in regular triangulations.
static int32_t locate(const struct insertion *insertion, int32_t e)
{
    int32_t at = insertion->last, before = NOWHERE;
    for (;;) {
        const struct live_cell *cell = &insertion->cell[at];
        int k = 0;
        if (cell->error <
            0) { // infinite: stay, or start from the finite cell beside it
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
        struct live_cell *cell = &insertion->cell[add_cell(insertion)];
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
    for (int c = 0; c < 9; c++)
        insertion->cell[add_cell(insertion)] = (struct live_cell){
            .vertex = {INFINITE, INFINITE, INFINITE, INFINITE}, .error = -1};
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

// The bits of X, two zeros between each.
static uint64_t spread(uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

// Eight rounds: each point has a chance of 7/8 to come in the last, else of 7/8 to come
// in the one before.
static uint64_t draw_round(int i)
{
    uint64_t x = ((uint64_t)i + 1) * 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    x ^= x >> 31;
    return 7 - (uint64_t)__builtin_ctzll(x | 1 << 21) / 3;
}

struct turn {
    uint64_t when;
    int32_t point;
};

// By radix, from the lowest digit up: those of one time stay in order.
static struct turn *sort_turns(struct turn *turns, int n, int bits)
{
    enum { DIGIT = 12, DIGITS = 1 << DIGIT };
    struct turn *sorted = NEW_ARRAY(struct turn, n);
    for (int shift = 0; shift < bits; shift += DIGIT) {
        int begin[DIGITS + 1] = {0};
        for (int i = 0; i < n; i++)
            begin[(turns[i].when >> shift) % DIGITS + 1]++;
        for (int digit = 1; digit < DIGITS; digit++)
            begin[digit] += begin[digit - 1];
        for (int i = 0; i < n; i++)
            sorted[begin[(turns[i].when >> shift) % DIGITS]++] = turns[i];
        struct turn *other = turns;
        turns = sorted;
        sorted = other;
    }
    free(sorted);
    return turns;
}

// Biased randomised insertion order [Amenta, Choi and Rote 2003]: rounds of random
// points, each along a Z-curve, so that cavities stay small and what comes next is
// near.
int32_t *insertion_order(const struct vector *points, int n)
{
    enum { BITS = 18, ROUND_BITS = 3 };
    struct vector lower = points[0], upper = points[0];
    for (int i = 1; i < n; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(points[i], axis);
            if (x < component(lower, axis)) set_component(&lower, axis, x);
            if (x > component(upper, axis)) set_component(&upper, axis, x);
        }
    const double extent = largest(subtract(upper, lower));
    const double cells = extent > 0 ? ((1 << BITS) - 1) / extent : 0;
    struct turn *turns = NEW_ARRAY(struct turn, n);
    for (int i = 0; i < n; i++) {
        turns[i] = (struct turn){draw_round(i) << 3 * BITS, i};
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(points[i], axis) - component(lower, axis);
            turns[i].when |= spread((uint64_t)(x * cells)) << axis;
        }
    }
    turns = sort_turns(turns, n, 3 * BITS + ROUND_BITS);
    int32_t *order = NEW_ARRAY(int32_t, n);
    for (int k = 0; k < n; k++)
        order[k] = turns[k].point;
    free(turns);
    return order;
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
