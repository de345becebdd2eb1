// SPDX-License-Identifier: GPL-3.0-or-later
// Confidence intervals and two-sample tests. Student's tail comes from the incomplete
// beta function, P(|t|) = I_x(degrees / 2, 1/2), x = degrees / (degrees + t^2), and a
// quantile from GSL's with one Newton step. Welch's t test has
//     t = (mean_a - mean_b) / sqrt(s_a^2 / n_a + s_b^2 / n_b)
// with Satterthwaite's degrees of freedom. Mann and Whitney's U is exact by counting:
// the number of ways to choose k of the ranks 1..n with sum s; with ties or many
// values it is nearly normal, with the variance corrected for ties.
#include "statistics/sample.h"

#include "basics/memory.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

double sample_mean(struct sample sample)
{
    return gsl_stats_mean(sample.value, 1, (size_t)sample.n);
}

double sample_deviation(struct sample sample)
{
    return sample.n < 2 ? NAN : gsl_stats_sd(sample.value, 1, (size_t)sample.n);
}

double student_p(double t, double degrees)
{
    return gsl_cdf_beta_P(degrees / (degrees + t * t), degrees / 2, 0.5);
}

// GSL's quantile and one Newton step.
static double student_quantile(double p, double degrees)
{
    const double t = gsl_cdf_tdist_Qinv(p / 2, degrees);
    return t + (student_p(t, degrees) - p) / 2 / gsl_ran_tdist_pdf(t, degrees);
}

double half_width(struct sample sample, double confidence)
{
    return half_width_of(sample_deviation(sample), sample.n, confidence);
}

double half_width_of(double deviation, int n, double confidence)
{
    return n < 2 ? NAN : student_quantile(1 - confidence, n - 1) * deviation / sqrt(n);
}

// ---- Welch --------------------------------------------------------------------------

struct welch welch_test(struct sample a, struct sample b)
{
    if (a.n < 2 || b.n < 2) return (struct welch){NAN, NAN, NAN};
    const double difference = sample_mean(a) - sample_mean(b);
    const double square_a = pow(sample_deviation(a), 2) / a.n;
    const double square_b = pow(sample_deviation(b), 2) / b.n;
    const double square = square_a + square_b;
    if (isnan(square)) return (struct welch){NAN, NAN, NAN};
    if (square == 0)
        return difference == 0 ? (struct welch){0, NAN, 1}
                               : (struct welch){copysign(INFINITY, difference), NAN, 0};
    const double t = difference / sqrt(square);
    const double degrees =
        square * square /
        (square_a * square_a / (a.n - 1) + square_b * square_b / (b.n - 1));
    return (struct welch){t, degrees, student_p(t, degrees)};
}

// ---- Mann and Whitney ---------------------------------------------------------------

struct ranked {
    double value;
    bool of_a;
};

static int by_value(const void *a, const void *b)
{
    const double x = ((const struct ranked *)a)->value;
    const double y = ((const struct ranked *)b)->value;
    return (x > y) - (x < y);
}

static struct ranked *sorted(struct sample a, struct sample b)
{
    struct ranked *all = NEW_ARRAY(struct ranked, a.n + b.n);
    for (int k = 0; k < a.n; k++)
        all[k] = (struct ranked){a.value[k], true};
    for (int k = 0; k < b.n; k++)
        all[a.n + k] = (struct ranked){b.value[k], false};
    qsort(all, (size_t)a.n + (size_t)b.n, sizeof *all, by_value);
    return all;
}

// Sum of A's ranks, from 1; tied values share their mean rank. TIES becomes the sum of
// t^3 - t over groups of t ties.
static double rank_sum(const struct ranked *all, int n, double *ties)
{
    double sum = 0;
    *ties = 0;
    for (int first = 0, end; first < n; first = end) {
        for (end = first; end < n && all[end].value == all[first].value; end++)
            continue;
        const double shared = 0.5 * (first + 1 + end), t = end - first;
        for (int k = first; k < end; k++)
            if (all[k].of_a) sum += shared;
        *ties += t * t * t - t;
    }
    return sum;
}

// Probability that U is at least LEAST if all orders of the two samples are equally
// likely: by counting the choices of K ranks among 1, 2, ... with sum S.
static double exact_tail(int n_a, int n_b, double least)
{
    const int n = n_a + n_b, lowest = n_a * (n_a + 1) / 2, width = n * n_a + 1;
    double *ways = NEW_ARRAY(double, (size_t)(n_a + 1) * (size_t)width);
    ways[0] = 1;
    for (int rank = 1; rank <= n; rank++)
        for (int k = rank < n_a ? rank : n_a; k >= 1; k--)
            for (int s = width - 1; s >= rank; s--)
                ways[k * width + s] += ways[(k - 1) * width + s - rank];
    double all = 0, tail = 0;
    for (int s = lowest; s < width; s++) {
        all += ways[n_a * width + s];
        if (s - lowest >= least) tail += ways[n_a * width + s];
    }
    free(ways);
    return tail / all;
}

static double normal_tail(int n_a, int n_b, double ties, double larger)
{
    const double pairs = (double)n_a * n_b, n = n_a + n_b;
    const double variance = pairs / 12 * (n + 1 - ties / (n * (n - 1)));
    if (!(variance > 0)) return 1; // all values are equal
    return gsl_cdf_ugaussian_Q((larger - pairs / 2 - 0.5) / sqrt(variance));
}

struct mann_whitney mann_whitney_test(struct sample a, struct sample b)
{
    enum { MAX_EXACT = 50 };
    if (a.n < 1 || b.n < 1) return (struct mann_whitney){NAN, NAN, false};
    struct ranked *all = sorted(a, b);
    double ties;
    const double u = rank_sum(all, a.n + b.n, &ties) - 0.5 * a.n * (a.n + 1.0);
    free(all);
    const double larger = fmax(u, (double)a.n * b.n - u);
    const bool exact = ties == 0 && a.n + b.n <= MAX_EXACT;
    const double tail =
        exact ? exact_tail(a.n, b.n, larger) : normal_tail(a.n, b.n, ties, larger);
    return (struct mann_whitney){u, fmin(1, 2 * tail), exact};
}
