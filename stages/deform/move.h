// SPDX-License-Identifier: GPL-3.0-or-later
// The network of grains that have moved, while the same grains lie around each node.
//
// AFTER is always a copy of BEFORE whose grains have their new places; what has not
// moved keeps its bytes.
#pragma once

#include "neighbour_grains.h"

// The walls of the box move with the grains beside them: along each axis that is not
// periodic, by the linear map that takes the mean places of the grains within a
// diameter of either wall to where these grains are now. A body that grains lie in or
// around moves with the grains within a diameter of its surface: where it is round by
// shift, rotation and stretch, along each other axis by shift and stretch, both fitted
// by least squares. Boxes do not rotate.
void move_box(const struct packing *before, struct packing *after);

// Every node stays on its walls and keeps the differences of its powers to the grains
// around it (0 for a vertex of the diagram, not for merged nodes), scaled with the
// square of their distances: exactly, or by least squares if they are overdetermined.
// Directions that they leave open follow the mean of the grains. Returns how many nodes
// have no such place on their round surface any more.
int move_nodes(const struct network *before, const struct neighbour_grains *around,
               struct network *after);

// The number of nodes at which the moved grains would have another diagram: a grain of
// a neighbouring node, or of any node on the surface of a hole, has less power to it
// than its own have, or it lies outside the box, or a throat of it passes through a
// hole. Nodes where that was so before do not count.
int count_changed_nodes(const struct network *before,
                        const struct neighbour_grains *around,
                        const struct network *after);
