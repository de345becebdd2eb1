// SPDX-License-Identifier: GPL-3.0-or-later
// How a long run of the discrete elements keeps its state on the way.
#ifndef CRAQUELURE_DEM_KEEP_H
#define CRAQUELURE_DEM_KEEP_H

#include "checkpoint/keeper.h"
#include "dem/dem.h"

// Gives KEEPER, whose time it is, the state of DEM and STAGE, which it frees.
void keep_state(const struct keeper *keeper, const struct dem *dem,
                struct array_list stage);

// Cycles that may pass between two questions: some tenths of a second's work. Where a
// run is cut makes no difference to it.
int64_t cycles_between_questions(int n_particle);

#endif
