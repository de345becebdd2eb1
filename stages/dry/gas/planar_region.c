// SPDX-License-Identifier: GPL-3.0-or-later
// Areas and lengths inside a polygonal region, without building the intersection. The
// region is the sum of the triangles (origin, side[0], side[1]) over all its sides,
// with a negative sign where the side is seen clockwise. So
//     area(polygon in region) = sum of sign * area(polygon in triangle),
// and a convex polygon is clipped by the three lines of each triangle (Sutherland and
// Hodgman 1974). A line is split where it crosses sides, and each part counts if its
// middle is inside. Sides are taken at their periodic image nearest to the origin,
// which is right for polygons smaller than half the rectangle.
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
static void find_side(const struct planar_region *region, int k, struct planar origin,
                      struct planar side[2])
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

// The winding number far from all sides: 1 where the loops surround what is missing.
static int far_away(const struct planar_region *region)
{
    const struct rectangle *whole = &region->rectangle;
    return region->n_side == 0 || whole->periodic_x || whole->periodic_y;
}

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
    double area = far_away(region) ? polygon_area(corner, n) : 0;
    struct planar *scratch = NEW_ARRAY(struct planar, 2 * (n + 3));
    for (int k = 0; k < region->n_side; k++) {
        struct planar side[2];
        find_side(region, k, origin, side);
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
    int inside = far_away(region);
    for (int k = 0; k < region->n_side; k++) {
        struct planar side[2];
        find_side(region, k, origin, side);
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
    double *crossing = NEW_ARRAY(double, region->n_side + 2);
    int n = 0;
    crossing[n++] = 0;
    for (int k = 0; k < region->n_side; k++) {
        struct planar side[2];
        find_side(region, k, origin, side);
        const double a = cross_product(along, difference(side[0], from));
        const double b = cross_product(along, difference(side[1], from));
        if ((a > 0) == (b > 0)) continue;
        const struct planar way = difference(side[1], side[0]);
        const double t =
            cross_product(difference(side[0], from), way) / cross_product(along, way);
        if (t > 0 && t < 1) crossing[n++] = t;
    }
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
        find_side(region, k, origin, side);
        const struct planar way = difference(side[1], side[0]);
        const double square = way.x * way.x + way.y * way.y;
        const double t = -(side[0].x * way.x + side[0].y * way.y) / square;
        const double nearest = square > 0 ? fmin(fmax(t, 0), 1) : 0;
        if (hypot(side[0].x + nearest * way.x, side[0].y + nearest * way.y) < distance)
            return false;
    }
    return is_in_region(region, origin, (struct planar){0, 0});
}

void planar_region_free(struct planar_region *region)
{
    free(region->side);
    *region = (struct planar_region){0};
}
