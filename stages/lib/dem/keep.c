// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the engine and of its stage, given to a keeper (checkpoint/keeper.h).
// Between two questions lie about a million moves of a grain.
#include "dem/keep.h"

void keep_state(const struct keeper *keeper, const struct dem *dem,
                struct array_list stage)
{
    struct kept_state state = {.stage = stage};
    state.engine.array = dem_save(dem, &state.engine.count);
    keeper->keep(keeper->context, &state);
    free_kept_state(&state);
}

int64_t cycles_between_questions(int n_particle)
{
    return 1 + 1000000 / (1 + n_particle);
}
