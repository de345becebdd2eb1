// SPDX-License-Identifier: GPL-3.0-or-later
// Flow through networks of conductances over many decades, by elimination and by a
// graph with a factor that follows, next to Gauss's elimination in 600 bits (MPFR).
#include "elimination/kron.h"
#include "../../test.h"
#include "dry/liquid/cluster_laplacian.h"

#include "basics/memory.h"
#include "sparse/cholmod_serial.h"

#include <mpfr.h>

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

enum { EDGE = 6, NODES = EDGE * EDGE * EDGE, ENDS = 4, BITS = 600 };

struct sample {
    int n_link;
    struct graph_link link[4 * NODES]; // nodes, then ends
    double extracted[NODES];
    double level[ENDS];
};

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static void add_link(struct sample *sample, int a, int b, double decades,
                     uint64_t *state)
{
    sample->link[sample->n_link++] =
        (struct graph_link){a, b, pow(10, decades * (uniform(state) - 0.5))};
}

// A cubic lattice, with ends at some of its nodes.
static struct sample make_sample(double decades, uint64_t seed)
{
    struct sample sample = {0};
    uint64_t state = seed;
    for (int i = 0; i < NODES; i++) {
        const int x = i % EDGE, y = i / EDGE % EDGE, z = i / (EDGE * EDGE);
        if (x > 0) add_link(&sample, i, i - 1, decades, &state);
        if (y > 0) add_link(&sample, i, i - EDGE, decades, &state);
        if (z > 0) add_link(&sample, i, i - EDGE * EDGE, decades, &state);
        if (uniform(&state) < 0.2) sample.extracted[i] = uniform(&state);
    }
    for (int e = 0; e < ENDS; e++) {
        add_link(&sample, (e * 71 + 5) % NODES, NODES + e, decades, &state);
        sample.level[e] = e == 0 ? 0 : -pow(10, decades / 2 * (uniform(&state) - 0.5));
    }
    return sample;
}

// --- exactly -------------------------------------------------------------------------

static mpfr_t matrix[NODES][NODES], right[NODES];

static void assemble(const struct sample *sample)
{
    for (int i = 0; i < NODES; i++) {
        mpfr_set_d(right[i], -sample->extracted[i], MPFR_RNDN);
        for (int j = 0; j < NODES; j++)
            mpfr_set_d(matrix[i][j], 0, MPFR_RNDN);
    }
    mpfr_t part;
    mpfr_init2(part, BITS);
    for (int k = 0; k < sample->n_link; k++) {
        const struct graph_link link = sample->link[k];
        mpfr_add_d(matrix[link.a][link.a], matrix[link.a][link.a], link.conductance,
                   MPFR_RNDN);
        if (link.b >= NODES) {
            mpfr_set_d(part, link.conductance, MPFR_RNDN);
            mpfr_mul_d(part, part, sample->level[link.b - NODES], MPFR_RNDN);
            mpfr_add(right[link.a], right[link.a], part, MPFR_RNDN);
            continue;
        }
        mpfr_add_d(matrix[link.b][link.b], matrix[link.b][link.b], link.conductance,
                   MPFR_RNDN);
        mpfr_set_d(matrix[link.a][link.b], -link.conductance, MPFR_RNDN);
        mpfr_set_d(matrix[link.b][link.a], -link.conductance, MPFR_RNDN);
    }
    mpfr_clear(part);
}

// The solution comes in the right side.
static void eliminate_exactly(void)
{
    mpfr_t factor, part;
    mpfr_inits2(BITS, factor, part, (mpfr_ptr)0);
    for (int k = 0; k < NODES; k++)
        for (int i = k + 1; i < NODES; i++) {
            if (mpfr_zero_p(matrix[i][k])) continue;
            mpfr_div(factor, matrix[i][k], matrix[k][k], MPFR_RNDN);
            for (int j = k; j < NODES; j++) {
                if (mpfr_zero_p(matrix[k][j])) continue;
                mpfr_mul(part, factor, matrix[k][j], MPFR_RNDN);
                mpfr_sub(matrix[i][j], matrix[i][j], part, MPFR_RNDN);
            }
            mpfr_mul(part, factor, right[k], MPFR_RNDN);
            mpfr_sub(right[i], right[i], part, MPFR_RNDN);
        }
    for (int i = NODES - 1; i >= 0; i--) {
        for (int j = i + 1; j < NODES; j++) {
            mpfr_mul(part, matrix[i][j], right[j], MPFR_RNDN);
            mpfr_sub(right[i], right[i], part, MPFR_RNDN);
        }
        mpfr_div(right[i], right[i], matrix[i][i], MPFR_RNDN);
    }
    mpfr_clears(factor, part, (mpfr_ptr)0);
}

static void solve_exactly(const struct sample *sample, double *potential, double *flow)
{
    for (int i = 0; i < NODES; i++) {
        mpfr_init2(right[i], BITS);
        for (int j = 0; j < NODES; j++)
            mpfr_init2(matrix[i][j], BITS);
    }
    assemble(sample);
    eliminate_exactly();
    mpfr_t drop;
    mpfr_init2(drop, BITS);
    for (int k = 0; k < sample->n_link; k++) {
        const struct graph_link link = sample->link[k];
        if (link.b < NODES) continue;
        mpfr_sub_d(drop, right[link.a], sample->level[link.b - NODES], MPFR_RNDN);
        mpfr_mul_d(drop, drop, link.conductance, MPFR_RNDN);
        flow[link.b - NODES] = mpfr_get_d(drop, MPFR_RNDN);
    }
    for (int i = 0; i < NODES; i++) {
        potential[i] = mpfr_get_d(right[i], MPFR_RNDN);
        mpfr_clear(right[i]);
        for (int j = 0; j < NODES; j++)
            mpfr_clear(matrix[i][j]);
    }
    mpfr_clear(drop);
}

// --- ours ----------------------------------------------------------------------------

static double fall_between(const void *context, int b, int a)
{
    const struct sample *sample = context;
    return sample->level[b] - sample->level[a];
}

static void solve_cluster_elimination(const struct sample *sample, double *potential,
                                      double *flow)
{
    struct kron kron = {0};
    kron_begin(&kron, NODES, ENDS);
    for (int k = 0; k < sample->n_link; k++)
        kron_link(&kron, sample->link[k].a, sample->link[k].b,
                  sample->link[k].conductance);
    for (int i = 0; i < NODES; i++)
        kron_extract(&kron, i, sample->extracted[i]);
    kron_eliminate(&kron);
    double value[NODES + ENDS];
    for (int e = 0; e < ENDS; e++) {
        flow[e] = kron_flow(&kron, e, fall_between, sample);
        value[NODES + e] = sample->level[e];
    }
    kron_potentials(&kron, value);
    for (int i = 0; i < NODES; i++)
        potential[i] = value[i];
    kron_free(&kron);
}

// Twice: as it is, and with half of the links changed before and back again.
static void solve_cluster_cholesky(const struct sample *sample, double *flow)
{
    cholmod_common common;
    cholmod_serial_start(&common);
    int row[NODES], entry[4 * NODES];
    struct graph_link link[4 * NODES];
    struct graph_arm arm[ENDS];
    for (int k = 0; k < sample->n_link - ENDS; k++) {
        link[k] = sample->link[k];
        if (k % 2) link[k].conductance = 0.5;
    }
    struct cluster_laplacian *graph = cluster_laplacian_create(
        &common, NODES, sample->n_link - ENDS, link, false, row, entry);
    for (int i = 0; i < NODES; i++)
        graph->source[row[i]] = -sample->extracted[i];
    for (int e = 0; e < ENDS; e++) {
        const struct graph_link *to_end = &sample->link[sample->n_link - ENDS + e];
        arm[e] =
            (struct graph_arm){row[to_end->a], to_end->conductance, sample->level[e]};
    }
    cluster_laplacian_set_arms(graph, ENDS, arm);
    cluster_laplacian_residual(graph);
    assert_true(cluster_laplacian_correct(graph, 1e-10));
    for (int k = 0; k < sample->n_link - ENDS; k++)
        cluster_laplacian_set(graph, entry[k], sample->link[k].conductance);
    for (int round = 0; round < 10; round++) {
        if (cluster_laplacian_residual(graph) < 1e-15) break;
        assert_true(cluster_laplacian_correct(graph, 1e-15));
    }
    for (int e = 0; e < ENDS; e++) {
        const struct compensated level = {.value = arm[e].level};
        flow[e] = arm[e].conductance *
                  compensated_difference(graph->potential[arm[e].a], level);
    }
    cluster_laplacian_free(graph);
    cholmod_finish(&common);
}

// --- comparison ----------------------------------------------------------------------

static double largest_of(const double *value, int n)
{
    double largest = 0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(value[i]));
    return largest;
}

// Every potential to its own digits; the flows to those of the largest.
TEST(elimination_keeps_its_digits)
{
    for (int decades = 12; decades <= 48; decades += 12) {
        const struct sample sample = make_sample(decades, 3u + (unsigned)decades);
        double exact[NODES], potential[NODES], exact_flow[ENDS], flow[ENDS];
        solve_exactly(&sample, exact, exact_flow);
        solve_cluster_elimination(&sample, potential, flow);
        for (int i = 0; i < NODES; i++)
            assert_true(fabs(potential[i] / exact[i] - 1) < 2e-14);
        const double largest = largest_of(exact_flow, ENDS);
        for (int e = 0; e < ENDS; e++)
            assert_true(fabs(flow[e] - exact_flow[e]) < 1e-13 * largest);
    }
}

TEST(graph_finds_the_same)
{
    for (int decades = 0; decades <= 12; decades += 4) {
        const struct sample sample = make_sample(decades, 7u + (unsigned)decades);
        double potential[NODES], exact_flow[ENDS], flow[ENDS];
        solve_cluster_elimination(&sample, potential, exact_flow);
        solve_cluster_cholesky(&sample, flow);
        const double largest = largest_of(exact_flow, ENDS);
        for (int e = 0; e < ENDS; e++)
            assert_true(fabs(flow[e] - exact_flow[e]) < 1e-13 * largest);
    }
}
