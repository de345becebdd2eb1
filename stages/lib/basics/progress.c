// SPDX-License-Identifier: GPL-3.0-or-later
// Time left. With `elapsed` since the beginning, `since` since the last estimate,
//     at_mean_speed = elapsed / fraction - elapsed,
//     now_left = left - since,
//     left = now_left + (at_mean_speed - now_left) min(since / memory, 1),
//     memory = 2 s + elapsed / 4:
// the estimate counts down by itself and approaches the one by the mean speed slowly.
#include "basics/progress.h"

#include <math.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 40 };

double seconds_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

struct progress progress_begin(enum progress_mode mode, bool quiet)
{
    const double start = seconds_now();
    const bool terminal = mode == PROGRESS_AUTO && !quiet && isatty(STDERR_FILENO);
    return (struct progress){.shown = terminal || mode == PROGRESS_ALWAYS,
                             .started = start,
                             .last_draw = mode == PROGRESS_ALWAYS ? 0 : start + 0.9,
                             .left = -1};
}

double progress_time_left(double elapsed, double fraction, double left, double since)
{
    const double at_mean_speed = elapsed / fraction - elapsed;
    if (left < 0) return at_mean_speed;
    const double memory = 2 + 0.25 * elapsed; // s
    const double now_left = left - since;
    const double followed =
        now_left + (at_mean_speed - now_left) * fmin(since / memory, 1);
    return fmax(followed, 0);
}

// Nothing is said of the first second: work begins unlike it goes on.
static void draw_time_left(struct progress *progress, double elapsed, double fraction,
                           double since)
{
    if (elapsed < 1 || !(fraction > 0)) return;
    progress->left = progress_time_left(elapsed, fraction, progress->left, since);
    fprintf(stderr, "  %.0f s left ", progress->left);
}

void progress_update(void *of, double fraction)
{
    struct progress *progress = of;
    if (!progress->shown) return;
    const double time = seconds_now();
    if (time - progress->last_draw < 0.1) return;
    const double since = time - progress->last_draw;
    progress->last_draw = time;
    progress->drawn = true;

    char bar[BAR_WIDTH + 1];
    for (int k = 0; k < BAR_WIDTH; k++)
        bar[k] = k < fraction * BAR_WIDTH ? '#' : '.';
    bar[BAR_WIDTH] = 0;
    fprintf(stderr, "\r[%s] %5.1f %%", bar, 100 * fraction);
    draw_time_left(progress, time - progress->started, fraction, since);
}

void progress_end(struct progress *progress)
{
    if (progress->drawn) fprintf(stderr, "\r\033[K");
    progress->drawn = false;
}
