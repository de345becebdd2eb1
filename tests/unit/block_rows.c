// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse rows of 3x3 blocks, filled in any order, against the same symmetric matrix in
// full: products, and the inverses of diagonal blocks, of which some are empty and one
// is singular.
#include "sparse/block_rows.h"
#include "../random.h"
#include "../test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { N = 40, SIZE = 3 * N, EMPTY = 7, SINGULAR = 11 };

static double full[SIZE][SIZE];

// Adds MORE to the block of row I and column J, and its transpose to that across.
static void add_to_full(int i, int j, const double more[9])
{
    for (int k = 0; k < 9; k++) {
        full[3 * i + k / 3][3 * j + k % 3] += more[k];
        if (i != j) full[3 * j + k % 3][3 * i + k / 3] += more[k];
    }
}

// Some columns of each row; the diagonal dominates.
static void draw_full(uint64_t *seed)
{
    memset(full, 0, sizeof full);
    for (int i = 0; i < N; i++)
        for (int entry = 0; entry < 6 && i != EMPTY; entry++) {
            const int j = entry == 0 ? i : (int)(next_random(seed) * N);
            if (j == EMPTY || (i == SINGULAR && j == i && entry != 0)) continue;
            double more[9];
            for (int k = 0; k < 9; k++)
                more[k] = i == SINGULAR && j == i
                              ? 6 * (k == 0 || k == 4)
                              : next_random(seed) + 20 * (i == j && k % 4 == 0);
            add_to_full(i, j, more);
        }
}

static bool is_in_full(int i, int j)
{
    for (int k = 0; k < 9; k++)
        if (full[3 * i + k / 3][3 * j + k % 3] != 0) return true;
    return false;
}

// Each block in two halves; columns from the right in every second row.
static struct block_rows filled(int32_t *order)
{
    struct block_rows rows = block_rows_init(N, order);
    for (int r = 0; r < N; r++) {
        const int i = rows.order[r];
        for (int turn = 0; turn < 2 * N; turn++) {
            const int j = r % 2 ? N - 1 - turn % N : turn % N;
            if (!is_in_full(i, j)) continue;
            double *block = block_rows_at(&rows, j);
            assert_int_equal(block == NULL, rows.rank[j] < r);
            for (int k = 0; k < 9 && block; k++)
                block[k] += 0.5 * full[3 * i + k / 3][3 * j + k % 3];
        }
        block_rows_end_row(&rows);
    }
    return rows;
}

static void check(bool in_order)
{
    uint64_t seed = 5;
    draw_full(&seed);
    struct block_rows rows = filled(in_order ? NULL : shuffled(N, &seed));
    double x[SIZE], image[SIZE], z[SIZE];
    for (int i = 0; i < SIZE; i++)
        x[i] = next_random(&seed) - 0.5;
    block_rows_multiply(&rows, x, image);
    for (int i = 0; i < SIZE; i++) {
        double sum = 0, sizes = 1;
        for (int j = 0; j < SIZE; j++) {
            sum += full[i][j] * x[j];
            sizes += fabs(full[i][j] * x[j]);
        }
        assert_true(fabs(image[i] - sum) <= 1e-14 * sizes);
    }
    block_rows_precondition(&rows, x, z);
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++) {
            const int at = 3 * i + a;
            double back = 0;
            for (int b = 0; b < 3; b++)
                back += full[at][3 * i + b] * z[3 * i + b];
            if (i == EMPTY)
                assert_true(z[at] == 0 && image[at] == 0);
            else if (i == SINGULAR)
                assert_true(fabs(z[at] - x[at] / 4) <= 1e-15); // trace 12
            else
                assert_true(fabs(back - x[at]) <= 1e-13);
        }
    block_rows_free(&rows);
}

TEST(as_in_full)
{
    check(true);
    check(false);
}
