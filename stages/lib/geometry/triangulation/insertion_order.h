// SPDX-License-Identifier: GPL-3.0-or-later
// In which order to insert points into a triangulation.
#ifndef CRAQUELURE_INSERTION_ORDER_H
#define CRAQUELURE_INSERTION_ORDER_H

#include "geometry/vector.h"

#include <stdint.h>

// An order in which to insert N points fast, each close to one before: where each of
// them stands. The caller frees it.
int32_t *insertion_order(const struct vector *points, int n);

#endif
