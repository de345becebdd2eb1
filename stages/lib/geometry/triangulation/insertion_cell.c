// SPDX-License-Identifier: GPL-3.0-or-later
// Power centres of cells, four cells at a time. With rows r_k from the last vertex to
// the other three and weights w, the centre c (relative to the last vertex) solves
//     2 r_k.c = |r_k|^2 - w_k + w_last,
// by Cramer's rule: c = sum of right_k across_k / determinant, with right_k half of the
// right side and across_k = r_k+1 x r_k+2. At a wall the row is its outward normal and
// right_k the distance to its plane, for the centre is on the wall.
//
// `error` bounds the rounding of each coordinate. With size_k the largest component of
// r_k and terms_k = |r_k|^2 + |w_last - w_k|,
//     slack = 16 eps size_0 size_1 size_2                (error of the determinant)
//     error = (8 eps sum of terms_k size_k+1 size_k+2 + far slack)
//             / (|determinant| - slack)  + 8 eps far,    far = largest of |c|.
// Where the determinant is at most 2 slack, mere rounding, it is infinite, and takes()
// asks exact arithmetic. Infinite cells have no centre: their error is -1.
#include "geometry/triangulation/insertion_cell.h"

#include "basics/simd.h"

#include <float.h>

struct vector_of_four {
    double4 x, y, z;
};

static inline double4 larger(double4 x, double4 y)
{
    const mask4 first = x > y;
    return (double4)((first & (mask4)x) | (~first & (mask4)y));
}

static inline double4 largest(struct vector_of_four v)
{
    return larger(larger(magnitude(v.x), magnitude(v.y)), magnitude(v.z));
}

static inline double4 dot_of_four(struct vector_of_four a, struct vector_of_four b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector_of_four cross_of_four(struct vector_of_four a,
                                                  struct vector_of_four b)
{
    return (struct vector_of_four){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                                   a.x * b.y - a.y * b.x};
}

// Vertex K of each, from FROM, and its weight.
static inline struct vector_of_four vertices(const struct weighted_point *point,
                                             struct live_cell *const cell[4], int k,
                                             struct vector_of_four from,
                                             double4 *weight)
{
    const struct weighted_point *p[4];
    for (int lane = 0; lane < 4; lane++)
        p[lane] = &point[cell[lane]->vertex[k]];
    *weight = (double4){p[0]->weight, p[1]->weight, p[2]->weight, p[3]->weight};
    return (struct vector_of_four){
        (double4){p[0]->at.x, p[1]->at.x, p[2]->at.x, p[3]->at.x} - from.x,
        (double4){p[0]->at.y, p[1]->at.y, p[2]->at.y, p[3]->at.y} - from.y,
        (double4){p[0]->at.z, p[1]->at.z, p[2]->at.z, p[3]->at.z} - from.z};
}

// No lane sees another, so a centre does not depend on which cells it is found with.
// The bound is generous.
static void find_four_centres(const struct weighted_point *point,
                              struct live_cell *const cell[4])
{
    double4 weight[4], right[3], terms[3], size[3], error = {0};
    const struct vector_of_four origin = {0},
                                last = vertices(point, cell, 3, origin, &weight[3]);
    struct vector_of_four row[3], centre = {0};
    for (int k = 0; k < 3; k++) {
        row[k] = vertices(point, cell, k, last, &weight[k]);
        const double4 square = dot_of_four(row[k], row[k]),
                      lighter = weight[3] - weight[k];
        right[k] = 0.5 * (square + lighter);
        terms[k] = square + magnitude(lighter);
        size[k] = largest(row[k]);
    }
    const struct vector_of_four across[3] = {cross_of_four(row[1], row[2]),
                                             cross_of_four(row[2], row[0]),
                                             cross_of_four(row[0], row[1])};
    for (int k = 0; k < 3; k++) {
        centre.x += right[k] * across[k].x;
        centre.y += right[k] * across[k].y;
        centre.z += right[k] * across[k].z;
        error += terms[k] * size[(k + 1) % 3] * size[(k + 2) % 3];
    }
    const double4 determinant = dot_of_four(row[0], across[0]),
                  one_over = 1 / determinant;
    const double4 slack = 16 * DBL_EPSILON * size[0] * size[1] * size[2];
    centre = (struct vector_of_four){one_over * centre.x, one_over * centre.y,
                                     one_over * centre.z};
    const double4 far = largest(centre);
    error = 1.01 * (8 * DBL_EPSILON * error + far * slack) /
                (magnitude(determinant) - slack) +
            8 * DBL_EPSILON * far;
    const mask4 flat = magnitude(determinant) <= 2 * slack;
    for (int lane = 0; lane < 4; lane++) {
        cell[lane]->at = flat[lane] ? (struct vector){0}
                                    : (struct vector){centre.x[lane], centre.y[lane],
                                                      centre.z[lane]};
        cell[lane]->error = flat[lane] ? INFINITY : (float)error[lane];
    }
}

// One negative vertex, which may be a wall, gives the bits of all four their sign.
static bool is_infinite(const struct live_cell *cell)
{
    return (cell->vertex[0] | cell->vertex[1] | cell->vertex[2] | cell->vertex[3]) < 0;
}

// The same for one cell with walls; there are few of them, so they go one by one.
static void find_walled_centre(const struct weighted_point *point,
                               const struct wall_box *box, struct live_cell *cell)
{
    const struct weighted_point *last = &point[cell->vertex[3]];
    struct vector row[3];
    double right[3], terms[3], size[3], error = 0;
    for (int k = 0; k < 3; k++) {
        if (cell->vertex[k] < 0) {
            const struct corner_between wall = wall_corner(box, cell->vertex[k]);
            row[k] = (struct vector){0};
            set_component(&row[k], wall.axis, wall.sign);
            right[k] = wall.sign * (wall.plane - component(last->at, wall.axis));
            terms[k] = 2 * right[k];
        } else {
            const struct weighted_point *p = &point[cell->vertex[k]];
            row[k] = subtract(p->at, last->at);
            const double square = dot(row[k], row[k]),
                         lighter = last->weight - p->weight;
            right[k] = 0.5 * (square + lighter);
            terms[k] = square + fabs(lighter);
        }
        size[k] = fmax(fabs(row[k].x), fmax(fabs(row[k].y), fabs(row[k].z)));
    }
    const struct vector across[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                     cross(row[0], row[1])};
    struct vector centre = {0};
    for (int k = 0; k < 3; k++) {
        centre = add(centre, scale(right[k], across[k]));
        error += terms[k] * size[(k + 1) % 3] * size[(k + 2) % 3];
    }
    const double determinant = dot(row[0], across[0]);
    const double slack = 16 * DBL_EPSILON * size[0] * size[1] * size[2];
    centre = scale(1 / determinant, centre);
    const double far = fmax(fabs(centre.x), fmax(fabs(centre.y), fabs(centre.z)));
    const bool flat = fabs(determinant) <= 2 * slack;
    error =
        1.01 * (8 * DBL_EPSILON * error + far * slack) / (fabs(determinant) - slack) +
        8 * DBL_EPSILON * far;
    cell->at = flat ? (struct vector){0} : centre;
    cell->error = flat ? INFINITY : (float)error;
}

static bool has_walls(const struct live_cell *cell)
{
    return cell->vertex[0] <= FIRST_WALL || cell->vertex[1] <= FIRST_WALL ||
           cell->vertex[2] <= FIRST_WALL;
}

// Cells without walls and infinite vertex are gathered by four. A rest of one to three
// is filled up with its first cell, which is then found more than once, alike.
void find_centres(const struct weighted_point *point, const struct wall_box *box,
                  struct live_cell *cells, const int32_t *which, int count)
{
    struct live_cell *cell[4] = {cells, cells, cells, cells};
    int n = 0;
    for (int k = 0; k < count; k++) {
        cell[n] = &cells[which[k]];
        cell[n]->error = -1;
        if (box && has_walls(cell[n]))
            find_walled_centre(point, box, cell[n]);
        else
            n += !is_infinite(cell[n]);
        if (n == 4) find_four_centres(point, cell);
        n %= 4;
    }
    if (!n) return;
    for (int lane = n; lane < 4; lane++)
        cell[lane] = cell[0];
    find_four_centres(point, cell);
}
