// SPDX-License-Identifier: GPL-3.0-or-later
// Films along a strip of sites, W beside each other and linked by g to all four sides,
// from a cluster of level u_0 at one end, each of which loses q. They end at site M,
// held at 0, and the level there touches 0 as a parabola does:
//     u_k = q / (2 g) (M - k)^2,   surplus of site M = q / 2,   beyond it q,
//     surplus of the cluster = W q (M - 1/2).
// The strips are large enough for the iteration; one factor serves them all.
#include "../../test.h"

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
TEST(reach_of_films_along_a_strip)
{
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

// Nodes in a row, each linked to the next and to one of 40 clusters that float, in no
// order; a cluster at one end feeds them all. Whatever it is made of, the flow balances
// at every site, and the source supplies what all take. The floating clusters have some
// 150 links each; where they are no part of the factor it takes 48 iterations, not 25.
TEST(clusters_with_many_links)
{
    enum { HUBS = 40, ROW = 6000, ALL = 1 + HUBS + ROW };
    static double taken[ALL], least[ALL] = {1}, surplus[ALL];
    static bool held[ALL] = {true};
    static struct compensated level[ALL];
    static int place[ALL];
    struct link *link = NEW_ARRAY(struct link, 2 * ROW);
    unsigned draw = 1;
    double all = 0;
    for (int i = 0; i < ROW; i++) {
        const int here = 1 + HUBS + i;
        draw = draw * 1103515245u + 12345u;
        const int hub = 1 + (int)(draw >> 16) % HUBS;
        link[2 * i] = (struct link){{hub, here}, 1 + hub};
        link[2 * i + 1] = (struct link){{i > 0 ? here - 1 : 0, here}, 400};
        all += taken[here] = 1e-5 * (1 + i % 7);
    }
    struct conductance_matrix matrix =
        conductance_matrix_of_links(ALL, ALL, 2 * ROW, link);
    free(link);
    for (int i = 0; i < ALL; i++)
        place[i] = i;
    struct film_factor *factor = film_factor_create();
    struct film_flow flow = {.matrix = &matrix,
                             .place = place,
                             .taken = taken,
                             .least = least,
                             .factor = factor,
                             .held = held,
                             .level = level,
                             .surplus = surplus};
    assert_true(film_flow_solve(&flow, 1e-9));
    for (int i = 1; i < ALL; i++) {
        double gained = 0;
        for (int k = matrix.offset[i]; k < matrix.offset[i + 1]; k++)
            gained += matrix.value[k] *
                      compensated_difference(level[matrix.column[k]], level[i]);
        assert_within(gained, taken[i], 1e-9);
        assert_within(surplus[i], 0, 0);
    }
    assert_close(surplus[0], all, 1e-8);
    assert_true(flow.iterations < 35);
    film_factor_free(factor);
    conductance_matrix_free(&matrix);
}
