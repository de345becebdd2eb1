// SPDX-License-Identifier: GPL-3.0-or-later
// The approximate factor of a star is exact but for rounding to floats: elimination of
// a leaf leaves one link, from the hub to ground. Links are given three times each.
#include "../test.h"

#include "basics/memory.h"
#include "elimination/approximate_cholesky.h"

#include <stdlib.h>
#include <time.h>

enum { LEAVES = 100000, HUB = LEAVES / 3, N = LEAVES + 1, PARALLEL = 3 };

static double to_hub(int leaf)
{
    return 1 + leaf % 7;
}

static double to_ground(int leaf)
{
    return 0.5 + leaf % 11;
}

static struct conductance_matrix star(void)
{
    struct link *link = NEW_ARRAY(struct link, 2 * PARALLEL * LEAVES);
    int n = 0;
    for (int k = 0; k < N; k++)
        for (int l = 0; l < PARALLEL && k != HUB; l++) {
            link[n++] = (struct link){{k, HUB}, to_hub(k) / PARALLEL};
            link[n++] = (struct link){{k, N}, to_ground(k) / PARALLEL};
        }
    struct conductance_matrix matrix = conductance_matrix_of_links(N, N + 1, n, link);
    free(link);
    return matrix;
}

TEST(star)
{
    struct conductance_matrix matrix = star();
    const clock_t begun = clock();
    struct approximate_cholesky *factor = approximate_cholesky_create(&matrix);
    const double seconds = (double)(clock() - begun) / CLOCKS_PER_SEC;
    double *b = NEW_ARRAY(double, N), *x = NEW_ARRAY(double, N), all = 0;
    b[HUB] = 1;
    approximate_cholesky_apply(factor, b, x);
    for (int k = 0; k < N; k++)
        if (k != HUB) all += to_hub(k) * to_ground(k) / (to_hub(k) + to_ground(k));
    for (int k = 0; k < N; k++) // of floats, of which 1e5 are summed
        assert_close(
            x[k], (k == HUB ? 1 : to_hub(k) / (to_hub(k) + to_ground(k))) / all, 1e-3);
    // To look through the hub's row for each leaf takes a hundred times as long.
    assert_true(seconds < 3);
    approximate_cholesky_free(factor);
    conductance_matrix_free(&matrix);
    free(b);
    free(x);
}
