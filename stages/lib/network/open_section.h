// SPDX-License-Identifier: GPL-3.0-or-later
// The open section of a throat: what grains leave free of the polygon between their
// centres, along the way from node to node. All lengths are in m.
//
// A throat is an edge of the Voronoi or power diagram, so the centres of the grains
// around it lie in planes across it and their polygon is the section of a prism. Seen
// along the throat (z = 0 at its first node), grain i blocks of that prism a sector of
// a disc: angle a_i, radius rho_i(z), rho_i^2 = r_i^2 - (z - h_i)^2
// [docs/transport.md].
#pragma once

// One grain of the polygon.
struct section_grain {
    double angle;     // rad, of the polygon at its centre
    double radius;    // m
    double height;    // m, where along the throat its centre is
    double reach;     // m, from its centre to the line of the throat
    double across[2]; // m, its centre from that line, along two axes across the throat
};

// Two grains that overlap, or a grain that overlaps a wall: their sectors count what
// lies beyond the line between them twice, or count what is wall already.
struct section_overlap {
    double apart[2];  // m, from the centre of each grain to that line
    double radius[2]; // m; 0: the second is a wall
    double height;    // m
};

// A side of the polygon: the gap between two grains, or between a grain and its own
// half of a face with a wall.
struct section_gap {
    int grain[2]; // numbers in section_grain; second below 0: a wall
    double apart; // m, of the centres; of a centre from the wall
};

struct open_section {
    double area;   // m2, of the polygon
    double length; // m, of the throat
    double wall;   // m, of the section's rim that lies in walls
    int n_grain, n_overlap, n_gap;
    struct section_grain *grain;     // (n_grain)
    struct section_overlap *overlap; // (n_overlap)
    struct section_gap *gap;         // (n_gap)
};

// What a throat conducts.
struct throat_shape {
    double diffusion;        // m: flux = D diffusion (difference of concentration)
    double flow;             // m3: flux = flow (difference of pressure) / viscosity
    double hydraulic_radius; // m: twice section over rim, weighted with the resistance
                             // to diffusion; of a cylinder its radius
};

// The open area at Z (m from the first node), m2; 0 or below: closed. area - sum over
// grains of angle rho^2 / 2 + sum over overlaps of what was counted twice. O(n_grain +
// n_overlap).
double open_area(const struct open_section *section, double z);

// Resistances of thin slices in series,
//     1 / diffusion = int dz / area,  1 / flow = int dz / slice conductance.
// A section that is closed anywhere conducts nothing: all 0 but the radius. A throat
// without length conducts as one of 1e-12 of its grains' size would.
struct throat_shape section_shape(const struct open_section *given);

// Where the section is narrowest, m from the first node: at the mean plane of the
// centres, within the throat.
double narrowest_place(const struct open_section *section);
