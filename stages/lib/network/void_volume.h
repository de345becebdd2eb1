// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "basics/status.h"
#include "network/network.h"

// Gives every throat the void that belongs to it: of each grain's cell the pyramids
// between its centre, the middle of a face's rim, and the throat as a side of that
// face, less the grain. The sum is the volume of the cells less the grains, to
// rounding, spheres cut exactly by the faces. In a power diagram that is the void of
// the box: grains that overlap meet in the face between them, and none sticks out of
// its cell into void.
//
// Fills throat_volume; what was there goes. STATUS_BAD_DATA when two neighbours in a
// face's loop are not joined by a throat, or a throat would get less than nothing
// (a grain whose centre another one has engulfed).
enum status find_void_volumes(struct network *network, struct reason *reason);

// The middle of the face's rim, in the repetition of the box in which its first grain
// is: nodes that coincide, as on lattices, do not pull it to their side.
struct vector face_middle(const struct network *network, int face);
