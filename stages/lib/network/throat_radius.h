// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef CRAQUELURE_THROAT_RADIUS_H
#define CRAQUELURE_THROAT_RADIUS_H

#include "network/network.h"

// Gives every throat, in the order of the network, a radius drawn from a normal
// distribution [K 3.11]; draws that are not positive are drawn again. MEAN and
// DEVIATION in m. The same seed gives the same radii (GSL's mt19937 and its ziggurat).
void draw_normal_radii(struct network *network, double mean, double deviation,
                       unsigned long seed);

#endif
