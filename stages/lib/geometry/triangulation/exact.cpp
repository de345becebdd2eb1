// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's exact numbers, for the signs that rounding must not decide.
#include "geometry/triangulation/exact.h"

#define CGAL_NDEBUG
// Looking up what each thread has of its own costs time. Threads may call these functions
// all the same: exact numbers count their users without locks, but no call shares one.
#define CGAL_HAS_NO_THREADS
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Number = CGAL::Exact_rational;

Kernel::Point_3 point(const struct vector &p)
{
    return {p.x, p.y, p.z};
}

Kernel::Weighted_point_3 weighted(const struct weighted_point *p)
{
    return {point(p->at), p->weight};
}

// A row of a predicate's determinant, from E. That of a wall is divided by the radius
// that goes to infinity: (x, y, z, x^2 - w) / R becomes the normal and twice its
// distance.
struct Row {
    Number x[3], power;
};

Row row(const struct corner_between &corner, const struct weighted_point *e)
{
    const double from[3] = {e->at.x, e->at.y, e->at.z};
    Row row = {{0, 0, 0}, 0};
    if (!corner.point) {
        row.x[corner.axis] = corner.sign;
        row.power = 2 * corner.sign * (Number(corner.plane) - from[corner.axis]);
        return row;
    }
    const struct vector &at = corner.point->at;
    const double to[3] = {at.x, at.y, at.z};
    for (int axis = 0; axis < 3; axis++) {
        row.x[axis] = Number(to[axis]) - from[axis];
        row.power += row.x[axis] * row.x[axis];
    }
    row.power += Number(e->weight) - corner.point->weight;
    return row;
}

Number determinant(const Row &a, const Row &b, const Row &c)
{
    return CGAL::determinant(a.x[0], a.x[1], a.x[2], b.x[0], b.x[1], b.x[2], c.x[0],
                             c.x[1], c.x[2]);
}

} // namespace

extern "C" int exact_turn_between(const struct corner_between corner[3],
                                  const struct weighted_point *e)
{
    return CGAL::sign(
        determinant(row(corner[0], e), row(corner[1], e), row(corner[2], e)));
}

extern "C" int exact_side_between(const struct corner_between corner[4],
                                  const struct weighted_point *e)
{
    const Row r[4] = {row(corner[0], e), row(corner[1], e), row(corner[2], e),
                      row(corner[3], e)};
    const Number sum = r[0].power * determinant(r[1], r[2], r[3]) -
                       r[1].power * determinant(r[0], r[2], r[3]) +
                       r[2].power * determinant(r[0], r[1], r[3]) -
                       r[3].power * determinant(r[0], r[1], r[2]);
    return CGAL::sign(sum);
}

extern "C" bool exact_collinear(const struct vector *a, const struct vector *b,
                                const struct vector *c)
{
    return CGAL::collinear(point(*a), point(*b), point(*c));
}

extern "C" int exact_orientation(const struct weighted_point *const p[4])
{
    return CGAL::orientation(point(p[0]->at), point(p[1]->at), point(p[2]->at),
                             point(p[3]->at));
}

extern "C" int exact_power_side(const struct weighted_point *const p[5])
{
    return Kernel().power_side_of_oriented_power_sphere_3_object()(
        weighted(p[0]), weighted(p[1]), weighted(p[2]), weighted(p[3]), weighted(p[4]));
}

extern "C" struct vector exact_power_centre(const struct weighted_point *const p[4])
{
    using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
    const auto exactly = [&](int k) {
        const struct vector &at = p[k]->at;
        return Exact::Weighted_point_3(Exact::Point_3(at.x, at.y, at.z), p[k]->weight);
    };
    const Exact::Point_3 centre = Exact().construct_weighted_circumcenter_3_object()(
        exactly(0), exactly(1), exactly(2), exactly(3));
    return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()),
            CGAL::to_double(centre.z())};
}
