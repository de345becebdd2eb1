// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of the fluid on grains and walls [C 2.3]: its pressure on the sectors of
// the facets [C 14], and the drag of what flows between them [C 18]. Moments are not
// found.
#pragma once

#include "pressures.h"

// In Pa unit^2: times the square of grains.unit in N. It owns .viscous and .pressure.
struct forces {
    struct vector *viscous, *pressure; // (n_base) [C 18, 14]
    struct vector wall_viscous[WALL_COUNT], wall_pressure[WALL_COUNT];
    struct vector velocity; // mean over the box, solid included; for a viscosity of 1
    double mean_pressure;   // in the fluid, Pa
};

// The force on a wall is that of the fluid inside. Over all grains and walls the forces
// sum to 0, or in a periodic box to minus the mean gradient times the volume of the
// box. The caller frees with forces_free. The mean pressure is over the volumes of the
// throats. O(throats). With drop p_i - p_j, normal n, sectors and fluid part of the
// facet: pressure sector_k (p_i - p_j) n on corner k [C 14], viscous A^f (p_i - p_j) n
// shared by surfaces [C 17, 18].
struct forces find_forces(const struct grains *grains, const struct cells *cells,
                          const struct throats *throats,
                          const struct pressures *pressures);
void forces_free(struct forces *forces);
