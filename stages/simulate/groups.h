// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains belong to which group, and how groups begin. A grain is of one group at
// most. A group gives its grains a material, an initial velocity and spin, or, if it is
// driven, a motion as one rigid body.
//
// Groups are numbered from 0 in the order of their names; `group_of` has 1 + that
// number, 0 for none. Driven groups have a second numbering of their own, that of the
// engine, in `driven_group` and `driven_of`.
#pragma once

#include "scene.h"

// Fills group_of, driven_of, driven, and the initial velocity and spin of SCENE.
// STATUS_BAD_DATA: two groups want one grain, a group has none, or a grain that is not
// there. VELOCITY (n_particle) m/s, from the packing; NULL: grains begin at rest. A
// group's own initial velocity, if given, replaces it. The arrays are SCENE's, freed by
// scene_free also after a failure. The key of the offending group stands first in
// REASON. O(groups n_particle).
enum status read_groups(const struct simulate_parameters *parameters,
                        const struct packing *packing, const struct vector *velocity,
                        struct scene *scene, struct reason *reason);
