// SPDX-License-Identifier: GPL-3.0-or-later
// The network of grains that have moved, while the same grains lie around each node.
//
// AFTER is always a copy of BEFORE whose grains have their new places; what has not
// moved keeps its bytes.
#ifndef CRAQUELURE_MOVE_H
#define CRAQUELURE_MOVE_H

#include "neighbour_grains.h"

// The walls of the box go with the grains beside them: along each axis without
// repetition what takes the mean places of the grains within a diameter of either wall
// to where these grains are now, linear in between and beyond, takes the walls to
// theirs. A body that grains lie in or around goes with the grains within a diameter of
// its surface: where it is round by the shift, turn and stretch that take them best to
// where they are now, along each other axis by shift and stretch, both by least
// squares. Boxes do not turn.
void move_box(const struct packing *before, struct packing *after);

// Every node stays on the walls it is on, and keeps the differences of the powers it
// has to the grains around it (none, where it is a vertex of the diagram; merged ones
// have some), to the scale of their distances, squared: exactly, or by least squares
// where they are more than it takes. What they leave open follows their mean. Returns
// how many have no such place on their round surface any more.
int move_nodes(const struct network *before, const struct neighbour_grains *around,
               struct network *after);

// At how many nodes moved grains would have another diagram: a grain of a neighbouring
// node, or of any on the surface of the same hole, has less power to it than its own
// have, it lies outside the box, or a throat of it goes through a hole; not counted
// where that was so before.
int count_changed_nodes(const struct network *before,
                        const struct neighbour_grains *around,
                        const struct network *after);

#endif
