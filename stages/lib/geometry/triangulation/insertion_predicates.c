// SPDX-License-Identifier: GPL-3.0-or-later
// The two questions of an insertion: which way four points turn, and whether point e
// takes a cell away. In doubles where an error bound decides, otherwise in exact
// arithmetic (exact.h). With a, b, c from p[3] to the others,
//     orientation:  a . (c x b),  sure beyond 32 eps max|a| max|b| max|c|
// (largest components). Of a wall the vector is its normal: seen from a grain, a sphere
// without limit lies along that.
//
// takes_exactly answers, in this order:
//     seen                  yes: already in the cavity;
//     cell beyond walls     no;
//     a wall at a corner    exactly, in the limit of that sphere;
//     infinite              by the side of its finite facet; in the plane of this facet
//                           as the finite cell this side of it does;
//     mirror images         a tie, known without arithmetic;
//     else                  the exact sign of the power.
// Ties are decided by a symbolic perturbation of the weights: each is less by a little,
// by far more for each lexicographically later point (Devillers and Teillaud 2011). So
// co-spherical grains, as on lattices, always give the same cells, in any order.
#include "geometry/triangulation/exact.h"
#include "geometry/triangulation/insertion.h"

int orientation(const struct weighted_point *const p[4])
{
    const struct vector a = subtract(p[0]->at, p[3]->at),
                        b = subtract(p[1]->at, p[3]->at),
                        c = subtract(p[2]->at, p[3]->at);
    const double determinant = dot(a, cross(c, b));
    const double bound = 32 * DBL_EPSILON * largest_component(a) *
                         largest_component(b) * largest_component(c);
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
    const double bound = 32 * DBL_EPSILON * largest_component(to[0]) *
                         largest_component(to[1]) * largest_component(to[2]);
    const int turn = determinant > bound    ? 1
                     : determinant < -bound ? -1
                                            : exact_turn_between(corner, from);
    return k % 2 ? -turn : turn;
}

// That of the corners with point E in place of corner K. Only a triangulation between
// walls, which has a box, has walls among its corners.
int orientation_with(const struct insertion *insertion, const int32_t vertex[4], int k,
                     int32_t e)
{
    if (insertion->box && has_wall(vertex))
        return orientation_between(insertion, vertex, k, e);
    const struct weighted_point *p[4];
    for (int m = 0; m < 4; m++)
        p[m] = &insertion->point[m == k ? e : vertex[m]];
    return orientation(p);
}

// Lexicographic order: that of the perturbation, and so independent of the numbering.
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

// Whether two pairs among five points are mirror images of each other. Nearly all that
// exact arithmetic would be needed for where grains are reflected.
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

// For cells with a wall among their corners. Walls have no weight to perturb: a tie is
// decided by the grains alone.
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
bool takes_exactly(struct insertion *insertion, const struct live_cell *cell, int32_t e)
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
