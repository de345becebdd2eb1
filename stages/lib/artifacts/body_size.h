// SPDX-License-Identifier: GPL-3.0-or-later
// The sizes that costs are foreseen from, of an input or of a number of grains.
#pragma once

#include "costs/costs.h"
#include "parameters/stage.h"

// From the first input of INVOCATION, else from its number of grains and loads; exits
// 64 where neither was given. OPEN_WALLS (bits as in /nodes/kind) are the open sides;
// 0: as if one were open. Opens and checks the input as any stage does, so --estimate
// refuses what a run would refuse.
struct body_size input_size(const struct invocation *invocation, unsigned open_walls);
