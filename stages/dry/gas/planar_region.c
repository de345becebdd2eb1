// SPDX-License-Identifier: GPL-3.0-or-later
// Areas and lengths inside a polygonal region, without building the intersection. The
// region is the sum of the triangles (origin, side[0], side[1]) over all its sides, or
// over those of all its parts, with a negative sign where the side is seen clockwise.
// So
//     area(polygon in region) = sum of sign * area(polygon in triangle),
// and a convex polygon is clipped by the three lines of each triangle (Sutherland and
// Hodgman 1974). A line is split where it crosses sides, and each part counts if its
// middle is inside. Where the rectangle repeats, each part is seen in all repetitions
// that may reach the polygon, which is no larger than the rectangle. It moves as a
// whole: sides taken one by one at their nearest images would close no loop.
#include "planar_region.h"

#include "basics/memory.h"
#include "basics/sorted.h"

#include <math.h>
#include <stdlib.h>

static double cross_product(struct planar a, struct planar b)
{
    return a.x * b.y - a.y * b.x;
}

static struct planar difference(struct planar a, struct planar b)
{
    return (struct planar){a.x - b.x, a.y - b.y};
}

static double nearest_image(double apart, double size, bool periodic)
{
    return periodic ? size * round(apart / size) : 0;
}

// Side K seen from ORIGIN, the nearest of its images.
static void nearest_side(const struct planar_region *region, int k,
                         struct planar origin, struct planar side[2])
{
    const struct rectangle *whole = &region->rectangle;
    for (int end = 0; end < 2; end++)
        side[end] = difference(region->side[k][end], origin);
    const double x = (side[0].x + side[1].x) / 2, y = (side[0].y + side[1].y) / 2;
    const struct planar moved = {nearest_image(x, whole->size.x, whole->periodic_x),
                                 nearest_image(y, whole->size.y, whole->periodic_y)};
    for (int end = 0; end < 2; end++)
        side[end] = difference(side[end], moved);
}

// ---- sides that close loops, one after the other ------------------------------------

// Begin with {.region, .origin, .reach}. Without parts these are the sides, else those
// of each part in each repetition in which it comes nearer to ORIGIN than REACH, along
// both axes.
struct walk {
    const struct planar_region *region;
    struct planar origin;
    double reach;
    int side, part, image;
    struct planar shift;
};

enum { IMAGES = 9 }; // the repetition in which a part is nearest, and those around it

// How far what reaches from LOWER to UPPER moves to be seen in repetition IMAGE (-1, 0,
// 1), counted from where its middle is nearest to 0. False: it is too far off there.
static bool find_shift(double lower, double upper, double size, bool periodic,
                       int image, double reach, double *shift)
{
    const double middle = (lower + upper) / 2, far = (upper - lower) / 2 + reach;
    if (image && (!periodic || far < size / 2)) return false;
    *shift = periodic ? size * (image - round(middle / size)) : 0;
    return fabs(middle + *shift) <= far;
}

// Whether the walk's part counts in the walk's image.
static bool reaches(struct walk *walk)
{
    const struct rectangle *whole = &walk->region->rectangle;
    const struct planar *extent = walk->region->extent[walk->part];
    const struct planar lower = difference(extent[0], walk->origin);
    const struct planar upper = difference(extent[1], walk->origin);
    const int x = (walk->image + 1) % 3 - 1,
              y = walk->image / 3 == 2 ? -1 : walk->image / 3;
    return find_shift(lower.x, upper.x, whole->size.x, whole->periodic_x, x,
                      walk->reach, &walk->shift.x) &&
           find_shift(lower.y, upper.y, whole->size.y, whole->periodic_y, y,
                      walk->reach, &walk->shift.y);
}

// Goes on to the next part, or its next image, that counts. False: there is none.
static bool find_part(struct walk *walk)
{
    for (; walk->part < walk->region->n_part; walk->part++, walk->image = 0)
        for (; walk->image < IMAGES; walk->image++)
            if (reaches(walk)) return true;
    return false;
}

// The next SIDE, seen from the origin. False: there is none.
static bool next_side(struct walk *walk, struct planar side[2])
{
    const struct planar_region *region = walk->region;
    if (region->n_part == 0) {
        if (walk->side == region->n_side) return false;
        for (int end = 0; end < 2; end++)
            side[end] = difference(region->side[walk->side][end], walk->origin);
        walk->side++;
        return true;
    }
    if (walk->side == 0 && !find_part(walk)) return false;
    const int begin = region->part_offset[walk->part];
    const int n = region->part_offset[walk->part + 1] - begin;
    for (int end = 0; end < 2; end++) {
        const struct planar at =
            difference(region->corner[begin + (walk->side + end) % n], walk->origin);
        side[end] = (struct planar){at.x + walk->shift.x, at.y + walk->shift.y};
    }
    walk->side = (walk->side + 1) % n;
    walk->image += walk->side == 0;
    return true;
}

// ---- polygons and lines -------------------------------------------------------------

static double polygon_area(const struct planar *corner, int n)
{
    double twice = 0;
    for (int k = 0; k < n; k++)
        twice += cross_product(corner[k], corner[(k + 1) % n]);
    return twice / 2;
}

// Writes the part of the polygon left of the line from A to B to KEPT, which needs room
// for one corner more. Returns the number of its corners.
static int cut_left(const struct planar *corner, int n, struct planar a,
                    struct planar b, struct planar *kept)
{
    const struct planar along = difference(b, a);
    int m = 0;
    for (int k = 0; k < n; k++) {
        const struct planar from = corner[k], to = corner[(k + 1) % n];
        const double here = cross_product(along, difference(from, a));
        const double there = cross_product(along, difference(to, a));
        if (here >= 0) kept[m++] = from;
        if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
            const double t = here / (here - there);
            kept[m++] = (struct planar){from.x + t * (to.x - from.x),
                                        from.y + t * (to.y - from.y)};
        }
    }
    return m;
}

// Area of the part of the polygon in the triangle (origin, A, B), counter-clockwise.
// SCRATCH has room for 2 (n + 3) corners.
static double area_in_triangle(const struct planar *corner, int n, struct planar a,
                               struct planar b, struct planar *scratch)
{
    const struct planar origin = {0, 0};
    struct planar *other = scratch + n + 3;
    n = cut_left(corner, n, origin, a, scratch);
    n = cut_left(scratch, n, b, origin, other);
    n = cut_left(other, n, a, b, scratch);
    return polygon_area(scratch, n);
}

double area_in_region(const struct planar_region *region, struct planar origin,
                      const struct planar *corner, int n)
{
    if (region->n_side == 0) return polygon_area(corner, n);
    double area = 0;
    struct planar *scratch = NEW_ARRAY(struct planar, 2 * (n + 3));
    struct walk walk = {.region = region, .origin = origin};
    for (int k = 0; k < n; k++)
        walk.reach = fmax(walk.reach, hypot(corner[k].x, corner[k].y));
    for (struct planar side[2]; next_side(&walk, side);) {
        const bool forward = cross_product(side[0], side[1]) > 0;
        area += (forward ? 1 : -1) *
                area_in_triangle(corner, n, side[!forward], side[forward], scratch);
    }
    free(scratch);
    return area;
}

// By the winding number: sides that cross the ray from AT along +x upwards count +1,
// downwards -1.
static bool is_in_region(const struct planar_region *region, struct planar origin,
                         struct planar at)
{
    if (region->n_side == 0) return true;
    int inside = 0;
    struct walk walk = {.region = region, .origin = origin, .reach = hypot(at.x, at.y)};
    for (struct planar side[2]; next_side(&walk, side);) {
        const struct planar a = difference(side[0], at), b = difference(side[1], at);
        if ((a.y > 0) == (b.y > 0)) continue;
        const bool upwards = b.y > 0;
        if ((cross_product(a, b) > 0) == upwards) inside += upwards ? 1 : -1;
    }
    return inside > 0;
}

double length_in_region(const struct planar_region *region, struct planar origin,
                        struct planar from, struct planar to)
{
    const struct planar along = difference(to, from);
    double *crossing = NULL;
    int n = 0, capacity = 0;
    GROW_ARRAY(crossing, n, capacity);
    crossing[n++] = 0;
    struct walk walk = {.region = region,
                        .origin = origin,
                        .reach = fmax(hypot(from.x, from.y), hypot(to.x, to.y))};
    for (struct planar side[2]; next_side(&walk, side);) {
        const double a = cross_product(along, difference(side[0], from));
        const double b = cross_product(along, difference(side[1], from));
        if ((a > 0) == (b > 0)) continue;
        const struct planar way = difference(side[1], side[0]);
        const double t =
            cross_product(difference(side[0], from), way) / cross_product(along, way);
        if (!(t > 0 && t < 1)) continue;
        GROW_ARRAY(crossing, n, capacity);
        crossing[n++] = t;
    }
    GROW_ARRAY(crossing, n, capacity);
    crossing[n++] = 1;
    qsort(crossing, (size_t)n, sizeof *crossing, rising_doubles);
    double share = 0;
    for (int k = 0; k + 1 < n; k++) {
        const double middle = (crossing[k] + crossing[k + 1]) / 2;
        const struct planar at = {from.x + middle * along.x, from.y + middle * along.y};
        if (is_in_region(region, origin, at)) share += crossing[k + 1] - crossing[k];
    }
    free(crossing);
    return share * hypot(along.x, along.y);
}

bool region_holds(const struct planar_region *region, struct planar origin,
                  double distance)
{
    for (int k = 0; k < region->n_side; k++) {
        struct planar side[2];
        nearest_side(region, k, origin, side);
        const struct planar way = difference(side[1], side[0]);
        const double square = way.x * way.x + way.y * way.y;
        const double t = -(side[0].x * way.x + side[0].y * way.y) / square;
        const double nearest = square > 0 ? fmin(fmax(t, 0), 1) : 0;
        if (hypot(side[0].x + nearest * way.x, side[0].y + nearest * way.y) < distance)
            return false;
    }
    // Any point of the disc tells, but one on the rim of a part might count for none.
    return is_in_region(region, origin,
                        (struct planar){0.309017 * distance, 0.207107 * distance});
}

void planar_region_free(struct planar_region *region)
{
    free(region->side);
    free(region->part_offset);
    free(region->corner);
    free(region->extent);
    *region = (struct planar_region){0};
}
