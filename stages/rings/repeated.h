// SPDX-License-Identifier: GPL-3.0-or-later
// A packing in a box so wide that each grain meets each other one in one image only,
// as neighbour_pairs and nearest_image take for granted.
#pragma once

#include "geometry/packing.h"

// PACKING side by side *COPIES times, along the axes where its box repeats and is
// narrower than twice REACH (m, the largest distance of two centres that may matter),
// until it is not. Places, radii and the box only: no kinds, no bonds, no bodies. The
// caller frees it with packing_free.
struct packing repeated_packing(const struct packing *packing, double reach,
                                int *copies);
