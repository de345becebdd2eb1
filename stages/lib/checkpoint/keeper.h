// SPDX-License-Identifier: GPL-3.0-or-later
// How a long run lets its state be kept on the way, and goes on from one that was. An
// engine knows only this interface; files, clock and signals are those of
// artifacts/checkpoint.h. Without a keeper (NULL) a run is as if there were none.
//
// What an engine does with one, where KEEPER may be NULL:
//     if (keeper && keeper->begin) restore(engine, keeper->begin);
//     while (!done) {
//         advance(engine);
//         if (is_due(keeper)) keeper->keep(keeper->context, &state);
//     }
// A state may only be kept where a run in one piece and one that went on from it do the
// same from there. What an engine holds for speed alone (factors, lists) must therefore
// be dropped at moments that do not depend on the keeper, or be part of the state.
#pragma once

#include "checkpoint/named_arrays.h"

// Arrays of the engine, and of the stage that runs it.
struct kept_state {
    struct array_list engine, stage;
};

struct keeper {
    // Asked often; whether it is time to keep the state. NULL: it never is.
    bool (*due)(void *context);
    // Need not return: the run may end here.
    void (*keep)(void *context, const struct kept_state *stream); // copied
    void *context;
    const struct kept_state *begin; // to go on from; NULL: begin at the beginning
};

// Frees both lists and empties them. Safe on an empty one.
void free_kept_state(struct kept_state *stream);

// Whether it is time to keep the state; never with NULL. Reads a clock: to be asked
// some times a second, not in inner loops.
bool is_due(const struct keeper *keeper);
