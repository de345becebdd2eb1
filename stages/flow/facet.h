// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry of one throat [C 2.2.2]: a facet of the triangulation and the centres
// of the two pores that it separates. In any unit of length.
#pragma once

#include "geometry/vector.h"
#include "network/open_section.h"

#include <stdbool.h>

// A corner of a facet: a grain, or a wall of the box with its outward NORMAL. A wall is
// a sphere whose radius has no limit, so that what [C] says of spheres is said of it in
// that limit: its centre is a direction, its surface a plane, and a facet ends there.
struct corner {
    struct vector at; // grain
    double radius;    // grain; 0 for a wall
    struct vector normal;
    double plane; // where the wall stands along its normal
};

static inline bool is_wall(const struct corner *corner)
{
    return corner->radius <= 0;
}

// How far AT is inside WALL.
static inline double depth(const struct corner *wall, struct vector at)
{
    return wall->plane - dot(wall->normal, at);
}

// Direction from a grain to another corner; to a wall, its normal.
static inline struct vector towards(struct vector from, const struct corner *corner)
{
    return is_wall(corner) ? corner->normal : subtract(corner->at, from);
}

struct facet {
    struct vector area; // S_ij n_ij, from the first pore to the second, up to the walls
    double sector[3];   // A^k_ij: of the facet, inside each grain [C 14]
    double surface[3];  // gamma^k_ij: of each grain, of each wall [C 9, 18]
    double volume;      // phi_ij: of the throat; below 0 where grains overlap
    double length;      // L_ij
};

// CORNER: anticlockwise seen from the second pore, at most two of them walls. FROM and
// TO: the centres. With PARTITION all parts are signed: where both centres are on one
// side of the facet the nearer one's part is subtracted, so that over all throats the
// volumes sum to the void and the surfaces to those of the grains and walls, wherever
// centres are (grains must not overlap, for the volumes). Without, a grain's surface is
// that between the plane through an edge and both centres, added up over its two edges
// of the facet without a sign, as Yade does.
struct facet measure_facet(const struct corner corner[3], struct vector from,
                           struct vector to, bool partition);

// What a throat with a facet of AREA (as in struct facet, not 0) conducts by its open
// section between the grains, as throats of the pore network do
// (network/open_section.h), with lengths in the unit of the corners. With WALLS_RESIST
// walls are part of the rim, else planes of symmetry. 0 where sectors cover the
// section.
struct throat_shape facet_section_shape(const struct corner corner[3],
                                        struct vector area, struct vector from,
                                        struct vector to, bool walls_resist);

// Radius of the circle in the plane of the facet that touches all three corners [C 10];
// 0 when there is none, for grains overlap.
double inscribed_radius(const struct corner corner[3]);
