// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a few whole numbers, put in order in linear time.
#ifndef CRAQUELURE_ROWS_H
#define CRAQUELURE_ROWS_H

#include <stdint.h>

enum { ROW_KEYS = 5 };

struct row {
    int32_t key[ROW_KEYS]; // keys that are not used stay 0; the first is not below 0
    int32_t item;          // what the row stands for
};

// The order of COUNT rows by their keys and then by their items. Sorted by counting the
// first key, so that it is O(count) where few rows share one. The caller frees it.
int32_t *order_rows(struct row *rows, int count);

// The rows, which it takes over, in that order. The caller frees what it returns.
struct row *sort_rows(struct row *rows, int count);

// The same where they are, for few.
void sort_few_rows(struct row *rows, int count);

#endif
