// SPDX-License-Identifier: GPL-3.0-or-later
// Throats of a network in the order of tessellate: those between two nodes, those
// beside grains.
#ifndef CRAQUELURE_THROATS_BESIDE_H
#define CRAQUELURE_THROATS_BESIDE_H

#include "network/network.h"

// The first throat whose nodes do not come before these two.
int first_throat_between(const struct network *network, const int32_t ends[2]);

// (n_throat) whether one of GRAINS, (n_particle), is beside the throat. In a network
// whose throats are in the order of tessellate. The caller frees it.
bool *throats_beside(const struct network *network, const bool *grains);

#endif
