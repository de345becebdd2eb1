// SPDX-License-Identifier: GPL-3.0-or-later
// How a long run of discrete elements keeps its state at intervals.
#pragma once

#include "checkpoint/keeper.h"
#include "dem/dem.h"

// Gives KEEPER, whose time it is, the state of DEM and of the stage. Frees STAGE. It
// may not return: a keeper may end the program once the state is on disk. STAGE becomes
// part of what is kept, under /stage; that of the engine goes under /engine
// (artifacts/checkpoint.h). Call it between two dem_run, only when is_due(KEEPER).
// O(state) in time and memory.
void keep_state(const struct keeper *keeper, const struct dem *dem,
                struct array_list stage);

// Cycles between two looks at the keeper's clock: some tenths of a second of work.
// Where a run is cut makes no difference to its results. 1 + 1e6 / (1 + n_particle), at
// least 1.
int64_t cycles_between_questions(int n_particle);
