// SPDX-License-Identifier: GPL-3.0-or-later
// Products added to a large triangle: where large fronts spend their time. Included
// with NUMBER (the type of the entries), BYTES of a vector (32 or 64), TILE_ROWS and
// VECTORS (so that a tile of that many rows and vectors stays in registers), and the
// names PASS and GATHER. Every entry gains the sum of its products, each fused with
// those before in the order in which they wait: the digits do not depend on the
// vectors.
#include "dense_front.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#if defined __x86_64__ && defined __FMA__
#include <immintrin.h>
#endif

typedef NUMBER lanes __attribute__((vector_size(BYTES)));

enum {
    LANES = BYTES / sizeof(NUMBER),
    WIDTH = VECTORS * LANES,
    BLOCK = BLOCK_BYTES / sizeof(NUMBER) // columns; of all that wait they stay in cache
};

static inline lanes fused(lanes a, lanes b, lanes c)
{
#if defined __x86_64__ && defined __FMA__ && BYTES == 64
    return _Generic((NUMBER)0, double
                    : (lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c), float
                    : (lanes)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c));
#elif defined __x86_64__ && defined __FMA__
    return _Generic((NUMBER)0, double
                    : (lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c), float
                    : (lanes)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c));
#else
    for (int l = 0; l < LANES; l++)
        c[l] = _Generic((NUMBER)0, double : fma, float : fmaf)(a[l], b[l], c[l]);
    return c;
#endif
}

static const NUMBER *waiting_block(const struct dense_front *dense, int first)
{
    return (const NUMBER *)dense->waiting + (size_t)first * MOST_SOURCES;
}

struct tile {
    NUMBER *row[TILE_ROWS];
    const NUMBER *weight; // (n_waiting, TILE_ROWS)
};

static inline void add_to_tile(const struct tile *tile, int column, int n_waiting,
                               const NUMBER *waiting)
{
    lanes sum[TILE_ROWS][VECTORS] = {0};
    for (int k = 0; k < n_waiting; k++) {
        lanes part[VECTORS];
        memcpy(part, waiting + (size_t)k * BLOCK, sizeof part);
#pragma GCC unroll 8
        for (int r = 0; r < TILE_ROWS; r++) {
            const lanes weight = tile->weight[k * TILE_ROWS + r] - (lanes){0};
#pragma GCC unroll 3
            for (int v = 0; v < VECTORS; v++)
                sum[r][v] = fused(weight, part[v], sum[r][v]);
        }
    }
#pragma GCC unroll 8
    for (int r = 0; r < TILE_ROWS; r++) {
        lanes *to = (lanes *)__builtin_assume_aligned(tile->row[r] + column, BYTES);
#pragma GCC unroll 3
        for (int v = 0; v < VECTORS; v++)
            to[v] += sum[r][v];
    }
}

// Rows BEGIN..END-1, columns FIRST..FIRST+BLOCK-1. WEIGHT: (rows, n_waiting) by tiles.
static void add_to_block(const struct dense_front *dense, int begin, int end, int first,
                         const NUMBER *weight)
{
    NUMBER *entry = dense->entry;
    const NUMBER *waiting = waiting_block(dense, first);
    const int n_waiting = dense->n_waiting;
    for (int i = begin > first ? begin : first; i < end; i += TILE_ROWS) {
        struct tile tile = {.weight = weight + (size_t)(i - begin) * (size_t)n_waiting};
        const NUMBER *next[TILE_ROWS];
        for (int r = 0; r < TILE_ROWS; r++) {
            tile.row[r] = entry + dense_front_row(dense, i + r);
            next[r] = entry + dense_front_row(dense, i + r + TILE_ROWS);
        }
        const int width = (i / PANEL + 1) * PANEL;
        const int last = width < first + BLOCK ? width : first + BLOCK;
        for (int column = first; column < last; column += WIDTH) {
            for (int r = 0; r < TILE_ROWS; r++)
                for (int line = 0; line < VECTORS * BYTES; line += 64)
                    __builtin_prefetch((const char *)(next[r] + column) + line, 1);
            add_to_tile(&tile, column, n_waiting, waiting + (column - first));
        }
    }
}

// Of all that wait, times their factors: of rows BEGIN..END-1, by tiles.
static void pack_weights(const struct dense_front *dense, int begin, int end,
                         NUMBER *weight)
{
    for (int i = begin; i < end; i += TILE_ROWS) {
        const NUMBER *waiting = waiting_block(dense, i / BLOCK * BLOCK) + i % BLOCK;
        for (int k = 0; k < dense->n_waiting; k++)
            for (int r = 0; r < TILE_ROWS; r++)
                *weight++ = (NUMBER)dense->factor[k] * waiting[k * BLOCK + r];
    }
}

// As many rows at once as their weights stay in the second cache.
void PASS(struct dense_front *dense, int n)
{
    enum { ROWS = 4 * BLOCK };
    NUMBER *weight = allocate_uncleared((size_t)ROWS * MOST_SOURCES, sizeof *weight);
    for (int begin = 0; begin < n; begin += ROWS) {
        const int end = n < begin + ROWS ? n : begin + ROWS;
        pack_weights(dense, begin, end, weight);
        for (int first = 0; first < end; first += BLOCK)
            add_to_block(dense, begin, end, first, weight);
    }
    free(weight);
}

void GATHER(const struct dense_front *dense, int n, const double *weight, double *row)
{
    for (int first = 0; first < n; first += BLOCK) {
        const NUMBER *waiting = waiting_block(dense, first);
        for (int column = 0; column < BLOCK && first + column < n;
             column += 3 * LANES) {
            lanes sum[3] = {0};
            for (int k = 0; k < dense->n_waiting; k++) {
                lanes part[3];
                memcpy(part, waiting + k * BLOCK + column, sizeof part);
                const lanes times = (NUMBER)weight[k] - (lanes){0};
                for (int v = 0; v < 3; v++)
                    sum[v] = fused(times, part[v], sum[v]);
            }
            const int left = n - first - column;
            for (int c = 0; c < 3 * LANES && c < left; c++)
                row[first + column + c] += (double)sum[c / LANES][c % LANES];
        }
    }
}
