// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's regular triangulation, with predicates that know walls.
#include "geometry/walled_triangulation.h"

// Its own checks of what it does cost a fifth of the time.
#define CGAL_NDEBUG
#define CGAL_HAS_NO_THREADS // and so does looking up what each thread has of its own
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;

template <class Traits>
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<
    int, Traits, CGAL::Regular_triangulation_vertex_base_3<Traits>>;
template <class Traits>
using CellBase = CGAL::Triangulation_cell_base_with_info_3<
    int, Traits, CGAL::Regular_triangulation_cell_base_3<Traits>>;
template <class Traits>
using Triangulation = CGAL::Regular_triangulation_3<
    Traits, CGAL::Triangulation_data_structure_3<VertexBase<Traits>, CellBase<Traits>>>;

// ---- walls --------------------------------------------------------------------------

// A wall is a sphere that touches the box from outside, of a radius R that no double
// can add to a place in the box. Doubles hold the place of its centre as if the box
// were a point; predicates that see a wall put the box back, in rational numbers.
const double huge = 0x1p100;

bool is_wall(double coordinate)
{
    return std::abs(coordinate) == huge;
}

template <class Point>
bool is_wall(const Point &p)
{
    return is_wall(p.x()) || is_wall(p.y()) || is_wall(p.z());
}

// Takes points and weighted points to rational numbers.
struct Widen {
    using Number = Exact::FT;
    const double *upper;

    Number coordinate(double x, int axis) const
    {
        return x == huge ? Number(huge) + Number(upper[axis]) : Number(x);
    }
    Exact::Point_3 operator()(const Kernel::Point_3 &p) const
    {
        return {coordinate(p.x(), 0), coordinate(p.y(), 1), coordinate(p.z(), 2)};
    }
    Exact::Weighted_point_3 operator()(const Kernel::Weighted_point_3 &p) const
    {
        return {(*this)(p.point()),
                is_wall(p) ? Number(huge) * Number(huge) : Number(p.weight())};
    }
};

// Nearly always the limit of infinite R tells, in which a predicate's determinant has
// the row (x, y, z, x^2 - w, 1) / R of a wall at (normal, twice its place along it, 0).
// Rows are taken from grain G, which leaves one row and column fewer.
using Interval = CGAL::Interval_nt_advanced;
struct Row {
    Interval x, y, z, power;
};

struct Limit {
    const double *upper;

    Row row(const Kernel::Point_3 &p, const Kernel::Point_3 &from) const
    {
        const Interval x = Interval(p.x()) - from.x(), y = Interval(p.y()) - from.y(),
                       z = Interval(p.z()) - from.z();
        if (!is_wall(p))
            return {x, y, z, CGAL::square(x) + CGAL::square(y) + CGAL::square(z)};
        const double c[3] = {p.x(), p.y(), p.z()},
                     at[3] = {from.x(), from.y(), from.z()};
        const int axis = is_wall(c[0]) ? 0 : is_wall(c[1]) ? 1 : 2;
        Interval normal[3] = {0, 0, 0};
        normal[axis] = c[axis] > 0 ? 1 : -1;
        const Interval place =
            c[axis] > 0 ? Interval(upper[axis]) - at[axis] : Interval(at[axis]);
        return {normal[0], normal[1], normal[2], Interval(2) * place};
    }
    Row row(const Kernel::Weighted_point_3 &p,
            const Kernel::Weighted_point_3 &from) const
    {
        Row row = this->row(p.point(), from.point());
        if (!is_wall(p)) row.power += Interval(from.weight()) - p.weight();
        return row;
    }
    // Sign of the determinant, or 0 when it is not surely larger than what terms of
    // 1/R could add.
    static int sign(const Interval &determinant, int g)
    {
        const double least = 0x1p-80;
        const int sign = determinant.inf() > least    ? 1
                         : determinant.sup() < -least ? -1
                                                      : 0;
        return g % 2 ? -sign : sign;
    }
    static Interval determinant(const Row (&r)[3])
    {
        return CGAL::determinant(r[0].x, r[0].y, r[0].z, r[1].x, r[1].y, r[1].z, r[2].x,
                                 r[2].y, r[2].z);
    }
    static Interval determinant(const Row (&r)[4])
    {
        return -CGAL::determinant(r[0].x, r[0].y, r[0].z, r[0].power, r[1].x, r[1].y,
                                  r[1].z, r[1].power, r[2].x, r[2].y, r[2].z,
                                  r[2].power, r[3].x, r[3].y, r[3].z, r[3].power);
    }
    // Orientation of four points, or power side of five (positive: inside); 0 when it
    // cannot tell.
    template <class... Point>
    int operator()(const Point &...p) const
    {
        const CGAL::Protect_FPU_rounding<true> rounding;
        constexpr int count = sizeof...(p);
        const std::common_type_t<Point...> point[count] = {p...};
        int g = 0;
        while (g < count && is_wall(point[g]))
            g++;
        if (g == count) return 0;
        Row rows[count - 1];
        for (int k = 0, next = 0; k < count; k++)
            if (k != g) rows[next++] = row(point[k], point[g]);
        return sign(determinant(rows), g);
    }
};

// A predicate of the kernel that knows walls; for COUNT points the limit may tell.
template <class Plain, class Rational, int count>
struct Walled {
    const double *upper;
    Plain plain;
    using result_type = typename Plain::result_type;

    template <class... Point>
    result_type operator()(const Point &...p) const
    {
        if (!(is_wall(p) || ...)) return plain(p...);
        if constexpr (sizeof...(p) == count)
            if (const int sign = Limit{upper}(p...))
                return static_cast<result_type>(sign);
        return Rational()(Widen{upper}(p)...);
    }
};

struct WalledKernel : Kernel {
    double upper[3] = {0, 0, 0}; // corner of the box; the other is the origin

    using Orientation_3 = Walled<Kernel::Orientation_3, Exact::Orientation_3, 4>;
    using Coplanar_orientation_3 =
        Walled<Kernel::Coplanar_orientation_3, Exact::Coplanar_orientation_3, 0>;
    using Power_side_of_oriented_power_sphere_3 =
        Walled<Kernel::Power_side_of_oriented_power_sphere_3,
               Exact::Power_side_of_oriented_power_sphere_3, 5>;

    Orientation_3 orientation_3_object() const
    {
        return {upper, Kernel().orientation_3_object()};
    }
    Coplanar_orientation_3 coplanar_orientation_3_object() const
    {
        return {upper, Kernel().coplanar_orientation_3_object()};
    }
    Power_side_of_oriented_power_sphere_3
    power_side_of_oriented_power_sphere_3_object() const
    {
        return {upper, Kernel().power_side_of_oriented_power_sphere_3_object()};
    }
};

// ---- numbering ----------------------------------------------------------------------

// The bits of X, two zeros between each.
std::uint64_t spread(std::uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

// Where each point comes on a Z-curve through all of them.
std::vector<int> place_along_curve(const struct vector *points, int n)
{
    struct vector lower = points[0], upper = points[0];
    for (int i = 1; i < n; i++) {
        const struct vector &p = points[i];
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y),
                 std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y),
                 std::max(upper.z, p.z)};
    }
    const double size =
        std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z, 1e-300});
    const auto bits = [=](double x) {
        return spread(static_cast<std::uint64_t>(x / size * ((1 << 20) - 1)));
    };
    std::vector<std::pair<std::uint64_t, int>> curve(static_cast<size_t>(n));
    for (int i = 0; i < n; i++)
        curve[static_cast<size_t>(i)] = {bits(points[i].x - lower.x) << 2 |
                                             bits(points[i].y - lower.y) << 1 |
                                             bits(points[i].z - lower.z),
                                         i};
    std::sort(curve.begin(), curve.end());
    std::vector<int> place(static_cast<size_t>(n));
    for (int k = 0; k < n; k++)
        place[static_cast<size_t>(curve[static_cast<size_t>(k)].second)] = k;
    return place;
}

// Numbers the finite cells by the first of their points on the curve: neighbours come
// close to each other, in space as in memory.
template <class Regular>
void number_cells(const Regular &regular, const std::vector<int> &place,
                  struct triangulation *triangulation)
{
    const auto first = [&](auto cell) {
        int least = static_cast<int>(place.size()) - 1;
        for (int k = 0; k < 4; k++)
            if (cell->vertex(k)->info() >= 0)
                least = std::min(least,
                                 place[static_cast<size_t>(cell->vertex(k)->info())]);
        return static_cast<size_t>(least);
    };
    std::vector<int> next(place.size() + 1);
    for (auto cell = regular.all_cells_begin(); cell != regular.all_cells_end();
         ++cell) {
        cell->info() = -1;
        if (!regular.is_infinite(cell)) next[first(cell) + 1]++;
    }
    for (size_t k = 1; k < next.size(); k++)
        next[k] += next[k - 1];
    triangulation->n_cell = next.back();
    triangulation->cell = static_cast<struct cell *>(std::aligned_alloc(
        sizeof(struct cell),
        sizeof(struct cell) * (static_cast<size_t>(triangulation->n_cell) + 1)));
    for (auto cell = regular.finite_cells_begin(); cell != regular.finite_cells_end();
         ++cell)
        cell->info() = next[first(cell)]++;
}

template <class Regular>
std::vector<std::pair<typename Regular::Weighted_point, int>>
weighted_points(const struct vector *points, const double *weights, int n)
{
    std::vector<std::pair<typename Regular::Weighted_point, int>> weighted;
    weighted.reserve(static_cast<size_t>(n));
    for (int i = 0; i < n; i++)
        weighted.emplace_back(
            typename Regular::Weighted_point(
                Kernel::Point_3(points[i].x, points[i].y, points[i].z),
                weights ? weights[i] : 0.0),
            i);
    return weighted;
}

template <class Regular>
int copy_cells(const Regular &regular, const struct vector *points, int n,
               struct triangulation *triangulation)
{
    if (regular.dimension() < 3) return -1;
    number_cells(regular, place_along_curve(points, n), triangulation);
    for (auto cell = regular.finite_cells_begin(); cell != regular.finite_cells_end();
         ++cell) {
        struct cell &copy = triangulation->cell[cell->info()];
        copy = {};
        for (int k = 0; k < 4; k++) {
            copy.vertex[k] = cell->vertex(k)->info();
            copy.neighbour[k] = cell->neighbor(k)->info();
        }
    }
    return 0;
}

} // namespace

extern "C" int triangulate_in_walls(const struct vector *points, const double *weights,
                                    int n, unsigned walls, struct vector upper,
                                    struct triangulation *triangulation)
{
    WalledKernel kernel;
    kernel.upper[0] = upper.x, kernel.upper[1] = upper.y, kernel.upper[2] = upper.z;
    Triangulation<WalledKernel> regular(kernel);
    for (int wall = 0; wall < 6; wall++) {
        if (!(walls >> wall & 1)) continue;
        double centre[3] = {upper.x / 2, upper.y / 2, upper.z / 2};
        centre[wall / 2] = wall % 2 ? huge : -huge;
        regular
            .insert(Kernel::Weighted_point_3(
                Kernel::Point_3(centre[0], centre[1], centre[2]), 0.0))
            ->info() = -1 - wall;
    }
    const auto weighted =
        weighted_points<Triangulation<WalledKernel>>(points, weights, n);
    regular.insert(weighted.begin(), weighted.end());
    return copy_cells(regular, points, n, triangulation);
}
