// SPDX-License-Identifier: GPL-3.0-or-later
// Counting cracks [K Table 5.2, Figs. 5.18, 5.19].
#pragma once

#include "run.h"

// The drying periods: that of a nearly constant rate, and what follows.
enum { PERIOD_FIRST, PERIOD_SECOND, PERIOD_COUNT };

// The numbers of equal classes of heights, saturations and times.
struct classes {
    int n_slice;    // of the height of the box, from the bottom up
    int n_interval; // of the saturation, from 1 down; of the drying time, from the
                    // start
};

// Numbers of cracks, by mode and drying period, height, saturation and time. Of one
// run, or sums over runs. Counts are multiples of 1/2 by height, whole elsewhere. It
// owns its arrays.
struct counts {
    double period[PERIOD_COUNT][MODE_COUNT];
    double (*slice)[MODE_COUNT];      // (n_slice)
    double (*saturation)[MODE_COUNT]; // (n_interval)
    double (*time)[MODE_COUNT];       // (n_interval)
    double *place;                    // (n_interval, n_slice) of saturation; both modes
};

// The class of SHARE, 0 to 1, among N equal ones. On the border of two, to rounding, it
// is the lower: intervals include their upper ends.
int class_of(double share, int n);

// The two slices, among N of the box, that count half each of what lies at the height
// Z, m: the same slice twice, except on the border of two, where bonds between two
// layers of a lattice lie. So a body upside down has its profile upside down. What lies
// beyond a side counts in the outermost slice, or in its image where the box repeats.
struct slices {
    int slice[2];
};
struct slices slices_at(const struct packing *packing, double z, int n);

// The slices, among N, in which a crack of BOND counts: by the initial height of the
// bond, so that one between two layers stays on their border however the grains have
// moved.
struct slices slices_of_bond(const struct packing *packing, int bond, int n);

// All 0, in the shapes of CLASSES. The caller frees them with counts_free.
struct counts counts_init(struct classes classes);
void counts_free(struct counts *counts);

// Sets ALL to the cracks of both periods.
void count_all(double all[MODE_COUNT], const struct counts *counts);

// Adds the cracks of RUN. One at the very end of the first period counts there. Classes
// of time are of the time of the last load; a run that ends at 0 has all cracks in the
// first.
void count_cracks(struct counts *counts, const struct run *run, struct classes classes);
