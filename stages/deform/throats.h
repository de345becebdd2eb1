// SPDX-License-Identifier: GPL-3.0-or-later
// Throats of a network whose grains and nodes have moved.
#pragma once

#include "basics/status.h"
#include "neighbour_grains.h"
#include "network/clearance.h"
#include "network/network.h"

// (n_throat) Least clearance of each throat, to the grains that HOW says, 0 where they
// overlap it; infinite where none is known beside it. The caller frees it; NULL with
// the reason: a face without a throat at its rim.
double *find_clearances(const struct network *network, enum clearance how,
                        struct reason *reason);

// (n_throat) By how much the grains around the two nodes of each throat have grown: the
// sum of their radii in MOVED over that before, s below; 1 where there are none. The
// caller frees it.
double *find_growth(const struct network *before, const struct neighbour_grains *around,
                    const struct packing *moved);

// The radius of a throat of RADIUS when its clearance changes from BEFORE to AFTER, and
// the grains around it by the factor GROWTH: r' below.
double moved_radius(double radius, double growth, double before, double after);

// Gives AFTER, a copy of BEFORE but for the places of grains and nodes, its lengths and
// radii. With c the clearance of a throat, r its radius, and s the growth of the grains
// AROUND it, as above,
//
//     r' = s r + (c' - s c) min(1, r / c):
//
// a radius that is the clearance stays so, one that was drawn narrower keeps its share
// of it, and one wider (entry radii; throats fused by merging) keeps its excess, which
// shrinks with the grains. So all scale where all shrinks alike. A length changes as
// the distance of the nodes. STATUS_BAD_DATA: a face without a throat at its rim.
enum status move_throats(const struct network *before,
                         const struct neighbour_grains *around, enum clearance how,
                         struct network *after, struct reason *reason);

// If throats have volumes: volumes that were shares of the void are so again, unless
// the diagram has CHANGED; others change as the cylinder of the throat, and all by one
// common factor, so that their sum changes by as much as the void of the box.
enum status move_volumes(const struct network *before, bool changed,
                         struct network *after, struct reason *reason);

// If the network says what throats conduct: what the open section between their grains
// gave, it gives again, unless the diagram has CHANGED; others change as the cylinders
// of the throats do, radii and lengths of BEFORE and AFTER.
enum status move_shapes(const struct network *before, bool changed,
                        struct network *after, struct reason *reason);

// Throats of kind THROAT_NETWORK that have a radius or volume of 0 in AFTER only.
int count_closed_throats(const struct network *before, const struct network *after);
