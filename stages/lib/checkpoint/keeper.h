// SPDX-License-Identifier: GPL-3.0-or-later
// How a long run lets its state be kept on the way, and goes on from one that was. An
// engine knows only this interface; files, clock and signals are those of
// artifacts/checkpoint.h. Without a keeper (NULL) a run is as if there were none.
#ifndef CRAQUELURE_CHECKPOINT_KEEPER_H
#define CRAQUELURE_CHECKPOINT_KEEPER_H

#include "checkpoint/named_arrays.h"

// Arrays of the engine, and of the stage that runs it.
struct kept_state {
    struct array_list engine, stage;
};

struct keeper {
    // Asked often; whether it is time to keep the state. NULL: it never is.
    bool (*due)(void *context);
    // Need not return: the run may end here.
    void (*keep)(void *context, const struct kept_state *stream);
    void *context;
    const struct kept_state *begin; // to go on from; NULL: begin at the beginning
};

// Frees both lists and empties them.
void free_kept_state(struct kept_state *stream);

// Whether it is time to keep the state; never with NULL.
bool is_due(const struct keeper *keeper);

#endif
