// SPDX-License-Identifier: GPL-3.0-or-later
// Grains from a file, whatever kind it is.
#pragma once

#include "geometry/packing.h"

#include <jansson.h>

// Grains of PATH: text, FRAME of a LAMMPS dump (-1: the last), or an artifact of SCHEMA
// (NULL: any that holds a packing). HAS_BOX, if not NULL: whether it says what the box
// is; else the walls are where the grains end. UNIT, if not NULL: metres a unit of
// length where a dump names units in which lengths are not in metres, else 0.
// *DIAMETERS becomes true where a dump names them so. INPUTS gets what the provenance
// says of it. Exits 65 and 66. The caller frees the packing.
// INPUTS: the list for artifact_finish, which gets one entry more. Text and dumps have
// no bonds, and no unit: see convert_grains.
struct packing read_grains(const char *path, const char *schema, int64_t frame,
                           bool *has_box, double *unit, bool *diameters,
                           json_t *inputs);

// Lengths that were not in metres: BY is metres per unit. DIAMETERS: the radii are
// diameters; walls where grains end, unless the file HAS_BOX, then move in. All lengths
// of PACKING, its box included. Bonds stay.
void convert_grains(struct packing *packing, double by, bool diameters, bool has_box);

// Exits 65 where radii are 1000 times too large for the places, or more: each grain
// would overlap with all others.
void refuse_large_radii(const struct packing *packing, const char *path);
