// SPDX-License-Identifier: GPL-3.0-or-later
// The two small calls that every long run shares; artifacts/checkpoint.c says when a
// state is due and what keeps it.
#include "checkpoint/keeper.h"

void free_kept_state(struct kept_state *stream)
{
    free_arrays(stream->engine.array, stream->engine.count);
    free_arrays(stream->stage.array, stream->stage.count);
    *stream = (struct kept_state){{NULL, 0}, {NULL, 0}};
}

bool is_due(const struct keeper *keeper)
{
    return keeper && keeper->due && keeper->due(keeper->context);
}
