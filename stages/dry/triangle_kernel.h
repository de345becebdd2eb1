// SPDX-License-Identifier: GPL-3.0-or-later
// Products added to a large triangle: where large fronts spend their time. Included
// with NUMBER (the type of the entries), BYTES of a vector (32 or 64), TILE_ROWS (so
// that a tile of that many rows and two vectors stays in registers) and UPDATE (a
// name). Every entry gains the sum of its products, each fused with those before in the
// order of the sources: the digits do not depend on the vectors.
#include "triangle.h"

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
    WIDTH = 2 * LANES,
    BLOCK = 512 / sizeof(NUMBER) // columns; those of all sources stay in cache
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

struct tile {
    NUMBER *row[TILE_ROWS];
    const NUMBER *weight; // (n_source, TILE_ROWS)
};

static inline void add_to_tile(const struct tile *tile, int column, int n_source,
                               const NUMBER *source)
{
    lanes sum[TILE_ROWS][2] = {0};
    for (int k = 0; k < n_source; k++) {
        lanes part[2];
        memcpy(part, source + (size_t)k * BLOCK, sizeof part);
        for (int r = 0; r < TILE_ROWS; r++) {
            const lanes weight = tile->weight[k * TILE_ROWS + r] - (lanes){0};
            sum[r][0] = fused(weight, part[0], sum[r][0]);
            sum[r][1] = fused(weight, part[1], sum[r][1]);
        }
    }
    for (int r = 0; r < TILE_ROWS; r++) {
        lanes *to = (lanes *)__builtin_assume_aligned(tile->row[r] + column, BYTES);
        to[0] += sum[r][0];
        to[1] += sum[r][1];
    }
}

// Columns FIRST..FIRST+BLOCK-1 of all rows. WEIGHT: (rows, n_source) by tiles.
static void add_to_columns(const struct triangle *triangle, int n, int first,
                           int n_source, const NUMBER *weight, const NUMBER *source)
{
    NUMBER *entry = triangle->entry;
    for (int i = first / TILE_ROWS * TILE_ROWS; i < n; i += TILE_ROWS) {
        struct tile tile = {.weight = weight + (size_t)i * (size_t)n_source};
        const NUMBER *next[TILE_ROWS];
        for (int r = 0; r < TILE_ROWS; r++) {
            tile.row[r] = entry + triangle_row(triangle, i + r);
            next[r] = entry + triangle_row(triangle, i + r + TILE_ROWS);
        }
        const int width = (i / PANEL + 1) * PANEL;
        const int end = width < first + BLOCK ? width : first + BLOCK;
        for (int column = first; column < end; column += WIDTH) {
            for (int r = 0; r < TILE_ROWS; r++)
                for (int line = 0; line < 2 * BYTES; line += 64)
                    __builtin_prefetch((const char *)(next[r] + column) + line, 1);
            add_to_tile(&tile, column, n_source, source + (column - first));
        }
    }
}

static void pack_columns(int n, int first, int n_source, const double *const *source,
                         NUMBER *packed)
{
    for (int k = 0; k < n_source; k++)
        for (int c = 0; c < BLOCK; c++)
            packed[k * BLOCK + c] = first + c < n ? (NUMBER)source[k][first + c] : 0;
}

static NUMBER *pack_weights(int n, int n_source, const double *factor,
                            const double *const *source)
{
    const size_t tiles = ((size_t)n + TILE_ROWS - 1) / TILE_ROWS;
    NUMBER *weight = NEW_ARRAY(NUMBER, tiles * TILE_ROWS * (size_t)n_source);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n_source; k++)
            weight[((size_t)(i / TILE_ROWS) * (size_t)n_source + (size_t)k) *
                       TILE_ROWS +
                   (size_t)(i % TILE_ROWS)] = (NUMBER)(factor[k] * source[k][i]);
    return weight;
}

void UPDATE(struct triangle *triangle, int n, int n_source, const double *factor,
            const double *const *source)
{
    NUMBER *weight = pack_weights(n, n_source, factor, source);
    NUMBER packed[MOST_SOURCES * BLOCK] __attribute__((aligned(64)));
    for (int first = 0; first < n; first += BLOCK) {
        pack_columns(n, first, n_source, source, packed);
        add_to_columns(triangle, n, first, n_source, weight, packed);
    }
    free(weight);
}
