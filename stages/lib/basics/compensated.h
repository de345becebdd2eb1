// SPDX-License-Identifier: GPL-3.0-or-later
// A running sum that keeps what rounding takes away (Neumaier 1974): a million small
// amounts off a large one leave an error of a few units in the last place.
#ifndef CRAQUELURE_COMPENSATED_H
#define CRAQUELURE_COMPENSATED_H

#include <math.h>

struct compensated {
    double value, lost;
};

static inline void compensated_add(struct compensated *sum, double x)
{
    const double total = sum->value + x;
    sum->lost += fabs(sum->value) >= fabs(x) ? (sum->value - total) + x
                                             : (x - total) + sum->value;
    sum->value = total;
}

static inline double compensated_value(struct compensated sum)
{
    return sum.value + sum.lost;
}

// A - B, without a loss of digits however near they are.
static inline double compensated_difference(struct compensated a, struct compensated b)
{
    return (a.value - b.value) + (a.lost - b.lost);
}

#endif
