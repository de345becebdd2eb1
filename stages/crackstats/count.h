// SPDX-License-Identifier: GPL-3.0-or-later
// Counting cracks [K Table 5.2, Figs. 5.18, 5.19].
#ifndef CRAQUELURE_COUNT_H
#define CRAQUELURE_COUNT_H

#include <stdint.h>

enum { MODE_NORMAL, MODE_SHEAR, MODE_COUNT };
enum { PERIOD_FIRST, PERIOD_SECOND, PERIOD_COUNT };

// The cracks of one run, as response.h5 holds them.
struct cracks {
    int count, bonds;
    double *time;            // (count) s
    uint8_t *mode;           // (count) 0 normal, 1 shear
    double *height;          // (count) m, of the bond where it began
    double first_period_end; // s
    double bottom, top;      // m, z walls
};

// How many, by mode and drying period, and by mode and slice from the bottom up.
struct counts {
    double period[PERIOD_COUNT][MODE_COUNT];
    double (*slice)[MODE_COUNT]; // (n_slice)
};

// A crack at the very end of the first period counts there; one on the border of two
// slices counts in the lower. The caller frees .slice.
struct counts count_cracks(const struct cracks *cracks, int n_slice);

#endif
