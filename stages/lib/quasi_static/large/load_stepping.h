// SPDX-License-Identifier: GPL-3.0-or-later
// Load stepping: the residual of the last equilibrium is applied by increments, past
// limit points too.
#ifndef CRAQUELURE_LOAD_STEPPING_H
#define CRAQUELURE_LOAD_STEPPING_H

#include "large_state.h"

// STATUS_NOT_CONVERGED: equilibrium ends at a limit point, and dynamics finds no rest;
// or it takes too long.
enum status step_load(struct quasi_static *qs, struct reason *reason);

#endif
