// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static int compare_rows(const void *a, const void *b)
{
    const struct row *first = a, *second = b;
    for (int k = 0; k < ROW_KEYS; k++)
        if (first->key[k] != second->key[k])
            return first->key[k] < second->key[k] ? -1 : 1;
    return (first->item > second->item) - (first->item < second->item);
}

void sort_few_rows(struct row *rows, int count)
{
    enum { FEW = 32 };
    if (count > FEW) {
        qsort(rows, (size_t)count, sizeof *rows, compare_rows);
        return;
    }
    for (int k = 1; k < count; k++) {
        const struct row row = rows[k];
        int to = k;
        for (; to > 0 && compare_rows(&rows[to - 1], &row) > 0; to--)
            rows[to] = rows[to - 1];
        rows[to] = row;
    }
}

struct row *sort_rows(struct row *rows, int count)
{
    int32_t largest = 0;
    for (int k = 0; k < count; k++)
        if (rows[k].key[0] > largest) largest = rows[k].key[0];
    // Filling moves each offset one on, so that first key i ends where i + 1 begins.
    int *offset = NEW_ARRAY(int, (size_t)largest + 3);
    for (int k = 0; k < count; k++)
        offset[rows[k].key[0] + 2]++;
    for (int32_t i = 0; i < largest; i++)
        offset[i + 2] += offset[i + 1];
    struct row *sorted = allocate_uncleared((size_t)count, sizeof *sorted);
    for (int k = 0; k < count; k++)
        sorted[offset[rows[k].key[0] + 1]++] = rows[k];
    free(rows);
#pragma omp parallel for
    for (int32_t i = 0; i <= largest; i++)
        sort_few_rows(sorted + offset[i], offset[i + 1] - offset[i]);
    free(offset);
    return sorted;
}
