// SPDX-License-Identifier: GPL-3.0-or-later
// Drawn throat radii against the distributions they are drawn from, and correlated ones
// against the covariance they are to have.
#include "network/throat_radius.h"
#include "../../test.h"
#include "../support_lattice.h"
#include "basics/memory.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>

enum { SIDE = 16 };
#define SPACING 1e-6

static double cumulative(const struct radius_distribution *law, double r)
{
    const double spread = law->deviation / law->mean,
                 log_variance = log1p(spread * spread);
    const double half = sqrt(3) * law->deviation;
    switch (law->law) {
    case RADIUS_NORMAL:
        return gsl_cdf_gaussian_P(r - law->mean, law->deviation);
    case RADIUS_LOGNORMAL:
        return gsl_cdf_lognormal_P(r, log(law->mean) - log_variance / 2,
                                   sqrt(log_variance));
    case RADIUS_UNIFORM:
        return gsl_cdf_flat_P(r, law->mean - half, law->mean + half);
    case RADIUS_TWO_MODE:
        return (1 - law->second_share) *
                   gsl_cdf_gaussian_P(r - law->mean, law->deviation) +
               law->second_share *
                   gsl_cdf_gaussian_P(r - law->second_mean, law->second_deviation);
    }
    return 0;
}

static struct network drawn(const struct radius_distribution *law)
{
    struct network network = lattice_network(SIDE, SIDE, SIDE, SPACING);
    struct reason reason;
    assert_int_equal(draw_radii(&network, law, &reason), STATUS_OK);
    return network;
}

// Kolmogorov and Smirnov: 1.95/sqrt(n) is passed once in a thousand times.
static void assert_drawn_from(const struct radius_distribution *law)
{
    struct network network = drawn(law);
    const size_t n = (size_t)network.n_throat;
    gsl_sort(network.throat_radius, 1, n);
    double most = 0;
    for (size_t k = 0; k < n; k++) {
        const double expected = cumulative(law, network.throat_radius[k]);
        most = fmax(most, fmax(fabs(expected - (double)k / (double)n),
                               fabs(expected - ((double)k + 1) / (double)n)));
    }
    assert_true(network.throat_radius[0] > 0);
    assert_true(most < 1.95 / sqrt((double)n));
    network_free(&network);
}

static const struct radius_distribution laws[] = {
    {.law = RADIUS_NORMAL, .mean = 1e-7, .deviation = 1e-8, .seed = 3},
    {.law = RADIUS_LOGNORMAL, .mean = 1e-7, .deviation = 6e-8, .seed = 3},
    {.law = RADIUS_UNIFORM, .mean = 1e-7, .deviation = 5e-8, .seed = 3},
    {.law = RADIUS_TWO_MODE,
     .mean = 1e-7,
     .deviation = 5e-9,
     .second_mean = 4e-8,
     .second_deviation = 2e-9,
     .second_share = 0.7,
     .seed = 3}};

TEST(each_law_is_met)
{
    for (int k = 0; k < 4; k++)
        assert_drawn_from(&laws[k]);
}

// In place of the radii, their places in the order: what a normal variable would be.
static void to_scores(double *value, size_t n)
{
    size_t *order = NEW_ARRAY(size_t, n);
    gsl_sort_index(order, value, 1, n);
    for (size_t k = 0; k < n; k++)
        value[order[k]] = gsl_cdf_ugaussian_Pinv(((double)k + 0.5) / (double)n);
    free(order);
}

// Mean product of the scores of parallel throats STEPS spacings apart along x.
static double covariance(const struct network *network, int steps)
{
    double sum = 0;
    int count = 0;
    int *at = NEW_ARRAY(int, network->n_node);
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_nodes[t][1] - network->throat_nodes[t][0] == SIDE * SIDE)
            at[network->throat_nodes[t][0]] = t + 1; // along z
    for (int i = 0; i < network->n_node; i++) {
        if (i % SIDE + steps >= SIDE || !at[i]) continue;
        sum += network->throat_radius[at[i] - 1] *
               network->throat_radius[at[i + steps] - 1];
        count++;
    }
    free(at);
    return sum / count;
}

// The mean over realisations, for each has but some hundred independent regions; within
// four of its own standard errors.
TEST(neighbours_are_alike)
{
    enum { REALISATIONS = 12, FARTHEST = 4 };
    double got[FARTHEST + 1][REALISATIONS];
    for (int r = 0; r < REALISATIONS; r++) {
        struct radius_distribution law = laws[1];
        law.correlation_length = 1.2 * SPACING;
        law.seed = (unsigned long)r + 1;
        struct network network = drawn(&law);
        to_scores(network.throat_radius, (size_t)network.n_throat);
        for (int k = 0; k <= FARTHEST; k++)
            got[k][r] = covariance(&network, k);
        network_free(&network);
    }
    for (int k = 0; k <= FARTHEST; k++) {
        const double mean = gsl_stats_mean(got[k], 1, REALISATIONS);
        const double error = gsl_stats_sd(got[k], 1, REALISATIONS) / sqrt(REALISATIONS);
        assert_true(error < 0.025);
        assert_true(fabs(mean - exp(-k * k / (2 * 1.2 * 1.2))) < 4 * error);
    }
}

// Correlated radii are the others in another order.
TEST(correlation_only_moves_radii)
{
    for (int k = 0; k < 4; k++) {
        struct radius_distribution law = laws[k];
        struct network free_ones = drawn(&law);
        law.correlation_length = 3 * SPACING;
        struct network alike = drawn(&law);
        const size_t n = (size_t)alike.n_throat;
        assert_memory_not_equal(alike.throat_radius, free_ones.throat_radius,
                                n * sizeof(double));
        gsl_sort(alike.throat_radius, 1, n);
        gsl_sort(free_ones.throat_radius, 1, n);
        assert_memory_equal(alike.throat_radius, free_ones.throat_radius,
                            n * sizeof(double));
        network_free(&alike);
        network_free(&free_ones);
    }
}

// What is left of normal radii that may be below 0, beside Simpson's rule, and beside
// what is drawn.
TEST(what_is_cut_is_told)
{
    enum { STEPS = 100000 };
    for (double spread = 0.2; spread < 2; spread += 0.3) {
        double sum[3] = {0};
        const double step = (1 + 12 * spread) / STEPS;
        for (int k = 0; k <= STEPS; k++) {
            const double r = k * step, x = (r - 1) / spread;
            const double weight = k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2;
            for (int m = 0; m < 3; m++)
                sum[m] += weight * pow(r, m) * exp(-x * x / 2);
        }
        const double all = sum[0] * step / 3 / (sqrt(2 * M_PI) * spread);
        double mean = 1, deviation = spread;
        const double share = cut_normal(&mean, &deviation);
        assert_within(share, 1 - all, 1e-9);
        assert_within(mean, sum[1] / sum[0], 1e-9);
        assert_within(deviation, sqrt(sum[2] / sum[0] - mean * mean), 1e-9);
    }
    double mean = 1, deviation = 0;
    assert_true(cut_normal(&mean, &deviation) == 0 && mean == 1);
}

TEST(what_cannot_be_drawn_is_refused)
{
    struct network network = lattice_network(3, 3, 3, SPACING);
    struct reason reason;
    struct radius_distribution law = {
        .law = RADIUS_UNIFORM, .mean = 1, .deviation = 0.6, .seed = 1};
    assert_int_equal(draw_radii(&network, &law, &reason), STATUS_BAD_DATA);
    network_free(&network);
}
