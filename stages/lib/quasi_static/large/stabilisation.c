// SPDX-License-Identifier: GPL-3.0-or-later
// A free body under pressure is a pencil on its tip: without the net moment that is
// taken off, the loads of pairs would turn it over, so K has negative directions of
// rigid rotation. What K resists a rigid rotation N with is at most P = |K N| / |N|,
// however that is coupled to other motions, and K + 2 P is positive where K is for all
// others.
#include "stabilisation.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void subtract_geometric_load(const struct quasi_static *qs,
                             const struct displacement *moved,
                             struct displacement *residual)
{
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        double of_ends[12] = {0}, turning[12] = {0};
        for (size_t end = 0; end < 2; end++)
            if (grain[end] >= 0)
                memcpy(of_ends + 6 * end, &moved[grain[end]], sizeof *moved);
        for (int r = 0; r < 12; r++)
            for (int c = 0; c < 12; c++)
                turning[r] += qs->large->geometric[j].block[r][c] * of_ends[c];
        for (size_t end = 0; end < 2; end++) {
            struct displacement part;
            memcpy(&part, turning + 6 * end, sizeof part);
            if (grain[end] >= 0) displacement_subtract(&residual[grain[end]], part);
        }
    }
}

static double square(const struct displacement *a, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum +=
            dot(a[i].translation, a[i].translation) + dot(a[i].rotation, a[i].rotation);
    return sum;
}

double find_stabilisation(const struct quasi_static *qs)
{
    struct vector *moved = displacements_in_metres(qs);
    struct displacement *turn = NEW_ARRAY(struct displacement, qs->n);
    struct displacement *load = NEW_ARRAY(struct displacement, qs->n);
    const struct whole there = whole_of(qs->packing, qs->is_detached, moved);
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        struct vector about = {0, 0, 0};
        set_component(&about, axis, 1);
        for (int i = 0; i < qs->n; i++) {
            const struct vector arm =
                scale(there.length / qs->length, whole_place(&there, i));
            turn[i] = qs->is_detached[i]
                          ? no_displacement
                          : (struct displacement){cross(about, arm), about};
        }
        memset(load, 0, (size_t)qs->n * sizeof *load);
        subtract_geometric_load(qs, turn, load);
        const double size = square(turn, qs->n);
        if (size > 0) sum += square(load, qs->n) / size;
    }
    free(moved);
    free(turn);
    free(load);
    return 2 * sqrt(sum) + 1e3 * qs->regularisation[1];
}
