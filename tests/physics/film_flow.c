// SPDX-License-Identifier: GPL-3.0-or-later
// Films along a strip of sites, W beside each other and linked by g to all four sides,
// from a cluster of level u_0 at one end, each of which loses q. They end at site M,
// held at 0, and the level there touches 0 as a parabola does:
//     u_k = q / (2 g) (M - k)^2,   surplus of site M = q / 2,   beyond it q,
//     surplus of the cluster = W q (M - 1/2).
// The strips are large enough for the iteration; one factor serves them all.
#include "../test.h"

#include "basics/memory.h"
#include "dry/inviscid/film_balance.h"

#include <math.h>
#include <stdlib.h>

enum { W = 5, LENGTH = 1000, N = 1 + W * LENGTH };

static const double q = 0.7, g = 300;

// Site 0 is the cluster, 1 + k W + j the site in row k, place j, from 0.
static struct conductance_matrix strip(int rows)
{
    struct link *link = NEW_ARRAY(struct link, 2 * N);
    int n = 0;
    for (int k = 0; k < rows; k++)
        for (int j = 0; j < W; j++) {
            const int here = 1 + k * W + j;
            link[n++] = (struct link){{k > 0 ? here - W : 0, here}, g};
            if (j + 1 < W) link[n++] = (struct link){{here, here + 1}, g};
        }
    struct conductance_matrix matrix =
        conductance_matrix_of_links(1 + rows * W, 1 + rows * W, n, link);
    free(link);
    return matrix;
}

static void check(const struct film_flow *flow, int reach)
{
    double all = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        const int k = i > 0 ? 1 + (i - 1) / W : 0;
        const double left = reach > k ? reach - k : 0, u = q / (2 * g) * left * left;
        assert_within(compensated_value(flow->level[i]), u,
                      1e-8 * q / (2 * g) * reach * reach);
        if (k > 0) {
            assert_int_equal(flow->held[i], k >= reach);
            assert_within(flow->surplus[i],
                          k < reach    ? 0
                          : k == reach ? q / 2
                                       : q,
                          1e-6 * q);
        }
        all += flow->surplus[i];
    }
    assert_close(flow->surplus[0], W * q * (reach - 0.5), 1e-8);
    assert_close(all, (flow->matrix->n - 1) * q, 1e-8);
}

// First all sites but the cluster are not held, then those of the strip before.
static void test_reach_of_films_along_a_strip(void **state)
{
    (void)state;
    static double taken[N], least[N], surplus[N];
    static bool held[N] = {true};
    static struct compensated level[N];
    static int place[N];
    struct film_factor *factor = film_factor_create();
    static const int reach[][2] = {{300, 1000}, {310, 1000}, {700, 1000},
                                   {690, 800},  {350, 500},  {900, 1000}};
    for (int i = 1; i < N; i++)
        taken[i] = q;
    for (size_t m = 0; m < sizeof reach / sizeof *reach; m++) {
        struct conductance_matrix matrix = strip(reach[m][1]);
        struct film_flow flow = {&matrix, place, taken,   least, factor,
                                 held,    level, surplus, 0,     0};
        for (int i = 0; i < matrix.n; i++) {
            place[i] = 3 * i;
            if (i > 0) held[i] = false;
        }
        least[0] = q / (2 * g) * reach[m][0] * reach[m][0];
        assert_true(film_flow_solve(&flow, 1e-9 * q));
        assert_true(flow.iterations > 0);
        check(&flow, reach[m][0]);
        conductance_matrix_free(&matrix);
    }
    film_factor_free(factor);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reach_of_films_along_a_strip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
