// SPDX-License-Identifier: GPL-3.0-or-later
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
