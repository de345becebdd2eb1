// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 40 };

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

struct progress progress_begin(enum progress_mode mode, bool quiet)
{
    const double start = now();
    const bool terminal = mode == PROGRESS_AUTO && !quiet && isatty(STDERR_FILENO);
    return (struct progress){.shown = terminal || mode == PROGRESS_ALWAYS,
                             .started = start,
                             .last_draw = mode == PROGRESS_ALWAYS ? 0 : start + 0.9};
}

void progress_update(struct progress *progress, double fraction)
{
    if (!progress->shown) return;
    const double time = now();
    if (time - progress->last_draw < 0.1) return;
    progress->last_draw = time;
    progress->drawn = true;

    char bar[BAR_WIDTH + 1];
    for (int k = 0; k < BAR_WIDTH; k++)
        bar[k] = k < fraction * BAR_WIDTH ? '#' : '.';
    bar[BAR_WIDTH] = 0;
    const double elapsed = time - progress->started;
    fprintf(stderr, "\r[%s] %5.1f %%", bar, 100 * fraction);
    if (fraction > 0) fprintf(stderr, "  %.0f s left ", elapsed / fraction - elapsed);
}

void progress_end(struct progress *progress)
{
    if (progress->drawn) fprintf(stderr, "\r\033[K");
    progress->drawn = false;
}
