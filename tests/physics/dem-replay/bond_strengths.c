// SPDX-License-Identifier: GPL-3.0-or-later
// Strengths of bonds that scatter, against their distributions, and the weakest link of
// a chain against its closed form.
#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "../support_irregular.h"
#include "basics/sorted.h"
#include "dem-replay/bonds.h"
#include "load_in_memory.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>

// The share of strengths below X; normal ones have none below 0.
static double share_below(const struct strength_scatter *scatter, double x)
{
    if (scatter->law == STRENGTH_WEIBULL)
        return gsl_cdf_weibull_P(x, 1 / tgamma(1 + 1 / scatter->modulus),
                                 scatter->modulus);
    const double cut = gsl_cdf_ugaussian_P(-1 / scatter->variation);
    const double below = gsl_cdf_ugaussian_P((x - 1) / scatter->variation);
    return (below - cut) / (1 - cut);
}

static double mean_of(const struct strength_scatter *scatter)
{
    if (scatter->law == STRENGTH_WEIBULL) return 1;
    const double v = scatter->variation; // of a normal one above 0
    return 1 + v * gsl_ran_ugaussian_pdf(1 / v) / gsl_cdf_ugaussian_P(1 / v);
}

static double variance_of(const struct strength_scatter *scatter)
{
    if (scatter->law == STRENGTH_WEIBULL) {
        const double m = scatter->modulus;
        return tgamma(1 + 2 / m) / pow(tgamma(1 + 1 / m), 2) - 1;
    }
    const double v = scatter->variation, beyond = mean_of(scatter) - 1;
    return v * v - beyond * (1 + beyond);
}

// Kolmogorov and Smirnov's distance times sqrt(n) is below 1.63 in 99 of 100 samples;
// moments lie within four standard errors of the widest, m = 1. Seeds are fixed.
TEST(drawn_as_the_distribution_says)
{
    enum { N = 100000 };
    const struct strength_scatter scatters[] = {
        {.law = STRENGTH_NORMAL, .variation = 0.05, .seed = 1},
        {.law = STRENGTH_NORMAL, .variation = 0.3, .seed = 2},
        {.law = STRENGTH_NORMAL, .variation = 1, .seed = 3},
        {.law = STRENGTH_WEIBULL, .modulus = 1, .seed = 1},
        {.law = STRENGTH_WEIBULL, .modulus = 5, .seed = 2},
        {.law = STRENGTH_WEIBULL, .modulus = 40, .seed = 3}};
    for (size_t k = 0; k < sizeof scatters / sizeof *scatters; k++) {
        double *x = draw_strengths(&scatters[k], N);
        double sum = 0, square = 0, furthest = 0;
        qsort(x, N, sizeof *x, rising_doubles);
        assert_true(x[0] >= 0);
        for (int b = 0; b < N; b++) {
            const double share = share_below(&scatters[k], x[b]);
            furthest = fmax(furthest, fmax(fabs(share - (double)b / N),
                                           fabs(share - (double)(b + 1) / N)));
            sum += x[b] / N;
        }
        for (int b = 0; b < N; b++)
            square += (x[b] - sum) * (x[b] - sum) / (N - 1);
        const double variance = variance_of(&scatters[k]);
        if (!(furthest * sqrt(N) < 1.63 &&
              fabs(sum - mean_of(&scatters[k])) < 4 * sqrt(variance / N) &&
              fabs(square / variance - 1) < 4 * sqrt(8.0 / N)))
            fail_msg("%zu: distance %g, mean %g, variance %g for %g", k,
                     furthest * sqrt(N), sum, square, variance);
        free(x);
    }
}

// The first of many are those of few; another seed gives others; one strength is none.
TEST(one_number_a_bond)
{
    struct strength_scatter scatter = {
        .law = STRENGTH_WEIBULL, .modulus = 5, .seed = 7};
    double *few = draw_strengths(&scatter, 10), *many = draw_strengths(&scatter, 1000);
    assert_memory_equal(few, many, 10 * sizeof *few);
    scatter.seed = 8;
    double *other = draw_strengths(&scatter, 10);
    for (int b = 0; b < 10; b++)
        assert_true(few[b] != other[b]);
    scatter.law = STRENGTH_ONE;
    assert_null(draw_strengths(&scatter, 10));
    free(few);
    free(many);
    free(other);
}

// ---- the weakest link ---------------------------------------------------------------

static const double strength = 1e5; // N/m2, the mean
static const double fraction = 0.5858;

static double area(void)
{
    return M_PI * pow(fraction * RADIUS, 2);
}

static int weakest(const double *relative, int n)
{
    int least = 0;
    for (int b = 1; b < n; b++)
        if (relative[b] < relative[least]) least = b;
    return least;
}

// How a chain of N bonds, held at one end, answers to a pull at the other that grows to
// SHARE of its weakest bond in STEPS; which bonds broke.
static int pull_chain(int n, double *relative, enum engine engine, double share,
                      int steps, int *first)
{
    struct packing packing = cubic_lattice(n + 1, 1, 1, false);
    uint8_t *held = NEW_ARRAY(uint8_t, n + 1);
    held[0] = 1;
    struct rows_in_memory rows = {NEW_ARRAY(struct vector, steps * (n + 1)), n + 1};
    struct load load = {.n_time = steps,
                        .time = NEW_ARRAY(double, steps),
                        .saturation = NEW_ARRAY(double, steps),
                        .source = &rows,
                        .force = row_in_memory};
    const double most = share * relative[weakest(relative, n)] * strength * area();
    for (int k = 0; k < steps; k++)
        rows.force[k * (n + 1) + n].x = most * (k + 1) / steps;
    struct dem_setup stiff = stiff_setup(&packing);
    stiff.material.damping_ratio = 0.05; // bonds are soft beside contacts
    const struct replay_settings settings = {
        .material = stiff.material,
        .bond = {8e14, 8e14, strength, strength, fraction, DEM_PARALLEL_BOND},
        .relative_strength = relative,
        .held = held,
        .support = SUPPORT_FIXED,
        .engine = engine,
        .equilibrium_tolerance = 1e-10,
        .most_iterations = 40,
        .time_step_safety = 0.045,
        .cycles = 1000,
        .tolerance = NAN,
        .threads = 1};
    struct response response = replay_or_fail(&packing, &load, &settings);
    const int cracks = response.n_crack;
    *first = cracks ? response.crack[0].bond : -1;
    response_free(&response);
    free(load.time);
    free(load.saturation);
    free(rows.force);
    free(held);
    packing_free(&packing);
    return cracks;
}

// Of N Weibull bonds in series the weakest is a Weibull strength too, n^(-1/m) as
// large; and that is the pull at which the chain breaks, there and nowhere else.
TEST(a_chain_is_as_strong_as_its_weakest_link)
{
    enum { SEEDS = 400 };
    const double m = 5;
    const int length[] = {1, 4, 16};
    for (size_t k = 0; k < sizeof length / sizeof *length; k++) {
        const int n = length[k];
        double sum = 0;
        for (int seed = 1; seed <= SEEDS; seed++) {
            const struct strength_scatter scatter = {
                .law = STRENGTH_WEIBULL, .modulus = m, .seed = seed};
            double *relative = draw_strengths(&scatter, n);
            int first;
            assert_int_equal(
                pull_chain(n, relative, ENGINE_QUASI_STATIC, 1 - 1e-6, 1, &first), 0);
            assert_int_equal(
                pull_chain(n, relative, ENGINE_QUASI_STATIC, 1 + 1e-6, 1, &first), 1);
            assert_int_equal(first, weakest(relative, n));
            sum += relative[first] / SEEDS;
            free(relative);
        }
        const double variation =
            sqrt(tgamma(1 + 2 / m) / pow(tgamma(1 + 1 / m), 2) - 1);
        assert_close(sum, pow(n, -1 / m), 3 * variation / sqrt(SEEDS));
    }
}

// The discrete elements break the same bond, if the pull grows slowly enough.
TEST(the_same_link_in_cycles)
{
    enum { N = 6 };
    for (int seed = 1; seed <= 5; seed++) {
        const struct strength_scatter scatter = {
            .law = STRENGTH_NORMAL, .variation = 0.3, .seed = seed};
        double *relative = draw_strengths(&scatter, N);
        int first;
        assert_int_equal(pull_chain(N, relative, ENGINE_EXPLICIT, 0.98, 100, &first),
                         0);
        assert_int_equal(pull_chain(N, relative, ENGINE_EXPLICIT, 1.02, 100, &first),
                         1);
        assert_int_equal(first, weakest(relative, N));
        free(relative);
    }
}

// ---- which grains are bonded --------------------------------------------------------

// On a lattice with the spacing of 2.1 radii along x: touching leaves those out, a gap
// of 5 % takes them in, one of 45 % the diagonals across faces too.
TEST(bonded_by_touch_or_distance)
{
    struct packing packing = cubic_lattice(3, 3, 3, false);
    for (int i = 0; i < packing.n_particle; i++)
        packing.position[i].x *= 1.05;
    const int listed = packing.n_bond = 1;
    bond_grains(&packing, BONDS_BY_PACKING, 1);
    assert_int_equal(packing.n_bond, listed);
    bond_grains(&packing, BONDS_BY_TOUCHING, 1);
    assert_int_equal(packing.n_bond, 2 * 18);
    bond_grains(&packing, BONDS_BY_DISTANCE, 0.0499);
    assert_int_equal(packing.n_bond, 2 * 18);
    bond_grains(&packing, BONDS_BY_DISTANCE, 0.0501);
    assert_int_equal(packing.n_bond, 3 * 18);
    bond_grains(&packing, BONDS_BY_DISTANCE, 0.4501);
    assert_int_equal(packing.n_bond, 3 * 18 + 3 * 24);
    packing_free(&packing);
}

// ---- which bond is how strong -------------------------------------------------------

static void check_renumbered(const struct packing *packing, const int *order)
{
    const struct strength_scatter scatter = {
        .law = STRENGTH_WEIBULL, .modulus = 3, .seed = 4};
    struct packing other = turned_packing(packing, (struct vector){0, 0, 1}, 0, order);
    other.lower = packing->lower; // turning grows the box
    other.upper = packing->upper;
    int *number = NEW_ARRAY(int, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++) {
        number[order[i]] = i;
        other.position[i].x += 0.3 * RADIUS; // and it may lie elsewhere
    }
    double *here = bond_strengths(&scatter, packing),
           *there = bond_strengths(&scatter, &other);
    int moved = 0;
    for (int b = 0; b < packing->n_bond; b++) {
        const int i = number[packing->bond[b][0]], j = number[packing->bond[b][1]];
        int c = 0;
        while (c < other.n_bond && !((other.bond[c][0] == i && other.bond[c][1] == j) ||
                                     (other.bond[c][0] == j && other.bond[c][1] == i)))
            c++;
        assert_in_range(c, 0, other.n_bond - 1);
        assert_true(here[b] == there[c]);
        moved += b != c;
    }
    assert_true(moved > packing->n_bond / 2);
    free(number);
    free(here);
    free(there);
    packing_free(&other);
}

// A bond is as strong however the grains are numbered: irregular ones, also where the
// box repeats; and a lattice with the diagonals of its faces, which cross.
TEST(as_strong_whatever_the_numbers)
{
    for (int repeats = 0; repeats < 2; repeats++) {
        struct packing packing = irregular_packing(4, RADIUS, repeats);
        int *order = shuffled(packing.n_particle, &(uint64_t){5});
        check_renumbered(&packing, order);
        free(order);
        packing_free(&packing);
    }
    struct packing packing = cubic_lattice(4, 3, 3, false);
    bond_grains(&packing, BONDS_BY_DISTANCE, 0.45);
    int *order = shuffled(packing.n_particle, &(uint64_t){6});
    check_renumbered(&packing, order);
    free(order);
    packing_free(&packing);
}
