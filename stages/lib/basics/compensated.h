// SPDX-License-Identifier: GPL-3.0-or-later
// A running sum that keeps what rounding takes away (Neumaier 1974): a million small
// amounts off a large one leave an error of a few units in the last place. With s the
// value and x what is added,
//     total = fl(s + x),  lost += (larger - total) + smaller,
// larger and smaller of s and x by size. -ffast-math would drop it all.
//
// Use one for a sum of many terms that is read on the way (time, evaporated mass, the
// angle of a group), and for a number whose small differences matter (pressures of
// pores that are nearly equal). A residual can be a double: it is computed anew.
// A sum takes two numbers, and about four operations more for each term. Threads must
// not share one.
#pragma once

#include <math.h>

// The sum is value + lost; {0} is the empty sum, {x} begins at x. Both parts must be
// kept in a checkpoint: their sum alone would go on with other digits.
struct compensated {
    double value, lost;
};

// Adds X, of any sign and size. The error of one addition is exact as computed here,
// and the errors are summed plainly.
static inline void compensated_add(struct compensated *sum, double x)
{
    const double total = sum->value + x;
    sum->lost += fabs(sum->value) >= fabs(x) ? (sum->value - total) + x
                                             : (x - total) + sum->value;
    sum->value = total;
}

// The sum, rounded once.
static inline double compensated_value(struct compensated sum)
{
    return sum.value + sum.lost;
}

// A - B, without a loss of digits however near they are. Values and lost parts are
// subtracted separately: two rounded sums would cancel.
static inline double compensated_difference(struct compensated a, struct compensated b)
{
    return (a.value - b.value) + (a.lost - b.lost);
}
