// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static/quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void take_off_turning(const struct equilibrium *e, const struct displacement *moved,
                      struct displacement *left)
{
    for (int j = 0; j < e->n_joint; j++) {
        const int32_t *grain = e->joint[j].grain;
        double of_ends[12] = {0}, turning[12] = {0};
        for (int end = 0; end < 2; end++)
            if (grain[end] >= 0)
                memcpy(of_ends + 6 * end, &moved[grain[end]], sizeof *moved);
        for (int r = 0; r < 12; r++)
            for (int c = 0; c < 12; c++)
                turning[r] += e->large->more[j].block[r][c] * of_ends[c];
        for (int end = 0; end < 2; end++) {
            struct displacement part;
            memcpy(&part, turning + 6 * end, sizeof part);
            if (grain[end] >= 0) pull(&left[grain[end]], part);
        }
    }
}

static double square(const struct displacement *a, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += dot(a[i].shift, a[i].shift) + dot(a[i].turn, a[i].turn);
    return sum;
}

// Pressed together it is a pencil on its tip: alone, without what is taken off, the
// loads of joints turn it over. What it resists a turn as one with, however that is
// coupled to others, is at most P = |K N| / |N|, and K + 2 P is positive where K is for
// all other motions.
double hold_of(const struct equilibrium *e)
{
    struct vector *moved = displaced(e);
    struct displacement *turn = NEW_ARRAY(struct displacement, e->n);
    struct displacement *load = NEW_ARRAY(struct displacement, e->n);
    const struct whole there = whole_of(e->packing, e->is_gone, moved);
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        struct vector about = {0, 0, 0};
        set_component(&about, axis, 1);
        for (int i = 0; i < e->n; i++) {
            const struct vector arm =
                scale(there.length / e->length, whole_place(&there, i));
            turn[i] = e->is_gone[i] ? no_displacement
                                    : (struct displacement){cross(about, arm), about};
        }
        memset(load, 0, (size_t)e->n * sizeof *load);
        take_off_turning(e, turn, load);
        const double size = square(turn, e->n);
        if (size > 0) sum += square(load, e->n) / size;
    }
    free(moved);
    free(turn);
    free(load);
    return 2 * sqrt(sum) + 1e3 * e->soft[1];
}
