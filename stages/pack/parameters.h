// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of pack.
#ifndef CRAQUELURE_PACK_PARAMETERS_H
#define CRAQUELURE_PACK_PARAMETERS_H

#include "domain.h"
#include "dynamics.h"
#include "parameters/parameters.h"
#include "sizes.h"

#include <stdbool.h>
#include <stdint.h>

enum method {
    METHOD_SQUARE,
    METHOD_CUBIC,
    METHOD_BODY_CENTRED,
    METHOD_FACE_CENTRED,
    METHOD_HEXAGONAL,
    METHOD_HONEYCOMB,
    METHOD_POISSON,
    METHOD_RANDOM_SEQUENTIAL,
    METHOD_INWARD_SPIRAL,
    METHOD_DEPOSITION,
    METHOD_RADIUS_EXPANSION,
    METHOD_DOMAIN_CONTRACTION,
    METHOD_EXPLOSIVE_REPULSION,
    METHOD_IMPORT
};
enum bonds { BONDS_NONE, BONDS_TOUCHING, BONDS_KEEP };
enum check { CHECK_REFUSE, CHECK_WARN, CHECK_NONE };

struct pack_parameters {
    int method, bonds, check; // enum method, enum bonds, enum check
    int64_t dimensions;
    int64_t counts[3]; // of a lattice: unit cells
    int64_t count;     // of grains; 0: until no more fit
    struct size_parameters sizes;
    struct domain_parameters domain;
    int64_t seed, most_trials, frame;
    bool densify, extra_layer;
    int extra_side; // wall that the extra layer is at
    struct dynamics_parameters dynamics;
    double touching_gap; // of the sum of two radii
    double import_scale; // m per unit of INPUT
    bool import_diameters;
};

extern const struct parameter pack_table[];

#endif
