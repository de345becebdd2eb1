// SPDX-License-Identifier: GPL-3.0-or-later
// The pass over a large front, where it spends its time:
//     entry[i][j] += sum_k factor[k] pending[k][i] pending[k][j],  j < i.
// Each of dense_front_{avx2,avx512}_{double,float}.c includes it with SIMD_WIDTH,
// NUMBER (type of the entries), VECTOR and FMADD of that type, TILE_ROWS and VECTORS (a
// tile of that many rows and vectors stays in registers), and the names PASS and
// GATHER. Each entry sums its products with fused operations, in the order in which
// they are pending, so the digits do not depend on the vectors.
//
// Layout: entry (i, 0) is at dense_front_at(i, 0), those of its row are IN_ROW from it.
// Pending rows lie by blocks of BLOCK columns, and in a block one row after the other:
// pending[k][c] is number k BLOCK + c % BLOCK of block c / BLOCK. `weight` has
// factor[k] pending[k][i] for TILE_ROWS rows i, then for the next k; then the next
// tile. Entries are conductances in the units of the network.
#include "dense_front.h"

#include "basics/memory.h"
#include "basics/simd.h"

#include <stdlib.h>
#include <string.h>

enum {
    IS_DOUBLE = sizeof(NUMBER) == 8,
    LANES = sizeof(VECTOR) / sizeof(NUMBER),
    WIDTH = VECTORS * LANES,
    BLOCK =
        BLOCK_BYTES / sizeof(NUMBER), // columns; of all that wait they stay in cache
    MOST = IS_DOUBLE ? MAX_PENDING_DOUBLES : MAX_PENDING
};

// From column 0 to COLUMN of a row: floats lie in strips.
static inline size_t in_row(int column)
{
    if (IS_DOUBLE) return (size_t)column;
    return dense_front_strip_column(column);
}

// The block of column FIRST, a multiple of BLOCK.
static const NUMBER *pending_block(const struct dense_front *dense, int first)
{
    return (const NUMBER *)dense->pending + (size_t)first * MOST;
}

// TILE_ROWS rows of the entries, and their weights. Rows are those of one panel, so
// they have one length.
struct tile {
    NUMBER *row[TILE_ROWS];
    const NUMBER *weight; // (n_pending, TILE_ROWS)
};

// row[r][c] += sum_k weight[k][r] pending[k][c] for VECTORS vectors from COLUMN on. The
// sum starts from 0 and is added at once. memcpy, because PENDING need not be aligned
// for a vector; compilers make one load of it.
static inline void add_to_tile(const struct tile *tile, int column, int n_pending,
                               const NUMBER *pending)
{
    VECTOR sum[TILE_ROWS][VECTORS] = {0};
    for (int k = 0; k < n_pending; k++) {
        VECTOR part[VECTORS];
        memcpy(part, pending + (size_t)k * BLOCK, sizeof part);
#pragma GCC unroll 8
        for (int r = 0; r < TILE_ROWS; r++) {
            const VECTOR weight = tile->weight[k * TILE_ROWS + r] - (VECTOR){0};
#pragma GCC unroll 3
            for (int v = 0; v < VECTORS; v++)
                sum[r][v] = FMADD(weight, part[v], sum[r][v]);
        }
    }
#pragma GCC unroll 8
    for (int r = 0; r < TILE_ROWS; r++) {
#pragma GCC unroll 3
        for (int v = 0; v < VECTORS; v++) {
            VECTOR *to = (VECTOR *)__builtin_assume_aligned(
                tile->row[r] + in_row(column + v * LANES), sizeof(VECTOR));
            *to += sum[r][v];
        }
    }
}

// Rows BEGIN..END-1, columns FIRST..FIRST+BLOCK-1. WEIGHT: (rows, n_pending) by tiles.
// Rows above FIRST have no entries in these columns. The rows of the next tile are
// prefetched: they lie a whole row apart, which the processor does not foresee.
static void add_to_block(const struct dense_front *dense, int begin, int end, int first,
                         const NUMBER *weight)
{
    NUMBER *entry = dense->entry;
    const NUMBER *pending = pending_block(dense, first);
    const int n_pending = dense->n_pending;
    for (int i = begin > first ? begin : first; i < end; i += TILE_ROWS) {
        struct tile tile = {.weight = weight + (size_t)(i - begin) * (size_t)n_pending};
        const NUMBER *next[TILE_ROWS];
        for (int r = 0; r < TILE_ROWS; r++) {
            tile.row[r] = entry + dense_front_at(dense, i + r, 0);
            next[r] = entry + dense_front_at(dense, i + r + TILE_ROWS, 0);
        }
        const int width = (i / PANEL + 1) * PANEL;
        const int last = width < first + BLOCK ? width : first + BLOCK;
        for (int column = first; column < last; column += WIDTH) {
            for (int r = 0; r < TILE_ROWS; r++)
                for (int c = 0; c < WIDTH; c += 64 / (int)sizeof(NUMBER))
                    __builtin_prefetch(next[r] + in_row(column + c), 1);
            add_to_tile(&tile, column, n_pending, pending + (column - first));
        }
    }
}

// factor[k] pending[k][i] for rows BEGIN..END-1, by tiles. In the order in which tiles
// read them.
static void pack_weights(const struct dense_front *dense, int begin, int end,
                         NUMBER *weight)
{
    for (int i = begin; i < end; i += TILE_ROWS) {
        const NUMBER *pending = pending_block(dense, i / BLOCK * BLOCK) + i % BLOCK;
        for (int k = 0; k < dense->n_pending; k++)
            for (int r = 0; r < TILE_ROWS; r++)
                *weight++ = (NUMBER)dense->factor[k] * pending[k * BLOCK + r];
    }
}

// Rows in portions whose weights stay in the second-level cache; threads take portions,
// the widest first. The weights are the only allocation.
void PASS(struct dense_front *dense, int n)
{
    enum { ROWS = BLOCK };
    const int n_portion = (n + ROWS - 1) / ROWS;
#pragma omp parallel if (n > SHARED_FRONT)
    {
        NUMBER *weight = allocate_uncleared((size_t)ROWS * MOST, sizeof *weight);
#pragma omp for schedule(dynamic)
        for (int portion = n_portion - 1; portion >= 0; portion--) {
            const int begin = portion * ROWS;
            const int end = n < begin + ROWS ? n : begin + ROWS;
            pack_weights(dense, begin, end, weight);
            for (int first = 0; first < end; first += BLOCK)
                add_to_block(dense, begin, end, first, weight);
        }
        free(weight);
    }
}

// row[c] += sum_k weight[k] pending[k][c] for columns below N, so many vectors at a
// time that they come from memory one after the other. ROW stays in doubles where
// entries are floats.
void GATHER(const struct dense_front *dense, int n, const double *weight, double *row)
{
    enum { AT_ONCE = 9, COLUMNS = AT_ONCE * LANES };
    for (int first = 0; first < n; first += BLOCK) {
        const NUMBER *pending = pending_block(dense, first);
        for (int column = 0; column < BLOCK && first + column < n; column += COLUMNS) {
            VECTOR sum[AT_ONCE] = {0};
            for (int k = 0; k < dense->n_pending; k++) {
                VECTOR part[AT_ONCE];
                memcpy(part, pending + (size_t)k * BLOCK + column, sizeof part);
                const VECTOR times = (NUMBER)weight[k] - (VECTOR){0};
#pragma GCC unroll 9
                for (int v = 0; v < AT_ONCE; v++)
                    sum[v] = FMADD(times, part[v], sum[v]);
            }
            const int left = n - first - column;
            for (int c = 0; c < COLUMNS && c < left; c++)
                row[first + column + c] += (double)sum[c / LANES][c % LANES];
        }
    }
}
