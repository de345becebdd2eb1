// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid of a network whose throats have other volumes than they had.
#ifndef CRAQUELURE_DEFORM_LIQUID_H
#define CRAQUELURE_DEFORM_LIQUID_H

#include "network/network.h"

// Where liquid is and how much of it.
struct held_liquid {
    const double *liquid;     // (n_throat) m3
    const double *saturation; // (n_throat) 0 to 1: what they keep of their room first
    unsigned open_walls;      // bits of enum wall: their nodes touch the air
};

// SATURATION (n_throat, to be filled) of NETWORK, whose throats of kind THROAT_NETWORK
// have other volumes than those that held the liquid. Each piece of connected liquid
// first keeps its saturations. What that leaves over fills throats at its menisci, the
// narrowest first, as the suction there is largest; what it is short of leaves them,
// the widest first. Of equals that with the lowest index comes first. Returns what
// finds no room: m3 that leave the network. Where liquid is saturation times volume,
// saturations stay, bit for bit; otherwise the sum of the liquid is kept to rounding.
double redistribute_liquid(const struct network *network,
                           const struct held_liquid *held, double *saturation);

#endif
