// SPDX-License-Identifier: GPL-3.0-or-later
// How well gas and liquid flow and diffuse from inlet to outlet while gas replaces
// liquid: relative permeabilities and diffusivities.
#pragma once

#include "outcome.h"

enum property { PERMEABILITY, DIFFUSIVITY, PROPERTIES };
enum phase { GAS, LIQUID_PHASE, PHASES };

struct transport {
    int n; // states: first; when the saturation first is 0.9, 0.8, ... 0.1 or less; last
    double *saturation;                   // (n) falling
    double *relative[PHASES][PROPERTIES]; // (n) each, of what one phase alone has

    // Conductances from inlet to outlet when one phase fills all throats: volume flow
    // times viscosity over the fall of pressure (m3), and amount over the fall of
    // concentration and the diffusivity (m).
    double conductance[PROPERTIES];
    // These as if the box were of one material: times its length over its section, m2
    // and 1. Where inlet and outlet are not the two sides of one axis, or the network
    // does not reach them, NAN.
    double material[PROPERTIES];
};

// A throat of kind THROAT_NETWORK conducts as the network says (hydraulic_conductance,
// diffusive_conductance); nodes do not resist. A phase passes through the throats it
// fills and the nodes it holds (gas has arrived there, or has not); those of inlet and
// outlet are open to both. Balances are solved until their errors add up to at most
// 1e-10 of the flow; if rounding prevents that, the network is eliminated. The caller
// frees TRANSPORT with transport_free, also after a failure.
//
// STATUS_BAD_DATA: nothing leads from inlet to outlet, or a node is on both, or a
// throat has no length. STATUS_NOT_CONVERGED: conductances too far apart in a network
// too large to eliminate.
enum status transport_find(const struct network *network,
                           const struct invasion_conditions *conditions,
                           const struct outcome *outcome, struct transport *transport,
                           struct reason *reason);

void transport_free(struct transport *transport);
