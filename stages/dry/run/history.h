// SPDX-License-Identifier: GPL-3.0-or-later
// Records the run, step by step, in a struct drying_history (drying.h). Steps, events
// and changes are three tables of different lengths; change_offset ties changes to
// steps.
#pragma once

#include "checkpoint/stream.h"
#include "drying.h"

// A history that grows, and the capacities of its arrays. It does not own HISTORY;
// drying_history_free frees the arrays.
struct recorder {
    struct drying_history *history;
    int step_capacity;
    int event_capacity;
    int64_t n_change, change_capacity;
};

// Starts HISTORY, which is overwritten. It is complete after each recorder_add_step.
// HISTORY must live as long as the recorder, which has nothing to free.
struct recorder recorder_init(struct drying_history *history);

// A step's changes come before the step itself, ascending in throats. SATURATION from 0
// to 1, of THROAT from this step on.
void recorder_add_change(struct recorder *recorder, int throat, double saturation);
// At TIME (s), not before the last one; THROAT by its index in the network.
void recorder_add_event(struct recorder *recorder, double time, int throat,
                        enum event_kind kind);
// TIME in s, SATURATION 0 to 1 of the network, RATE in kg/s from here on, CLUSTERS of
// liquid. Takes all changes added since the last step.
void recorder_add_step(struct recorder *recorder, double time, double saturation,
                       double rate, int clusters);

// Sets the rate of the step added last.
void recorder_set_last_rate(struct recorder *recorder, double rate);

// Writes the history to STREAM, or restores it, for a network of N_THROAT throats, with
// changes at N_PLACE places, throats and the rings of nodes. All but its pressures:
// resume.c keeps these.
void recorder_state(struct recorder *recorder, int n_throat, int n_place,
                    struct checkpoint_stream *stream);
