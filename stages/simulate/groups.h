// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains belong to which group, and how groups begin.
#ifndef CRAQUELURE_SIMULATE_GROUPS_H
#define CRAQUELURE_SIMULATE_GROUPS_H

#include "scene.h"

// Fills group_of, driven_of, driven, and the initial velocity and spin of SCENE.
// STATUS_BAD_DATA: two groups want one grain, a group has none, or a grain that is not
// there.
enum status read_groups(const struct simulate_parameters *parameters,
                        const struct packing *packing, const struct vector *velocity,
                        struct scene *scene, struct reason *reason);

#endif
