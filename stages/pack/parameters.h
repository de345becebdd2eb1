// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of pack. NAN, or 0 for counts: not given. What stands in for it
// depends on the method (methods.c). The table checks each parameter for itself; that
// they agree with each other is checked by the functions that use them.
#pragma once

#include "domain.h"
#include "dynamics.h"
#include "parameters/parameters.h"
#include "sizes.h"

#include <stdbool.h>
#include <stdint.h>

// In the order of the choices in the table. The first six are lattices, the four of
// moving grains may begin from those of INPUT.
enum method {
    METHOD_SQUARE, // and the next five: lattices of touching grains (lattice_packing)
    METHOD_CUBIC,
    METHOD_BODY_CENTRED,
    METHOD_FACE_CENTRED,
    METHOD_HEXAGONAL,
    METHOD_HONEYCOMB,
    METHOD_POISSON,             // random points, which may overlap: poisson_points
    METHOD_RANDOM_SEQUENTIAL,   // random_sequential
    METHOD_INWARD_SPIRAL,       // inward_spiral [K 3.1.2]
    METHOD_DEPOSITION,          // moving grains [K 3.1.1]: deposit
    METHOD_RADIUS_EXPANSION,    // densify, grains grow
    METHOD_DOMAIN_CONTRACTION,  // densify, the box contracts
    METHOD_EXPLOSIVE_REPULSION, // repel
    METHOD_IMPORT,              // grains of INPUT as they are: make_import
    METHOD_SOFT_SPHERES         // relaxed random points: soft_spheres
};

// Which grains are bonded: none, those that touch within touching_gap, or as INPUT
// says. "touching" needs no forces: two grains whose surfaces are near enough.
enum bonds { BONDS_NONE, BONDS_TOUCHING, BONDS_KEEP };

// What happens to a packing that is impossible: refused, reported, or not looked at.
// One that is only unlikely is reported (geometry/packing_check.h).
enum check { CHECK_REFUSE, CHECK_WARN, CHECK_NONE };

// What the table reads into; NAN: not given. Lengths in m. The int members are places
// of choices in the table.
struct pack_parameters {
    int method, bonds, check; // enum method, enum bonds, enum check
    int64_t dimensions;
    int64_t counts[3]; // of a lattice: unit cells
    int64_t count;     // of grains; 0: until no more fit
    struct size_parameters sizes;
    struct domain_parameters domain;
    int64_t seed, most_trials, frame;
    bool densify, extra_layer;     // fill voids of the spiral; add a layer [K 3.3.5]
    int extra_side;                // wall that the extra layer is at
    double slab_lower, slab_upper; // heights of a slab that is kept; m
    struct dynamics_parameters dynamics;
    double touching_gap;   // of the sum of two radii
    double import_scale;   // m per unit of INPUT
    bool import_diameters; // INPUT has diameters in place of radii
};

// Fills a struct pack_parameters but for .dynamics.threads and .dynamics.keeper, which
// main sets.
extern const struct parameter pack_table[];
