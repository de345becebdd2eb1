// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that talks to CGAL.
#include "regular_triangulation.h"

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

    int count = 0;
    for (auto cell = regular.all_cells_begin(); cell != regular.all_cells_end(); ++cell)
        cell->info() = regular.is_infinite(cell) ? -1 : count++;

    triangulation->n_cell = count;
    triangulation->cell = static_cast<struct cell *>(
        std::aligned_alloc(sizeof(struct cell), sizeof(struct cell) * (count + 1ul)));
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
