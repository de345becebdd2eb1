// SPDX-License-Identifier: GPL-3.0-or-later
// Radii in another unit than places: columns of a table in µm and mm.
#pragma once

#include "geometry/packing.h"

// By how much radii must be multiplied for the grains to be a body: 1e3, 1e6, 1e-3 or
// 1e-6; 1 where they are, where there are fewer than 20, and where nothing is certain.
// O(n).
double radius_unit(const struct packing *packing);
