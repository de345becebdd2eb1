// SPDX-License-Identifier: GPL-3.0-or-later
// Mapping of liquid and radii from a network to another of the same grains, moved.
#pragma once

#include "basics/status.h"
#include "neighbour_grains.h"
#include "network/clearance.h"

struct mapped_liquid {
    double *liquid;     // (n_throat) of the new network, m3
    double *saturation; // (n_throat) likewise, what it begins with
};

// Old throats are moved by the mean displacement of the grains around their ends. A new
// throat gets the saturation of the old one whose middle is then nearest to its own;
// the liquid of an old throat, SATURATION (n_throat of BEFORE) times its volume, goes
// to the nearest new throat that has any. Throats of RENEWED in walls where the old
// ones are imposed empty become so, and so do those that these cut off from OPEN_WALLS
// (bits of enum wall). The caller frees both arrays. O(n_throat) for throats spread
// evenly.
struct mapped_liquid map_liquid(const struct network *before,
                                const struct neighbour_grains *around,
                                const struct packing *moved, const double *saturation,
                                unsigned open_walls, struct network *renewed);

// Each throat of RENEWED that can hold liquid (THROAT_NETWORK) gets the radius of the
// old one that is nearest, as above, changed as their clearances differ (moved_radius):
// drawn radii keep their share of the clearance. Without volumes of throats before
// there are none after, and cylinders before are cylinders after.
// STATUS_BAD_DATA: a face without a throat at its rim.
enum status map_radii(const struct network *before,
                      const struct neighbour_grains *around,
                      const struct packing *moved, enum clearance how,
                      struct network *renewed, struct reason *reason);
