// SPDX-License-Identifier: GPL-3.0-or-later
// Sorting of rows of a few integers, in linear time if few rows share their first key.
#pragma once

#include <stdint.h>

enum { ROW_KEYS = 5 };

struct row {
    int32_t key[ROW_KEYS]; // keys that are not used stay 0; the first is not below 0
    int32_t item;          // what the row stands for
};

// The order of COUNT rows by their keys and then by their items. Sorted by counting the
// first key, so that it is O(count) where few rows share one. The caller frees it.
int32_t *order_rows(struct row *rows, int count);

// Returns the rows in that order; frees ROWS. The caller frees the result.
struct row *sort_rows(struct row *rows, int count);

// Sorts a few rows in place, in the same order.
void sort_few_rows(struct row *rows, int count);
