// SPDX-License-Identifier: GPL-3.0-or-later
// Counting sort by the first key, then a comparison sort in each of its short groups,
// in parallel. Rows themselves are not moved: their indices are, and sort_rows copies
// each row once in the end.
//     offset[key + 2]   counts rows of a first key, then is summed to where key + 1
//                       begins;
//     order[offset[key + 1]++]   filling, which moves this one to where key ends.
// The last key is the item, which no two rows share, so the order is one whatever the
// threads do. Groups of up to 32 rows are sorted by insertion, larger ones by qsort_r.
//
// O(count + largest first key) in time and memory while groups are short: first keys
// are to be numbers such as those of nodes or grains, not sparse ones, and not below 0.
// Comparisons jump about in memory; rows of a group are asked for some 32 ahead.
#include "sort_rows.h"

#include "basics/memory.h"

#include <stdlib.h>

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

// Compares rows by their indices; for qsort_r.
static int compare_numbered(const void *a, const void *b, void *rows)
{
    const struct row *row = rows;
    return compare_rows(&row[*(const int32_t *)a], &row[*(const int32_t *)b]);
}

static void order_few_rows(struct row *rows, int32_t *order, int count)
{
    enum { FEW = 32 };
    if (count > FEW) {
        qsort_r(order, (size_t)count, sizeof *order, compare_numbered, rows);
        return;
    }
    for (int k = 1; k < count; k++) {
        const int32_t row = order[k];
        int to = k;
        for (; to > 0 && compare_rows(&rows[order[to - 1]], &rows[row]) > 0; to--)
            order[to] = order[to - 1];
        order[to] = row;
    }
}

int32_t *order_rows(struct row *rows, int count)
{
    enum { AHEAD = 32 };
    int32_t largest = 0;
    for (int k = 0; k < count; k++)
        if (rows[k].key[0] > largest) largest = rows[k].key[0];
    // Filling moves each offset one on, so that first key i ends where i + 1 begins.
    int *offset = NEW_ARRAY(int, (size_t)largest + 3);
    for (int k = 0; k < count; k++)
        offset[rows[k].key[0] + 2]++;
    for (int32_t i = 0; i < largest; i++)
        offset[i + 2] += offset[i + 1];
    int32_t *order = allocate_uncleared((size_t)count, sizeof *order);
    for (int k = 0; k < count; k++)
        order[offset[rows[k].key[0] + 1]++] = k;
#pragma omp parallel for
    for (int32_t i = 0; i <= largest; i++) {
        for (int k = offset[i] + AHEAD; k < offset[i + 1] + AHEAD && k < count; k++)
            __builtin_prefetch(&rows[order[k]]);
        order_few_rows(rows, order + offset[i], offset[i + 1] - offset[i]);
    }
    free(offset);
    return order;
}

struct row *sort_rows(struct row *rows, int count)
{
    int32_t *order = order_rows(rows, count);
    struct row *sorted = allocate_uncleared((size_t)count, sizeof *sorted);
    for (int k = 0; k < count; k++)
        sorted[k] = rows[order[k]];
    free(order);
    free(rows);
    return sorted;
}
