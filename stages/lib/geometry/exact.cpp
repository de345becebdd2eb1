// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's exact numbers, for the signs that rounding must not decide.
#include "geometry/exact.h"

#define CGAL_NDEBUG
#define CGAL_HAS_NO_THREADS // looking up what each thread has of its own costs time
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const struct vector &p)
{
    return {p.x, p.y, p.z};
}

Kernel::Weighted_point_3 weighted(const struct weighted_point *p)
{
    return {point(p->at), p->weight};
}

} // namespace

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
