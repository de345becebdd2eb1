// SPDX-License-Identifier: GPL-3.0-or-later
// The growing arrays of a history, and how a checkpoint keeps them. Three tables that
// only grow: steps, events, and the changes between two steps, of which step k has the
// rows change_offset[k] to change_offset[k + 1] - 1. Storing changes in place of the
// saturations of all throats at all steps is what keeps long runs small.
//
// The arrays of a table share one capacity and grow together.
#include "history.h"

#include "basics/memory.h"
#include "film_history.h"
#include "ring_history.h"

#include <stdlib.h>

struct recorder recorder_init(struct drying_history *history)
{
    *history = (struct drying_history){.change_offset = NEW_ARRAY(int64_t, 1)};
    return (struct recorder){.history = history};
}

// A copy of the capacity for the first array, so that the second still sees the old
// one.
void recorder_add_change(struct recorder *recorder, int throat, double saturation)
{
    struct drying_history *history = recorder->history;
    int64_t capacity = recorder->change_capacity;
    GROW_ARRAY(history->change_throat, recorder->n_change, capacity);
    GROW_ARRAY(history->change_saturation, recorder->n_change,
               recorder->change_capacity);
    history->change_throat[recorder->n_change] = throat;
    history->change_saturation[recorder->n_change] = saturation;
    recorder->n_change++;
}

void recorder_add_event(struct recorder *recorder, double time, int throat,
                        enum event_kind kind)
{
    struct drying_history *history = recorder->history;
    if (history->n_event == recorder->event_capacity) {
        const int capacity =
            recorder->event_capacity ? 2 * recorder->event_capacity : 64;
        const size_t n = (size_t)capacity;
        history->event_time = reallocate(history->event_time, n, sizeof(double));
        history->event_throat = reallocate(history->event_throat, n, sizeof(int32_t));
        history->event_kind = reallocate(history->event_kind, n, sizeof(uint8_t));
        recorder->event_capacity = capacity;
    }
    history->event_time[history->n_event] = time;
    history->event_throat[history->n_event] = throat;
    history->event_kind[history->n_event] = (uint8_t)kind;
    history->n_event++;
}

// One more offset than there are steps: the last is where the next step begins.
void recorder_add_step(struct recorder *recorder, double time, double saturation,
                       double rate, int clusters)
{
    struct drying_history *history = recorder->history;
    if (history->n_step == recorder->step_capacity) {
        const int capacity = recorder->step_capacity ? 2 * recorder->step_capacity : 64;
        const size_t n = (size_t)capacity;
        history->time = reallocate(history->time, n, sizeof(double));
        history->saturation = reallocate(history->saturation, n, sizeof(double));
        history->rate = reallocate(history->rate, n, sizeof(double));
        history->clusters = reallocate(history->clusters, n, sizeof(int32_t));
        history->change_offset =
            reallocate(history->change_offset, n + 1, sizeof(int64_t));
        recorder->step_capacity = capacity;
    }
    const int step = history->n_step++;
    history->time[step] = time;
    history->saturation[step] = saturation;
    history->rate[step] = rate;
    history->clusters[step] = clusters;
    history->change_offset[step + 1] = recorder->n_change;
}

void recorder_set_last_rate(struct recorder *recorder, double rate)
{
    recorder->history->rate[recorder->history->n_step - 1] = rate;
}

// --- state -------------------------------------------------------------------------

// The number of rows comes first, with the first array.
static void events_state(struct recorder *recorder, int n_throat,
                         struct checkpoint_stream *stream)
{
    struct drying_history *history = recorder->history;
    int64_t n = history->n_event;
    stream_count(stream, &n);
    history->event_time = stream_room(stream, history->event_time, n, sizeof(double));
    history->event_throat = stream_room(stream, history->event_throat, n, sizeof(int));
    history->event_kind = stream_room(stream, history->event_kind, n, 1);
    if (stream->restoring) history->n_event = recorder->event_capacity = (int)n;
    stream_numbers(stream, history->event_time, n);
    stream_integers(stream, history->event_throat, n, 0, n_throat - 1);
    stream_bytes(stream, history->event_kind, n, EVENT_REFILLED);
}

static void changes_state(struct recorder *recorder, int n_place,
                          struct checkpoint_stream *stream)
{
    struct drying_history *history = recorder->history;
    int64_t n = recorder->n_change;
    stream_count(stream, &n);
    history->change_throat =
        stream_room(stream, history->change_throat, n, sizeof(int));
    history->change_saturation =
        stream_room(stream, history->change_saturation, n, sizeof(double));
    if (stream->restoring) recorder->n_change = recorder->change_capacity = n;
    stream_integers(stream, history->change_throat, n, 0, n_place - 1);
    stream_numbers(stream, history->change_saturation, n);
}

// Offsets must not point behind the changes that there are; that they rise is checked
// by run_fits.
static void steps_state(struct recorder *recorder, int n_throat,
                        struct checkpoint_stream *stream)
{
    struct drying_history *history = recorder->history;
    int64_t n = history->n_step;
    stream_count(stream, &n);
    history->time = stream_room(stream, history->time, n, sizeof(double));
    history->saturation = stream_room(stream, history->saturation, n, sizeof(double));
    history->rate = stream_room(stream, history->rate, n, sizeof(double));
    history->clusters = stream_room(stream, history->clusters, n, sizeof(int32_t));
    history->change_offset = // there is room for one more
        stream_room(stream, history->change_offset, n, sizeof(int64_t));
    if (stream->restoring) history->n_step = recorder->step_capacity = (int)n;
    stream_numbers(stream, history->time, n);
    stream_numbers(stream, history->saturation, n);
    stream_numbers(stream, history->rate, n);
    stream_integers(stream, history->clusters, n, 0, n_throat);
    for (int64_t k = 0; k <= n; k++) {
        stream_long(stream, &history->change_offset[k]);
        stream->failed |= history->change_offset[k] > recorder->n_change;
    }
}

void recorder_state(struct recorder *recorder, int n_throat, int n_place,
                    struct checkpoint_stream *stream)
{
    events_state(recorder, n_throat, stream);
    changes_state(recorder, n_place, stream);
    steps_state(recorder, n_throat, stream);
    stream_numbers(stream, &recorder->history->breakthrough_saturation, 1);
    stream_numbers(stream, &recorder->history->first_period_end_saturation, 1);
    stream_numbers(stream, &recorder->history->first_period_end_time, 1);
}

// -----------------------------------------------------------------------------------

void drying_history_free(struct drying_history *history)
{
    free(history->time);
    free(history->saturation);
    free(history->rate);
    free(history->clusters);
    free(history->event_time);
    free(history->event_throat);
    free(history->event_kind);
    free(history->change_offset);
    free(history->change_throat);
    free(history->change_saturation);
    free(history->pressure);
    ring_history_free(history->rings);
    film_history_free(history->films);
    *history = (struct drying_history){0};
}
