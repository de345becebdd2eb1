// SPDX-License-Identifier: GPL-3.0-or-later
// For the separation a = -overlap, in the class k = floor(a / width),
//     count = number of pairs,   force = sum of f . n,
// n from the first grain to the second, on which f acts. The mean force of a class is
// the quotient, as [G 15].
//
// The first class may be negative (overlaps), so classes have numbers of 64 bits and
// the array grows at both ends. A class is far narrower than a grain: a thousandth of a
// diameter, by default.
#include "separations.h"

#include "basics/memory.h"
#include "sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool inside_band(const struct split_cell *cell, const struct band_fit *fit, double r,
                 double z)
{
    double centre, width;
    return fit && band_at(cell, fit, z, &centre, &width) && fabs(r - centre) < width;
}

void separations_free(struct separations *separations)
{
    free(separations->class);
    *separations = (struct separations){0};
}

// Room for class K, with the classes between. memmove: the old classes shift up inside
// the grown array, over themselves.
static void include_class(struct separations *separations, int64_t k)
{
    const int64_t lowest = separations->lowest, n = separations->n;
    if (n > 0 && k >= lowest && k < lowest + n) return;
    const int64_t first = n == 0 || k < lowest ? k : lowest;
    const int64_t past = n == 0 || k >= lowest + n ? k + 1 : lowest + n;
    const int64_t before = n == 0 ? 0 : lowest - first, all = past - first;
    struct separation_class *class =
        reallocate(separations->class, (size_t)all, sizeof *class);
    memmove(class + before, class, (size_t)n * sizeof *class);
    for (int64_t at = 0; at < all; at++)
        if (at < before || at >= before + n) class[at] = (struct separation_class){0};
    separations->class = class;
    separations->lowest = first;
    separations->n = (int)all;
}

// Contacts with walls have no second grain, and do not count. What lies beyond MOST
// goes to the outermost class, so that one absurd separation cannot exhaust the memory.
void add_separations(struct separations *separations, const struct motion *motion,
                     int s, const struct frame *frame, const struct split_cell *cell,
                     const struct band_fit *fit)
{
    static const double most = 1e6; // classes on either side: more are no table
    for (int64_t k = motion->contact_first[s]; k < motion->contact_first[s + 1]; k++) {
        struct vector from, along;
        if (motion->pair[k][1] < 0 || !branch_of(motion, s, k, &from, &along)) continue;
        const double place_in = floor(-motion->overlap[k] / separations->width);
        const int64_t in = (int64_t)fmin(fmax(place_in, -most), most);
        include_class(separations, in);
        const struct place place = place_of(frame, motion->point[k]);
        const int zone = inside_band(cell, fit, place.at[0], place.at[2]);
        struct separation_class *class = &separations->class[in - separations->lowest];
        class->count[zone]++;
        class->force[zone] += dot(motion->force[k], contact_normal(motion, s, k));
    }
}
