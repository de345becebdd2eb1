// SPDX-License-Identifier: GPL-3.0-or-later
// Networks cut by the surface of a body: cylinder, sphere, or the inside of a ring.
#pragma once

#include "basics/status.h"
#include "diagram.h"

// Cuts from NETWORK what does not lie within body K (or around it, by body.within):
// throats end where they meet its surface [K 3.3.1, step 3], exactly; faces end there
// in a throat that is the chord between those ends; and each grain gets a face on the
// wall, whose rim these chords are. So cells stay closed, with the nodes on the wall,
// and miss what lies between chords and wall: a share of the order of (grain / radius
// of the wall)^2. Where the wall only bulges into a face, meeting none of its throats,
// the face stays as it is; edges of a box, and of a cylinder that ends within the
// domain, are cut off as by the chords.
//
// New nodes come last, in the order of the throats they cut. STATUS_BAD_DATA when the
// surface meets no throat: it is too small for the grains, or they are too few; or when
// the box repeats where the grains lie within a round wall.
enum status cut_network(struct network *network, int k, enum clearance clearance,
                        struct reason *reason);
