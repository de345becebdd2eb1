// SPDX-License-Identifier: GPL-3.0-or-later
// For the separation a = -overlap, in the class k = floor(a / width),
//     count = number of pairs,   force = sum of f . n,
// n from the first grain to the second, on which f acts. The mean force of a class is
// the quotient, as [G 15].
#include "separations.h"

#include "basics/memory.h"
#include "sums.h"

#include <math.h>
#include <stdlib.h>

bool inside_band(const struct split_cell *cell, const struct band_fit *fit, double r,
                 double z)
{
    double centre, width;
    return fit && band_at(cell, fit, z, &centre, &width) && fabs(r - centre) < width;
}

void separations_free(struct separations *separations)
{
    free(separations->count);
    free(separations->force);
    *separations = (struct separations){0};
}

// Room for class K.
static void include_class(struct separations *separations, int64_t k)
{
    const struct separations old = *separations;
    const int64_t end = old.lowest + old.n;
    if (old.n > 0 && k >= old.lowest && k < end) return;
    const int64_t lowest = old.n == 0 || k < old.lowest ? k : old.lowest;
    const int64_t past = old.n == 0 || k >= end ? k + 1 : end;
    const size_t n = (size_t)(past - lowest), row = sizeof(double[ZONES]);
    struct separations grown = {.width = old.width,
                                .lowest = lowest,
                                .n = (int)n,
                                .count = allocate(n, row),
                                .force = allocate(n, row)};
    for (int kept = 0; kept < old.n; kept++)
        for (int zone = 0; zone < ZONES; zone++) {
            grown.count[old.lowest - lowest + kept][zone] = old.count[kept][zone];
            grown.force[old.lowest - lowest + kept][zone] = old.force[kept][zone];
        }
    separations_free(separations);
    *separations = grown;
}

void add_separations(struct separations *separations, const struct motion *motion,
                     int s, const struct frame *frame, const struct split_cell *cell,
                     const struct band_fit *fit)
{
    static const double most = 1e6; // classes on either side: more are no table
    for (int64_t k = motion->contact_first[s]; k < motion->contact_first[s + 1]; k++) {
        struct vector from, along;
        if (motion->pair[k][1] < 0 || !branch_of(motion, s, k, &from, &along)) continue;
        const double class = floor(-motion->overlap[k] / separations->width);
        const int64_t in = (int64_t)fmin(fmax(class, -most), most);
        include_class(separations, in);
        const struct place place = place_of(frame, motion->point[k]);
        const int zone = inside_band(cell, fit, place.at[0], place.at[2]);
        const size_t row = (size_t)(in - separations->lowest);
        separations->count[row][zone]++;
        separations->force[row][zone] +=
            dot(motion->force[k], contact_normal(motion, s, k));
    }
}
