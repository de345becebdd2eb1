// SPDX-License-Identifier: GPL-3.0-or-later
// Sorting: with lowest and highest the extreme keys, and shift the least for which
// highest - lowest fits in KEY_BITS,
//     key = bits of the value, ordered as values are, larger values lower,
//     from = (key - lowest) >> shift, then the index, in one 64-bit word.
// Three passes by 11-bit digits order `from` (radix sort, stable). The shift may make
// different values equal: runs of one leading part are then sorted by value. Two
// neighbours are the same where before - value <= 2^-40 |before|, about 1e-12.
//
// Queue: bit k of a level is set when word k of the level below it is not 0.
#include "basics/ranks.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- ranks -------------------------------------------------------------------------

enum { DIGIT_BITS = 11, DIGITS = 3, KEY_BITS = DIGIT_BITS * DIGITS, INDEX_BITS = 31 };

// Sorts as the value does, but larger ones get lower keys.
static uint64_t key_of(double value)
{
    const uint64_t sign = UINT64_C(1) << 63;
    const double same = value + 0.0; // no -0
    uint64_t bits;
    memcpy(&bits, &same, sizeof bits);
    return bits & sign ? bits : ~(bits | sign);
}

static void sort_by_digit(const uint64_t *from, uint64_t *to, int n, int digit)
{
    static const uint64_t mask = (1u << DIGIT_BITS) - 1;
    const int shift = INDEX_BITS + digit * DIGIT_BITS;
    int place[1 << DIGIT_BITS] = {0};
    for (int i = 0; i < n; i++)
        place[from[i] >> shift & mask]++;
    for (int d = 0, sum = 0; d < 1 << DIGIT_BITS; d++) {
        const int count = place[d];
        place[d] = sum;
        sum += count;
    }
    for (int i = 0; i < n; i++)
        to[place[from[i] >> shift & mask]++] = from[i];
}

struct ranked {
    double value;
    int index;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *r = a, *s = b;
    if (r->value != s->value) return r->value > s->value ? -1 : 1;
    return (r->index > s->index) - (r->index < s->index);
}

// Puts in order a run of the same leading bits; those that are equal are in order.
static void sort_run(const double *value, int *order, int n)
{
    bool sorted = true;
    for (int k = 1; k < n; k++)
        sorted &= value[order[k - 1]] >= value[order[k]];
    if (sorted) return;
    struct ranked *run = NEW_ARRAY(struct ranked, n);
    for (int k = 0; k < n; k++)
        run[k] = (struct ranked){value[order[k]], order[k]};
    qsort(run, (size_t)n, sizeof *run, compare_ranked);
    for (int k = 0; k < n; k++)
        order[k] = run[k].index;
    free(run);
}

// Most ranks are told apart by the KEY of their values, which lie in order in memory as
// the values do not.
static void find_same(const double *value, int n, const int *order, const uint64_t *key,
                      int shift, bool *same)
{
    static const double tolerance = 0x1p-40;
    const uint64_t near = (UINT64_C(1) << 13 >> shift) + 1; // 2^13 last bits are more
    for (int k = 0; k < n; k++) {
        same[k] = k > 0 && (key[k] >> INDEX_BITS) - (key[k - 1] >> INDEX_BITS) <= near;
        if (!same[k]) continue;
        const double before = value[order[k - 1]];
        same[k] = before - value[order[k]] <= tolerance * fabs(before);
    }
}

void rank_descending(const double *value, int n, int *order, bool *same)
{
    uint64_t lowest = UINT64_MAX, highest = 0;
    for (int i = 0; i < n; i++) {
        const uint64_t key = key_of(value[i]);
        lowest = key < lowest ? key : lowest;
        highest = key > highest ? key : highest;
    }
    int shift = 0;
    while (n > 0 && (highest - lowest) >> shift >> KEY_BITS)
        shift++;
    uint64_t *from = NEW_ARRAY(uint64_t, n), *to = NEW_ARRAY(uint64_t, n);
    for (int i = 0; i < n; i++)
        from[i] = (key_of(value[i]) - lowest) >> shift << INDEX_BITS | (uint64_t)i;
    for (int digit = 0; digit < DIGITS; digit++) {
        sort_by_digit(from, to, n, digit);
        uint64_t *swap = from;
        from = to;
        to = swap;
    }
    for (int i = 0; i < n; i++)
        order[i] = (int)(from[i] & ((UINT64_C(1) << INDEX_BITS) - 1));
    for (int begin = 0, end; begin < n; begin = end) {
        for (end = begin + 1;
             end < n && from[end] >> INDEX_BITS == from[begin] >> INDEX_BITS;)
            end++;
        sort_run(value, order + begin, end - begin);
    }
    if (same) find_same(value, n, order, from, shift, same);
    free(from);
    free(to);
}

// --- queue -------------------------------------------------------------------------

struct rank_queue rank_queue_init(int n)
{
    struct rank_queue queue = {0};
    do {
        n = n / 64 + 1;
        queue.level[queue.n_level++] = NEW_ARRAY(uint64_t, n);
    } while (n > 1);
    return queue;
}

void rank_queue_add(struct rank_queue *queue, int rank)
{
    for (int level = 0; level < queue->n_level; level++) {
        uint64_t *word = &queue->level[level][rank / 64];
        const uint64_t before = *word;
        *word |= UINT64_C(1) << rank % 64;
        if (before) return;
        rank /= 64;
    }
}

int rank_queue_take(struct rank_queue *queue)
{
    if (queue->level[queue->n_level - 1][0] == 0) return -1;
    int rank = 0;
    for (int level = queue->n_level - 1; level >= 0; level--)
        rank = 64 * rank + __builtin_ctzll(queue->level[level][rank]);
    for (int level = 0, place = rank; level < queue->n_level; level++) {
        uint64_t *word = &queue->level[level][place / 64];
        *word &= *word - 1; // the lowest bit
        if (*word) break;
        place /= 64;
    }
    return rank;
}

void rank_queue_free(struct rank_queue *queue)
{
    for (int level = 0; level < queue->n_level; level++)
        free(queue->level[level]);
    *queue = (struct rank_queue){0};
}
