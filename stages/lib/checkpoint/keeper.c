// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint/keeper.h"

void free_kept_state(struct kept_state *state)
{
    free_arrays(state->engine.array, state->engine.count);
    free_arrays(state->stage.array, state->stage.count);
    *state = (struct kept_state){{NULL, 0}, {NULL, 0}};
}

bool is_due(const struct keeper *keeper)
{
    return keeper && keeper->due && keeper->due(keeper->context);
}
