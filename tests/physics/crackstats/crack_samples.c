// SPDX-License-Identifier: GPL-3.0-or-later
// Confidence intervals and tests of two samples, against published outcomes: Student's
// sleep data, Hollander and Wolfe's membranes, the manual of scipy; and U by counting
// all orders.
#include "../../test.h"
#include "statistics/paired.h"

#include <math.h>
#include <stdlib.h>

// WANTED is published to so many digits.
static void assert_digits(double got, double wanted, double last_digit)
{
    if (!(fabs(got - wanted) <= 0.5000001 * last_digit))
        fail_msg("got %.17g, published %.17g", got, wanted);
}

#define SAMPLE(values) ((struct sample){values, sizeof(values) / sizeof *(values)})

// Extra hours of sleep with two drugs (Student 1908, after Cushny and Peebles);
// outcomes as R prints them for t.test(extra ~ group) and wilcox.test(extra ~ group).
static const double first_drug[] = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0, 2};
static const double second_drug[] = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(welch_on_student_sleep)
{
    const struct welch found = welch_test(SAMPLE(first_drug), SAMPLE(second_drug));
    assert_digits(found.t, -1.8608, 1e-4);
    assert_digits(found.degrees, 17.776, 1e-3);
    assert_digits(found.p, 0.07939, 1e-5);
}

// The drugs were given to the same ten: t.test(..., paired = TRUE) and
// wilcox.test(..., paired = TRUE). One slept as long with both.
TEST(pairs_of_student_sleep)
{
    const struct paired_t t = paired_t_test(SAMPLE(first_drug), SAMPLE(second_drug));
    assert_digits(t.mean, -1.58, 1e-2);
    assert_digits(t.t, -4.0621, 1e-4);
    assert_within(t.degrees, 9, 0);
    assert_digits(t.p, 0.002833, 1e-6);
    const struct wilcoxon rank = wilcoxon_test(SAMPLE(first_drug), SAMPLE(second_drug));
    assert_within(rank.v, 0, 0);
    assert_digits(rank.p, 0.009091, 1e-6);
    assert_false(rank.exact);
}

// Depression before and after a tranquiliser (Hollander and Wolfe 1973, p. 29), in R's
// manual of wilcox.test: V = 40, p = 0.01953 one-sided, of 2^9 orders of signs 10.
TEST(signed_ranks_of_depression)
{
    static const double before[] = {1.83, 0.50, 1.62, 2.48, 1.68,
                                    1.88, 1.55, 3.06, 1.30};
    static const double after[] = {0.878, 0.647, 0.598, 2.05, 1.06,
                                   1.29,  1.06,  3.14,  1.29};
    const struct wilcoxon found = wilcoxon_test(SAMPLE(before), SAMPLE(after));
    assert_within(found.v, 40, 0);
    assert_within(found.p, 2 * 10.0 / 512, 1e-15);
    assert_true(found.exact);
    assert_within(wilcoxon_test(SAMPLE(after), SAMPLE(before)).p, found.p, 0);
}

// All signs of n differences, one by one.
TEST(signed_ranks_by_counting)
{
    enum { N = 8 };
    double zero[N] = {0}, value[N];
    for (int signs = 0; signs < 1 << N; signs++) {
        int v = 0, as_far = 0;
        for (int k = 0; k < N; k++) {
            value[k] = (signs >> k & 1 ? 1 : -1) * (k + 1.5);
            if (signs >> k & 1) v += k + 1;
        }
        const int far = abs(2 * v - N * (N + 1) / 2);
        for (int other = 0; other < 1 << N; other++) {
            int w = 0;
            for (int k = 0; k < N; k++)
                if (other >> k & 1) w += k + 1;
            as_far += abs(2 * w - N * (N + 1) / 2) >= far;
        }
        const struct wilcoxon found = wilcoxon_test(SAMPLE(value), SAMPLE(zero));
        assert_within(found.v, v, 0);
        assert_within(found.p, fmin(1, (double)as_far / (1 << N)), 1e-14);
    }
}

TEST(pairs_that_say_little)
{
    static const double same[] = {3, 4, 5}, more[] = {4, 5, 6}, unknown[] = {1, NAN, 2};
    assert_within(paired_t_test(SAMPLE(same), SAMPLE(same)).p, 1, 0);
    assert_within(paired_t_test(SAMPLE(more), SAMPLE(same)).p, 0, 0);
    assert_within(wilcoxon_test(SAMPLE(same), SAMPLE(same)).p, 1, 0);
    assert_true(isnan(paired_t_test(SAMPLE(unknown), SAMPLE(same)).p));
    assert_true(isnan(wilcoxon_test(SAMPLE(unknown), SAMPLE(same)).p));
    assert_true(
        isnan(paired_t_test((struct sample){same, 1}, (struct sample){more, 1}).p));
}

// With one degree of freedom Student's is Cauchy's.
TEST(two_pairs)
{
    static const double before[] = {5, 9}, after[] = {4, 6};
    const struct paired_t found = paired_t_test(SAMPLE(before), SAMPLE(after));
    assert_within(found.t, 2, 1e-15);
    assert_within(found.p, 1 - 2 * atan(2) / M_PI, 1e-14);
}

TEST(interval_of_student_sleep)
{
    const struct sample sample = SAMPLE(first_drug);
    const double half = half_width(sample, 0.95);
    assert_digits(sample_mean(sample) - half, -0.5297804, 1e-7);
    assert_digits(sample_mean(sample) + half, 2.0297804, 1e-7);
}

TEST(ranks_of_student_sleep_with_ties)
{
    const struct mann_whitney found =
        mann_whitney_test(SAMPLE(first_drug), SAMPLE(second_drug));
    assert_within(found.u, 25.5, 0);
    assert_digits(found.p, 0.06933, 1e-5);
    assert_false(found.exact);
}

// Permeability of the human chorioamnion (Hollander and Wolfe 1973, p. 69); R gives
// W = 35 and 0.1272 for one side.
TEST(ranks_of_hollander_and_wolfe)
{
    static const double at_term[] = {0.80, 0.83, 1.89, 1.04, 1.45,
                                     1.38, 1.91, 1.64, 0.73, 1.46};
    static const double earlier[] = {1.15, 0.88, 0.90, 0.74, 1.21};
    const struct mann_whitney found =
        mann_whitney_test(SAMPLE(at_term), SAMPLE(earlier));
    assert_within(found.u, 35, 0);
    assert_digits(found.p / 2, 0.1272, 1e-4);
    assert_true(found.exact);
}

// Ages at diagnosis, in scipy's manual of mannwhitneyu: U = 17, p = 0.1111111111111111.
TEST(ranks_of_the_manual_of_scipy)
{
    static const double males[] = {19, 22, 16, 29, 24}, females[] = {20, 11, 17, 12};
    const struct mann_whitney found = mann_whitney_test(SAMPLE(males), SAMPLE(females));
    assert_within(found.u, 17, 0);
    assert_within(found.p, 1. / 9, 1e-15);
}

// U of every choice of four ranks of nine, counted one by one.
TEST(exact_ranks_by_counting)
{
    enum { N = 9, FEW = 4 };
    int count[FEW * (N - FEW) + 1] = {0}, all = 0;
    for (unsigned chosen = 0; chosen < 1u << N; chosen++) {
        if (__builtin_popcount(chosen) != FEW) continue;
        int u = 0;
        for (int i = 0; i < N; i++)
            for (int j = 0; j < i; j++)
                u += (chosen >> i & 1) && !(chosen >> j & 1);
        count[u]++;
        all++;
    }
    for (unsigned chosen = 0; chosen < 1u << N; chosen++) {
        if (__builtin_popcount(chosen) != FEW) continue;
        double a[FEW], b[N - FEW];
        int n_a = 0, n_b = 0;
        for (int i = 0; i < N; i++)
            *(chosen >> i & 1 ? &a[n_a++] : &b[n_b++]) = 10 + i;
        const struct mann_whitney found = mann_whitney_test(SAMPLE(a), SAMPLE(b));
        double beyond = 0;
        const double distance = fabs(found.u - FEW * (N - FEW) / 2.);
        for (int u = 0; u <= FEW * (N - FEW); u++)
            if (fabs(u - FEW * (N - FEW) / 2.) >= distance) beyond += count[u];
        assert_within(found.p, beyond / all, 1e-14);
    }
}

// Of even degrees the chance is a finite sum [Abramowitz and Stegun 26.7.4].
TEST(student_in_closed_form)
{
    for (int degrees = 2; degrees <= 400; degrees += 2)
        for (double t = 0; t < 4; t += 0.37) {
            const double angle = atan(t / sqrt(degrees)), square = pow(cos(angle), 2);
            double term = 1, sum = 1;
            for (int k = 2; k < degrees; k += 2)
                sum += term *= square * (k - 1) / k;
            assert_within(student_p(t, degrees), 1 - sin(angle) * sum, 1e-12);
        }
}

// Half the interval of 1, -1, 1 ...: Student's quantile over the root of n - 1. So many
// digits of it by 30-digit arithmetic.
TEST(interval_of_many)
{
    double value[42];
    for (int k = 0; k < 42; k++)
        value[k] = k % 2 ? -1 : 1;
    const double forty = half_width((struct sample){value, 40}, 0.95) * sqrt(39);
    const double few = half_width((struct sample){value, 2}, 0.95); // tan(0.95 pi/2)
    assert_digits(forty, 2.02269092003676, 1e-14);
    assert_within(few, tan(0.475 * M_PI), 1e-12);
}

TEST(what_tells_nothing)
{
    static const double one[] = {1}, same[] = {2, 2, 2}, more[] = {3, 3};
    static const double unknown[] = {1, NAN, 2};
    assert_true(isnan(welch_test(SAMPLE(unknown), SAMPLE(same)).p));
    assert_true(isnan(half_width(SAMPLE(one), 0.95)));
    assert_true(isnan(welch_test(SAMPLE(one), SAMPLE(same)).p));
    assert_within(half_width(SAMPLE(same), 0.95), 0, 0);
    assert_within(welch_test(SAMPLE(same), SAMPLE(same)).p, 1, 0);
    assert_within(welch_test(SAMPLE(same), SAMPLE(more)).p, 0, 0);
    assert_true(welch_test(SAMPLE(same), SAMPLE(more)).t < -1e300);
    assert_within(mann_whitney_test(SAMPLE(same), SAMPLE(same)).p, 1, 0);
}
