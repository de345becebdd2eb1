// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in rising order. Comparing, not subtracting: differences of int may overflow.
// Equal numbers have no order here: qsort may leave them in any, so what carries more
// than the number needs a comparison of its own with a tie broken by index, or its
// bytes would depend on the C library.
#pragma once

#include <string.h>

// For qsort of int, of double (NAN has no place in that order) and of strings, byte by
// byte.
static inline int rising_ints(const void *a, const void *b)
{
    const int first = *(const int *)a, second = *(const int *)b;
    return (first > second) - (first < second);
}

static inline int rising_doubles(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

static inline int rising_texts(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

// Where the first of N sorted numbers is that is not below WANTED; N: none is. Binary
// search, O(log n). Of equal numbers the first one. SORTED (n) rises, equal numbers
// allowed.
static inline int first_not_below(const int *sorted, int n, int wanted)
{
    int low = 0, high = n;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (sorted[middle] < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
