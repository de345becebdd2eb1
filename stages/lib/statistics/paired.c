// SPDX-License-Identifier: GPL-3.0-or-later
// Paired t test and Wilcoxon's signed-rank test (1945). With the differences d_k
// ranked by size, V is the sum of the ranks of positive ones. Without ties its
// distribution is counted exactly: ways[s] is the number of subsets of {1..n} with sum
// s, built rank by rank. Else V is nearly normal, of mean n (n + 1) / 4 and variance
//     n (n + 1) (2 n + 1) / 24 - sum over ties of (t^3 - t) / 48,
// with a continuity correction of 1/2.
#include "statistics/paired.h"

#include "basics/memory.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

static double *differences(struct sample a, struct sample b)
{
    double *value = NEW_ARRAY(double, a.n);
    for (int k = 0; k < a.n; k++)
        value[k] = a.value[k] - b.value[k];
    return value;
}

struct paired_t paired_t_test(struct sample a, struct sample b)
{
    double *value = differences(a, b);
    const struct sample sample = {value, a.n};
    struct paired_t test = {.mean = sample_mean(sample),
                            .sd = sample_deviation(sample),
                            .t = NAN,
                            .degrees = a.n - 1,
                            .p = NAN};
    free(value);
    if (a.n < 2 || isnan(test.mean)) return (struct paired_t){NAN, NAN, NAN, NAN, NAN};
    const double error = test.sd / sqrt(a.n);
    test.t = test.mean == 0 ? 0 : test.mean / error;
    test.p = isinf(test.t) ? 0 : student_p(test.t, test.degrees);
    return test;
}

// ---- Wilcoxon -----------------------------------------------------------------------

static int by_size(const void *a, const void *b)
{
    const double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

// The sum of the ranks of positive differences among N sorted by size, none 0; ties
// share their mean rank. TIES becomes the sum of t^3 - t over groups of t ties.
static double positive_ranks(const double *value, int n, double *ties)
{
    double sum = 0;
    *ties = 0;
    for (int first = 0, end; first < n; first = end) {
        for (end = first; end < n && fabs(value[end]) == fabs(value[first]); end++)
            continue;
        const double t = end - first;
        for (int k = first; k < end; k++)
            if (value[k] > 0) sum += 0.5 * (first + 1 + end);
        *ties += t * t * t - t;
    }
    return sum;
}

// Probability that V is at least LEAST if both signs are equally likely: by counting
// the subsets of 1, 2, ... N with sum S.
static double exact_tail(int n, double least)
{
    const int width = n * (n + 1) / 2 + 1;
    double *ways = NEW_ARRAY(double, width);
    ways[0] = 1;
    for (int rank = 1; rank <= n; rank++)
        for (int s = width - 1; s >= rank; s--)
            ways[s] += ways[s - rank];
    double tail = 0;
    for (int s = width - 1; s >= least; s--)
        tail += ways[s];
    free(ways);
    return ldexp(tail, -n);
}

static double normal_tail(double n, double ties, double larger)
{
    const double variance = n * (n + 1) * (2 * n + 1) / 24 - ties / 48;
    return gsl_cdf_ugaussian_Q((larger - n * (n + 1) / 4 - 0.5) / sqrt(variance));
}

struct wilcoxon wilcoxon_test(struct sample a, struct sample b)
{
    enum { MAX_EXACT = 50 };
    double *value = differences(a, b);
    int n = 0;
    bool known = a.n > 0;
    for (int k = 0; k < a.n; k++) {
        known &= !isnan(value[k]);
        if (value[k] != 0) value[n++] = value[k];
    }
    if (!known) n = 0; // what is not a number has no rank
    qsort(value, (size_t)n, sizeof *value, by_size);
    double ties;
    const double v = positive_ranks(value, n, &ties);
    free(value);
    if (!known) return (struct wilcoxon){NAN, NAN, false};
    if (n == 0) return (struct wilcoxon){0, 1, false};
    const double larger = fmax(v, 0.5 * n * (n + 1.0) - v);
    const bool exact = ties == 0 && n == a.n && n <= MAX_EXACT;
    const double tail = exact ? exact_tail(n, larger) : normal_tail(n, ties, larger);
    return (struct wilcoxon){v, fmin(1, 2 * tail), exact};
}
