// SPDX-License-Identifier: GPL-3.0-or-later
// From the triangulation to the arrays of the network. Both functions allocate the
// arrays that they fill, which then belong to the network; they need a network without
// any, but with its packing. The results depend on the nodes alone, not on the order of
// the cells or the number of threads.
#pragma once

#include "diagram.h"
#include "generators.h"
#include "nodes.h"

// What throats and faces are made from. It owns nothing but lends all of it.
struct assembly {
    const struct generators *generators;
    const struct triangulation *triangulation;
    const struct nodes *nodes;
    const double *radius; // of generators, in units
    enum clearance clearance;
    struct sphere_cells grains; // in units
};

// Fills the throats of the network, sorted by their nodes; radii and lengths in m. A
// radius is the clearance that CLEARANCE says, 0 where grains overlap the throat.
void assemble_throats(const struct assembly *assembly, struct network *network);

// Fills the faces: each a loop of nodes, normal pointing from its first side to its
// second, sorted by the grains they separate.
void assemble_faces(const struct assembly *assembly, struct network *network);
