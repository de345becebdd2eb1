// SPDX-License-Identifier: GPL-3.0-or-later
#include "load_path.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// The numbers of loads, COUNT each; those of a line FROM a load on are compared BY the
// one that grows most, to what ROUNDING leaves of forces as large as these.
struct line {
    long count;
    const double *number;
    int from;
    long by;
    double rounding;
};

static const double *load_of(const struct line *line, int k)
{
    return line->number + k * line->count;
}

static void begin_line(struct line *line, int from)
{
    const double *a = load_of(line, from), *b = load_of(line, from + 1);
    double most = 0;
    line->from = from;
    line->by = 0;
    for (long i = 0; i < line->count; i++) {
        if (fabs(b[i] - a[i]) > fabs(b[line->by] - a[line->by])) line->by = i;
        most = fabs(a[i]) > most ? fabs(a[i]) : most;
    }
    line->rounding = 8 * DBL_EPSILON * most;
}

// How far load K is on the way to load TO.
static double way(const struct line *line, int to, int k)
{
    const long by = line->by;
    const double from = load_of(line, line->from)[by],
                 all = load_of(line, to)[by] - from;
    return k == to ? 1 : all != 0 ? (load_of(line, k)[by] - from) / all : 0;
}

static bool is_on_way(const struct line *line, int to, int k)
{
    const double share = way(line, to, k);
    const double *a = load_of(line, line->from), *b = load_of(line, to);
    const double *between = load_of(line, k);
    int64_t is_off = 0;
    for (long i = 0; i < line->count; i++)
        is_off |=
            !(fabs(between[i] - (a[i] + share * (b[i] - a[i]))) <= line->rounding);
    return !is_off;
}

static void end_line(struct load_path *p, const struct line *line, int to)
{
    for (int k = line->from; k <= to; k++) {
        p->after[k] = p->corners - 1;
        p->share[k] = way(line, to, k);
    }
    p->corner[p->corners++] = to;
}

// A line goes on as long as the load before the next lies on it.
void find_load_path(struct load_path *p, int n, int count, const struct vector *force)
{
    struct line line = {.count = 3L * n, .number = &force->x};
    *p = (struct load_path){.count = 1, .corners = 1};
    while (p->count < count && p->count < ON_PATH && p->corners < LANES) {
        begin_line(&line, p->count - 1);
        int to = p->count;
        while (to + 1 < count && to + 1 < ON_PATH && is_on_way(&line, to + 1, to))
            to++;
        end_line(p, &line, to);
        p->count = to + 1;
    }
}

void path_shares(const struct load_path *p, int first, double share[LANES][LANES])
{
    memset(share, 0, LANES * sizeof *share);
    for (int l = 0; l < LANES && first + l < p->count; l++) {
        const int after = p->after[first + l];
        share[after][l] = 1 - p->share[first + l];
        if (after + 1 < p->corners) share[after + 1][l] = p->share[first + l];
    }
}
