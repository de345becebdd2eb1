// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure of the liquid at which gas enters a throat: that of the gas less the
// capillary pressure 2 sigma cos(theta) / r. Under gravity the liquid's pressure rises
// downwards, so lower throats are entered later.
#pragma once

#include "dry/conditions.h"

// In scaled units (conditions.h), pressures in the unit at which viscosity drops out of
// Poiseuille's law: flow = pi r^4 / (8 L) times the fall of pressure.
struct menisci {
    const struct network *network;
    double length;   // m, the unit
    double tension;  // 2 sigma cos(theta), in pressure times length
    double weight;   // rho g, in pressure over length; 0: no gravity
    double *radius;  // (n_throat)
    double *height;  // (n_throat) of the throat's middle; NULL: no gravity
    double pressure; // Pa, the unit
};

// The throats of NETWORK (kept) under CONDITIONS. Without viscosity the unit of
// pressure is the capillary pressure of a throat one mean length in radius. The caller
// frees it with menisci_free.
struct menisci menisci_init(const struct network *network,
                            const struct drying_conditions *conditions,
                            const struct drying_scale *scale);

// The potential (pressure and weight) at which gas enters THROAT, above that of
// REFERENCE. Exactly 0 for equal radii at one height; no digits are lost for radii that
// are nearly equal.
double menisci_potential(const struct menisci *menisci, int throat, int reference);

// Pressure at NODE, above that at the middle of THROAT, of liquid at rest.
double menisci_weight(const struct menisci *menisci, int throat, int node);

// Fills ENTRY_PRIORITY (n_throat) with the potentials at which gas enters the throats,
// for clusters_init: gas enters where it is largest.
void menisci_entry_priority(const struct menisci *menisci, double *entry_priority);

void menisci_free(struct menisci *menisci);
