// SPDX-License-Identifier: GPL-3.0-or-later
// Throat by throat, each on one thread with room of its own for `most` sides, so that
// the number of threads changes nothing. Of each throat
//     throat_polygon_fill   the polygon of the grains around it, from its faces,
// and then one of
//     section_shape         what the open section between them conducts,
//     entry_radius          the radius at whose capillary pressure gas enters it.
// A throat that the section closes, though it has a radius, conducts as a cylinder
// (as_cylinder); one without a radius too conducts nothing: all three numbers are 0.
//
// Entry radii replace throat_radius, which as_cylinder reads: who wants both asks for
// the shapes first, as tessellate does. The disc of a throat's clearance c is free of
// grains in any case, so gas enters at 2 sigma / c at most: at a radius of at least
// c cos(theta), which stays where the iteration fails and says 0.
#include "network/throat_shapes.h"

#include "basics/memory.h"
#include "network/entry_radius.h"
#include "network/throat_polygon.h"

#include <math.h>
#include <stdlib.h>

// What a throat conducts that the signed polygon closes though it has a radius: small
// grains sit between large ones, whose discs reach across the whole polygon into the
// next. The cylinder of its radius (half of it along a wall, a quarter along two) is
// free of grains, and conducts less than the void.
static struct throat_shape as_cylinder(const struct network *network, int throat)
{
    const int32_t *ends = network->throat_nodes[throat];
    const unsigned walls = network->node_walls[ends[0]] & network->node_walls[ends[1]];
    const double share = 1.0 / (1 << __builtin_popcount(walls));
    const double radius = network->throat_radius[throat],
                 length = network->throat_length[throat];
    if (!(length > 0) || !(radius > 0)) return (struct throat_shape){0};
    const double section = share * M_PI * radius * radius;
    return (struct throat_shape){section / length,
                                 section * radius * radius / (8 * length), radius};
}

enum status find_throat_shapes(struct network *network, struct reason *reason)
{
    struct throat_sides sides;
    const enum status status = throat_sides_init(network, &sides, reason);
    if (status) return status;
    const int n = network->n_throat;
    forget_throat_shapes(network);
    network->throat_diffusion = NEW_ARRAY(double, n);
    network->throat_flow = NEW_ARRAY(double, n);
    network->throat_hydraulic_radius = NEW_ARRAY(double, n);
#pragma omp parallel
    {
        struct throat_polygon polygon = throat_polygon_init(sides.most);
#pragma omp for schedule(static)
        for (int t = 0; t < n; t++) {
            throat_polygon_fill(&polygon, network, &sides, t);
            struct throat_shape shape = section_shape(&polygon.section);
            if (!(shape.diffusion > 0)) shape = as_cylinder(network, t);
            network->throat_diffusion[t] = shape.diffusion;
            network->throat_flow[t] = shape.flow;
            network->throat_hydraulic_radius[t] = shape.hydraulic_radius;
        }
        throat_polygon_free(&polygon);
    }
    throat_sides_free(&sides);
    return STATUS_OK;
}

enum status find_entry_radii(struct network *network, double contact_angle,
                             struct reason *reason)
{
    struct throat_sides sides;
    const enum status status = throat_sides_init(network, &sides, reason);
    if (status) return status;
#pragma omp parallel
    {
        struct throat_polygon polygon = throat_polygon_init(sides.most);
#pragma omp for schedule(static)
        for (int t = 0; t < network->n_throat; t++) {
            if (!(network->throat_radius[t] > 0)) continue; // closed stays closed
            throat_polygon_fill(&polygon, network, &sides, t);
            network->throat_radius[t] =
                fmax(network->throat_radius[t] * cos(contact_angle),
                     entry_radius(&polygon.section, contact_angle));
        }
        throat_polygon_free(&polygon);
    }
    throat_sides_free(&sides);
    return STATUS_OK;
}
