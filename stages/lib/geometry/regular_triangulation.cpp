// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that talks to CGAL.
#include "geometry/regular_triangulation.h"

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
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<
    int, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<
    int, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;

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
void number_cells(const Triangulation &regular, const std::vector<int> &place,
                  struct triangulation *triangulation)
{
    const auto first = [&](auto cell) {
        int least = place[static_cast<size_t>(cell->vertex(0)->info())];
        for (int k = 1; k < 4; k++)
            least =
                std::min(least, place[static_cast<size_t>(cell->vertex(k)->info())]);
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

} // namespace

extern "C" int triangulate(const struct vector *points, const double *weights, int n,
                           struct triangulation *triangulation)
{
    std::vector<std::pair<Triangulation::Weighted_point, int>> weighted;
    weighted.reserve(static_cast<size_t>(n));
    for (int i = 0; i < n; i++)
        weighted.emplace_back(
            Triangulation::Weighted_point(
                Kernel::Point_3(points[i].x, points[i].y, points[i].z),
                weights ? weights[i] : 0.0),
            i);
    const Triangulation regular(weighted.begin(), weighted.end());
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

extern "C" struct vector exact_power_centre(const struct vector *points,
                                            const double *weights,
                                            const int32_t corner[4])
{
    using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
    const auto weighted = [&](int k) {
        const struct vector &p = points[corner[k]];
        return Exact::Weighted_point_3(Exact::Point_3(p.x, p.y, p.z),
                                       weights[corner[k]]);
    };
    const Exact::Point_3 centre = Exact().construct_weighted_circumcenter_3_object()(
        weighted(0), weighted(1), weighted(2), weighted(3));
    return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()),
            CGAL::to_double(centre.z())};
}

extern "C" void triangulation_free(struct triangulation *triangulation)
{
    std::free(triangulation->cell);
    *triangulation = {};
}
