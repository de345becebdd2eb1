// SPDX-License-Identifier: GPL-3.0-or-later
// The stress that the fluid carries, averaged over each pore.
#ifndef CRAQUELURE_FLOW_PORE_STRESS_H
#define CRAQUELURE_FLOW_PORE_STRESS_H

#include "pressures.h"

// Tension is positive. xx, yy, zz, yz, zx, xy.
struct pore_stress {
    double *volume;         // (n_pore) unit^3 of fluid: half of each throat of the pore
    double (*viscous)[6];   // (n_pore) Pa; 0 in a pore without volume
    double mean_viscous[6]; // over the fluid, Pa
};

// Viscosity times twice the mean rate of strain, which is what flows out through the
// facets of the pore, over its volume: by Gauss 1/V sum (u n + n u) over the facets,
// for the fluid sticks to the grains, with u along the normal n of each facet and of
// the wall through which the pore is fed. That leaves out slip along facets. What flows
// in flows out, so that the trace vanishes. Nothing may move. The caller frees with
// pore_stress_free.
struct pore_stress find_pore_stress(const struct grains *grains,
                                    const struct cells *cells,
                                    const struct throats *throats,
                                    const struct conditions *conditions,
                                    const struct pressures *pressures);
void pore_stress_free(struct pore_stress *stress);

#endif
