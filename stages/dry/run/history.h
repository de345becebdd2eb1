// SPDX-License-Identifier: GPL-3.0-or-later
// Writes down the run, step by step.
#ifndef CRAQUELURE_HISTORY_H
#define CRAQUELURE_HISTORY_H

#include "checkpoint/stream.h"
#include "drying.h"

// A history that grows; it has no step yet.
struct recorder {
    struct drying_history *history;
    int step_capacity;
    int event_capacity;
    int64_t n_change, change_capacity;
};

// Starts HISTORY, which is overwritten. It is complete after each recorder_add_step.
struct recorder recorder_make(struct drying_history *history);

// A step's changes come before the step itself, ascending in throats.
void recorder_add_change(struct recorder *recorder, int throat, double saturation);
void recorder_add_event(struct recorder *recorder, double time, int throat,
                        enum event_kind kind);
void recorder_add_step(struct recorder *recorder, double time, double saturation,
                       double rate, int clusters);

// Of the step added last.
void recorder_set_last_rate(struct recorder *recorder, double rate);

// For a network of N_THROAT throats. Pressures are not in it.
void recorder_state(struct recorder *recorder, int n_throat,
                    struct checkpoint_stream *stream);

#endif
