// SPDX-License-Identifier: GPL-3.0-or-later
// What films of finite resistance do, step by step, beside the history of the throats.
#pragma once

#include "dry/inviscid/emptying_times.h"

// Depths are below the nearest open wall, of nodes that films reach: their menisci's
// radius is above 0.
struct film_history {
    int n, capacity;       // steps
    double *evaporation;   // (n) kg/s from nodes without liquid in throats, which films
                           // bring there
    double *depth;         // (n) m, mean; 0 without such nodes
    double *deepest;       // (n) m
    double *depth_of_node; // (n_node) m; NULL before the first step
    double evaporated;     // kg: integral of the evaporation, over all events
    int64_t solutions;     // of the flow in films
};

// Empty. The caller frees it with film_history_free; NULL is allowed.
struct film_history *film_history_create(void);
void film_history_free(struct film_history *films);

// Adds a step, the state of TIMES now. RATE (kg/s) and the unit of length of the
// occupancy scale it. O(n_node).
void film_history_add(struct film_history *films, const struct emptying_times *times,
                      unsigned open_walls, double rate);

// Writes to STREAM, or restores from it, the steps so far.
void film_history_state(struct film_history *films, struct checkpoint_stream *stream);
