// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_NET_LOAD_H
#define CRAQUELURE_NET_LOAD_H

#include "geometry/packing.h"

// Takes off what would move an aggregate that nothing holds: from every grain, by its
// mass, the one acceleration and the one angular acceleration that leave the forces, in
// N (n_particle), without net force and net moment. Grains are of one density, and turn
// about the centre of mass as points.
void take_off_net_load(const struct packing *packing, struct vector *force);

#endif
