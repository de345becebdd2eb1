// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a large cluster with a rough factor: the potentials that the exact
// one finds, also after links have changed and nodes have left, so that the factor is
// that of another graph.
#include "../../random.h"
#include "../../test.h"
#include "basics/memory.h"
#include "dry/liquid/cluster_laplacian.h"
#include "sparse/cholmod_serial.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 14, N = SIDE * SIDE * SIDE, MOST_LINKS = 3 * N, ARMS = 60 };

// Over four decades, as throats of radii from 1 to 10.
static double some_conductance(uint64_t *seed)
{
    return pow(10, 4 * next_random(seed) - 2);
}

// A cubic lattice.
static int lattice(struct graph_link *link)
{
    uint64_t seed = 3;
    const int step[3] = {1, SIDE, SIDE * SIDE};
    int n = 0;
    for (int i = 0; i < N; i++)
        for (int axis = 0; axis < 3; axis++)
            if (i / step[axis] % SIDE < SIDE - 1)
                link[n++] =
                    (struct graph_link){i, i + step[axis], some_conductance(&seed)};
    return n;
}

struct cluster {
    struct cluster_laplacian *graph;
    int row[N], entry[MOST_LINKS];
    struct graph_arm arm[ARMS];
};

static struct cluster *cluster_of(cholmod_common *common, bool rough)
{
    struct cluster *cluster = NEW_ARRAY(struct cluster, 1);
    struct graph_link *link = NEW_ARRAY(struct graph_link, MOST_LINKS);
    const int n_link = lattice(link);
    cluster->graph = cluster_laplacian_create(common, N, n_link, link, rough,
                                              cluster->row, cluster->entry);
    free(link);
    uint64_t seed = 4;
    for (int k = 0; k < ARMS; k++)
        cluster->arm[k] = (struct graph_arm){cluster->row[k * (N / ARMS)],
                                             some_conductance(&seed), k % 5};
    for (int i = 0; i < N; i++)
        cluster->graph->source[cluster->row[i]] = 2 * next_random(&seed) - 1;
    cluster_laplacian_set_arms(cluster->graph, ARMS, cluster->arm);
    return cluster;
}

static void free_cluster(struct cluster *cluster)
{
    cluster_laplacian_free(cluster->graph);
    free(cluster);
}

static void solve(struct cluster *cluster)
{
    double residual = cluster_laplacian_residual(cluster->graph);
    for (int k = 0; k < 8 && residual > 1e-10; k++) {
        assert_true(cluster_laplacian_correct(cluster->graph, 1e-11));
        residual = cluster_laplacian_residual(cluster->graph);
    }
    assert_true(residual <= 1e-10);
}

// In this order: a link of a node that has left conducts nothing.
static void change_some(struct cluster *cluster)
{
    for (int k = 0; k < 200; k++)
        cluster_laplacian_set(cluster->graph, cluster->entry[11 * k], 0.5 * k);
    for (int i = 7; i < N; i += 50)
        if (i % (N / ARMS) != 0) cluster_laplacian_cut(cluster->graph, cluster->row[i]);
}

static void assert_alike(const struct cluster *a, const struct cluster *b)
{
    double off = 0, largest = 0;
    for (int i = 0; i < N; i++) {
        if (a->graph->present[a->row[i]] == 0) continue;
        const struct compensated x = a->graph->potential[a->row[i]],
                                 y = b->graph->potential[b->row[i]];
        off = fmax(off, fabs(compensated_difference(x, y)));
        largest = fmax(largest, fabs(compensated_value(x)));
    }
    assert_true(largest > 1);
    assert_true(off < 1e-8 * largest);
}

TEST(a_rough_factor_finds_what_the_exact_one_finds)
{
    cholmod_common common;
    cholmod_serial_start(&common);
    struct cluster *exact = cluster_of(&common, false),
                   *rough = cluster_of(&common, true);
    for (int round = 0; round < 2; round++) {
        solve(exact);
        solve(rough);
        assert_alike(exact, rough);
        change_some(exact);
        change_some(rough);
    }
    free_cluster(exact);
    free_cluster(rough);
    cholmod_finish(&common);
}
