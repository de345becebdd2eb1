// SPDX-License-Identifier: GPL-3.0-or-later
// In which order the columns of a boundary layer are best eliminated.
#ifndef CRAQUELURE_NESTED_DISSECTION_ORDER_H
#define CRAQUELURE_NESTED_DISSECTION_ORDER_H

#include "boundary_layer.h"

// Nested dissection (George 1973): those that part the others come last, so that most
// are eliminated while few feet are linked with each other. Indices into
// layer->exposed; the caller frees them.
int *nested_dissection_order(const struct network *network,
                             const struct boundary_layer *layer);

#endif
