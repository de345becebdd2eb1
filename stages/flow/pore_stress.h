// SPDX-License-Identifier: GPL-3.0-or-later
// The viscous stress of the fluid, averaged over each pore.
#pragma once

#include "pressures.h"

// Tension is positive. xx, yy, zz, yz, zx, xy. The pressure is not in it.
struct pore_stress {
    double *volume;         // (n_pore) unit^3 of fluid: half of each throat of the pore
    double (*viscous)[6];   // (n_pore) Pa; 0 in a pore without volume
    double mean_viscous[6]; // over the fluid, Pa
};

// Viscosity times twice the mean rate of strain of each pore: by Gauss' theorem 1/V sum
// (u n + n u) over its facets, since the fluid sticks to the grains, with u along the
// normal n of each facet and of the wall through which the pore is fed. This leaves out
// slip along facets. Inflow equals outflow, so the trace vanishes. Grains and walls
// must be at rest. The caller frees with pore_stress_free. O(throats).
struct pore_stress find_pore_stress(const struct grains *grains,
                                    const struct cells *cells,
                                    const struct throats *throats,
                                    const struct conditions *conditions,
                                    const struct pressures *pressures);
void pore_stress_free(struct pore_stress *stress);
