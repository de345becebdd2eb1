// SPDX-License-Identifier: GPL-3.0-or-later
// What a run will take, for --estimate.
#pragma once

#include "costs/costs.h"
#include "scene.h"

// Of a run of SCENE to the end of its duration; `range` from where it may stop earlier
// and to twice as many time steps where the engine may shorten them. STATUS_BAD_DATA
// and STATUS_NOT_CONVERGED as the run itself would end before its first cycle. SCENE is
// not const because its number of threads is set.
enum status foresee_run(const struct simulate_parameters *parameters,
                        struct scene *scene, struct cost *cost, struct reason *reason);
