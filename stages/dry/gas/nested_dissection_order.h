// SPDX-License-Identifier: GPL-3.0-or-later
// An order in which eliminating the columns of a boundary layer costs little.
#pragma once

#include "boundary_layer.h"

// Nested dissection (George 1973): separators come last, so that most columns are
// eliminated while few feet are linked with each other. Returns (layer->n_exposed)
// indices into layer->exposed, a permutation; the caller frees it. O(n log^2 n).
int *nested_dissection_order(const struct network *network,
                             const struct boundary_layer *layer);
