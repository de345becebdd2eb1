// SPDX-License-Identifier: GPL-3.0-or-later
// Load stepping: the residual of the last equilibrium is applied by increments, past
// limit points too.
#pragma once

#include "large_state.h"

// STATUS_NOT_CONVERGED: equilibrium ends at a limit point, and dynamics finds no rest;
// or it takes too long.
enum status step_load(struct quasi_static *qs, struct reason *reason);
