// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse rows of 3x3 blocks against the same matrix in full: products, and the inverses
// of diagonal blocks, of which some are empty and one is singular.
#include "sparse/block_rows.h"
#include "../random.h"
#include "../test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { N = 40, SIZE = 3 * N, EMPTY = 7, SINGULAR = 11 };

static double full[SIZE][SIZE];

// Of each row some columns, added to more than once; the diagonal dominates.
static struct block_rows filled(uint64_t *seed)
{
    memset(full, 0, sizeof full);
    struct block_rows rows = block_rows_init(N);
    for (int i = 0; i < N; i++) {
        for (int entry = 0; entry < 12 && i != EMPTY; entry++) {
            const int j = entry < 2 ? i : (int)(next_random(seed) * N);
            if (i == SINGULAR && j == i && entry != 0) continue;
            double *block = block_rows_at(&rows, j);
            for (int k = 0; k < 9; k++) {
                const bool is_plane = i == SINGULAR && j == i;
                const double more =
                    is_plane ? 6 * (k == 0 || k == 4)
                             : next_random(seed) + 20 * (i == j && k % 4 == 0);
                block[k] += more;
                full[3 * i + k / 3][3 * j + k % 3] += more;
            }
        }
        block_rows_end_row(&rows);
    }
    return rows;
}

static void as_in_full(void **state)
{
    (void)state;
    uint64_t seed = 5;
    struct block_rows rows = filled(&seed);
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

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_in_full)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
