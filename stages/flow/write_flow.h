// SPDX-License-Identifier: GPL-3.0-or-later
// The flow as an artifact, or as the forces of one. Both begin with the packing.
#pragma once

#include "artifacts/artifact.h"
#include "forces.h"
#include "pore_stress.h"

// All results, in the units of the computation. It owns nothing.
struct flow {
    const struct packing *packing;
    const struct grains *grains;
    const struct cells *cells;
    const struct throats *throats;
    const struct pressures *pressures;
    const struct forces *forces;
    const double *opening; // (n_pore); NULL: nothing moves
    double viscosity;      // Pa s
    struct vector weight;  // density of the fluid times gravity, N m-3
    double permeability;   // m2; NAN: none
    double bed_share;      // of the box along the flow, that grains reach over
    const struct vector
        *permeability_columns; // (3) of the permeability tensor; NULL: not asked for
    const struct pore_stress *stress; // NULL: not asked for
};

// Writes FLOW, in SI units, to an artifact of schema flow; the caller finishes it.
// docs/flow.md and schemas/flow.json say what the datasets are. Of several cells that
// are one pore, what belongs to the pore stands at the first; the others have 0, so
// that sums over rows are right.
void put_flow(struct artifact *artifact, const struct flow *flow);

// Writes the total force on each grain, growing from 0 over STEPS times one second
// apart, to an artifact of schema forces. The saturation is 1 throughout: dem-replay
// takes these forces as it takes those of a drying. STEPS is at least 2.
void put_forces(struct artifact *artifact, const struct flow *flow, int steps);
