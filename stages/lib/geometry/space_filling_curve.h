// SPDX-License-Identifier: GPL-3.0-or-later
// Places in the order in which Hilbert's curve meets them, so that neighbours in space
// are neighbours in memory.
#pragma once

#include "geometry/vector.h"

#include <stdint.h>

// (N) The index of the first of N places, of the second, and so on. The caller frees
// it. O(n log n).
int32_t *order_along_curve(int n, const struct vector *place);
