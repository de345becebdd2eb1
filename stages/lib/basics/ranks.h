// SPDX-License-Identifier: GPL-3.0-or-later
// Falling order of many numbers (network/entry_order.h says what gas enters when). And
// a queue of ranks.
#pragma once

#include <stdbool.h>
#include <stdint.h>

// ORDER (n): indices of VALUE, descending, ties by index. O(n) but for long runs of
// values that are equal to nine digits and not quite. SAME (n), unless NULL: whether
// the value is that of the rank before to 12 digits. Values must be finite or infinite,
// not NAN. -0 and 0 are equal.
void rank_descending(const double *value, int n, int *order, bool *same);

// A set of numbers below N, kept as bits, bits for words of bits, and so on: adding and
// taking the lowest cost a few operations whatever the size. Memory: N bits and a
// sixty-fourth more; N below 2^31.
struct rank_queue {
    int n_level;
    uint64_t *level[6]; // the last has one word
};

// An empty one. The caller frees it with rank_queue_free.
struct rank_queue rank_queue_init(int n);

// 0 <= RANK < N. One that is in it already stays once.
void rank_queue_add(struct rank_queue *queue, int rank);

// Removes the lowest and returns it; -1 if there is none.
int rank_queue_take(struct rank_queue *queue);

void rank_queue_free(struct rank_queue *queue);
