// SPDX-License-Identifier: GPL-3.0-or-later
// Redistribution of liquid in a network whose throats have changed their volumes.
//
// Per cluster: surplus = sum over its throats of (liquid - saturation times new
// volume). It is what must find other throats, or is missing.
#pragma once

#include "network/network.h"

// The liquid before: where it is, and how much.
struct held_liquid {
    const double *liquid;     // (n_throat) m3
    const double *saturation; // (n_throat) 0 to 1: kept as far as possible
    unsigned open_walls;      // bits of enum wall: their nodes touch the air
};

// Fills SATURATION (n_throat) of NETWORK, whose throats of kind THROAT_NETWORK have
// other volumes than those that held the liquid. Each cluster of liquid first keeps its
// saturations. A surplus then fills throats at its menisci, the narrowest first, as the
// suction there is largest; a shortage empties them, the widest first. Among equals the
// lowest index comes first. Returns the volume (m3) that finds no room and leaves the
// network. If liquid is saturation times volume, but for 1e-12 of a mean throat,
// saturations stay, bit for bit; else the sum of the liquid is kept to rounding.
double redistribute_liquid(const struct network *network,
                           const struct held_liquid *held, double *saturation);
