// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid that throats imposed empty have shut in.
#ifndef CRAQUELURE_ENCLOSED_H
#define CRAQUELURE_ENCLOSED_H

#include "boundary_layer.h"

// Imposes empty as well the throats of NETWORK from which no way through liquid leads
// to a node with a column; none where there is no such node. Returns how many.
int empty_enclosed_throats(struct network *network, unsigned walls,
                           enum boundary_feet feet);

#endif
