// SPDX-License-Identifier: GPL-3.0-or-later
// A progress bar with the time left, on standard error.
//
// A stage calls _begin once, _update as often as it likes, _end before it prints
// anything. It reads the clock, so it must not decide anything in the computation. For
// one thread.
#pragma once

#include <stdbool.h>

// The three choices of --progress.
enum progress_mode { PROGRESS_AUTO, PROGRESS_ALWAYS, PROGRESS_NEVER };

// A value: nothing to free. All zeros is one that never draws.
struct progress {
    bool shown;       // whether this run may draw at all
    bool drawn;       // whether there is a line to clear
    double started;   // s
    double last_draw; // s
    double left;      // s, as shown last; below 0: not yet
};

// Seconds of a clock that nobody sets.
double seconds_now(void);

// AUTO draws only on a terminal, and only once the work has lasted a second. QUIET wins
// over all modes.
struct progress progress_begin(enum progress_mode mode, bool quiet);

// FRACTION done, 0 to 1, of the struct progress at OF: computations call it back.
// Cheap: draws at most ten times a second.
void progress_update(void *of, double fraction);

// The time left (s) when FRACTION has been done ELAPSED seconds after the beginning,
// and LEFT (below 0: nothing) was said SINCE seconds ago. Work is seldom even: what is
// said follows what the whole would take at the mean speed so far, but slowly.
double progress_time_left(double elapsed, double fraction, double left, double since);

// Clears the line if there is one; the caller may print then.
void progress_end(struct progress *progress);
