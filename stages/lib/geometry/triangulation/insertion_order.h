// SPDX-License-Identifier: GPL-3.0-or-later
// In which order to insert points into a triangulation.
#pragma once

#include "geometry/vector.h"

#include <stdint.h>

// An order in which to insert N points fast, each close to one before: where each of
// them stands. The caller frees it. Rounds, each some eight times as large as the one
// before and along a space-filling curve, so that walks from point to point stay short.
// Each of 0..N-1 once; the same for the same points. O(n log n).
int32_t *insertion_order(const struct vector *points, int n);
