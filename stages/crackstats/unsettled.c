// SPDX-License-Identifier: GPL-3.0-or-later
// A crack has the time of the load that it opened under. Both lists rise in time, so
// one pass finds the load of every crack.
#include "unsettled.h"

int unsettled_cracks(const struct run *run, const struct loads *loads)
{
    int count = 0;
    for (int k = 0, step = 0; k < run->n_crack; k++) {
        while (loads->time[step] < run->time[k])
            step++; // never past the last: no crack is later
        count += !loads->settled[step];
    }
    return count;
}
