// SPDX-License-Identifier: GPL-3.0-or-later
// Of the loads q and strains e of those rows that are now unlike the factor, q is
// k (e + a) for what is bonded otherwise and k (e - c) for what touches otherwise,
// where e = given - W q: with k known (k^-1 + W) q = k^-1 q(0) + given. Stiffer ones
// first the matrix needs no pivots: it is definite in them, and, as the whole aggregate
// resists, what is left for the softer ones is negative definite. So it is with rows
// after those of an earlier system, as the aggregate resisted there: these are kept.
#include "settle_lane.h"

#include "basics/memory.h"
#include "sparse/dense_symmetric.h"

#include <stdlib.h>
#include <string.h>

struct settler {
    int capacity;
    int n_acting, *acting; // rows
    int n_factored, *factored;
    double *factored_slope;
    double *slope_of;        // (rows) 0: as factored
    double *slope, *at_zero; // (n_acting)
    double *sign, *answer, *strain;
    double *matrix, *work; // the matrix's columns CAPACITY apart
};

struct settler *settler_new(void)
{
    return NEW_ARRAY(struct settler, 1);
}

void settler_free(struct settler *s)
{
    if (!s) return;
    void *const owned[] = {
        s->acting, s->factored, s->factored_slope, s->slope,  s->at_zero, s->sign,
        s->answer, s->strain,   s->slope_of,       s->matrix, s->work};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(s);
}

void settler_forget(struct settler *s)
{
    s->n_factored = 0;
}

static void make_room(struct settler *s, int count)
{
    if (s->matrix && count <= s->capacity) return;
    const size_t n = (size_t)(s->capacity = 2 * count + 68);
    int **const whole[] = {&s->acting, &s->factored};
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        *whole[k] = reallocate(*whole[k], n, sizeof **whole);
    double **const real[] = {&s->factored_slope, &s->slope,  &s->at_zero, &s->sign,
                             &s->answer,         &s->strain, &s->slope_of};
    for (size_t k = 0; k < sizeof real / sizeof *real; k++)
        *real[k] = reallocate(*real[k], n, sizeof **real);
    s->matrix = reallocate(s->matrix, n * n + 8, sizeof *s->matrix);
    s->work = reallocate(s->work, DENSE_SYMMETRIC_WORK * n, sizeof *s->work);
    s->n_factored = 0;
}

static double contact_slope(const struct lane_row *row, bool touches)
{
    return (touches - row->touched) * row->contact;
}

// Rows that resist otherwise than factored: first those that did so before, as far as
// they are in the same order, then others, the stiffer before the softer. How many are
// the first.
static int list_acting(struct settler *s, int count, const struct lane_row *row,
                       const bool *touches)
{
    for (int k = 0; k < count; k++)
        s->slope_of[k] = row[k].bond + contact_slope(&row[k], touches[(long)k * LANES]);
    int same = 0;
    while (same < s->n_factored &&
           s->slope_of[s->factored[same]] == s->factored_slope[same])
        same++;
    for (int a = 0; a < same; a++) {
        s->acting[a] = s->factored[a];
        s->slope_of[s->factored[a]] = 0;
    }
    s->n_acting = same;
    for (int stiffer = 1; stiffer >= 0; stiffer--)
        for (int k = 0; k < count; k++)
            if (s->slope_of[k] != 0 && (s->slope_of[k] > 0) == stiffer)
                s->acting[s->n_acting++] = k;
    for (int a = 0; a < s->n_acting; a++) {
        const struct lane_row *of = &row[s->acting[a]];
        const double contact = contact_slope(of, touches[(long)s->acting[a] * LANES]);
        s->slope[a] = of->bond + contact;
        s->at_zero[a] = of->bond * of->strain - contact * of->closed_to;
        s->sign[a] = s->slope[a] > 0 ? 1 : -1;
    }
    return same;
}

static bool factor(struct settler *s, struct corrections *corrections, int same)
{
    const int n = s->n_acting;
    if (same == n && s->n_factored == n) return true;
    const int kept = dense_symmetric_kept(same);
    for (int a = 0; a < n; a++) {
        const double *compliance = corrections_compliance(corrections, s->acting[a]);
        double *column = s->matrix + (long)a * s->capacity;
        for (int b = a < kept ? same : a; b < n; b++)
            column[b] = compliance[s->acting[b]];
        if (a >= kept) column[a] += 1 / s->slope[a];
    }
    const double all = (double)n * n * n, before = (double)same * same * same;
    corrections_count_work(corrections, (all - before) / 6);
    s->n_factored = 0;
    if (!dense_symmetric_factor(n, same, s->matrix, s->capacity, s->sign, s->work))
        return false;
    s->n_factored = n;
    memcpy(s->factored, s->acting, (size_t)n * sizeof *s->acting);
    memcpy(s->factored_slope, s->slope, (size_t)n * sizeof *s->slope);
    return true;
}

// As rows were before, or, where they are not definite after those, from the beginning.
static bool factor_acting(struct settler *s, struct corrections *corrections, int count,
                          const struct lane_row *row, const bool *touches)
{
    const int same = list_acting(s, count, row, touches);
    if (factor(s, corrections, same)) return true;
    return same > 0 && factor(s, corrections, list_acting(s, count, row, touches));
}

// What WIDE of the acting rows, from A on, do to the strains of all.
static inline __attribute__((always_inline)) void
take_off_answers(struct settler *s, const struct corrections *corrections, int count,
                 int a, int wide)
{
    const double *compliance[4];
    double minus[4], *restrict strain = s->strain;
    for (int k = 0; k < wide; k++) {
        compliance[k] = corrections_compliance(corrections, s->acting[a + k]);
        minus[k] = -s->answer[a + k];
    }
    for (int i = 0; i < count; i++) {
        double left = strain[i];
        for (int k = 0; k < wide; k++)
            left = fma(compliance[k][i], minus[k], left);
        strain[i] = left;
    }
}

// The strains of all rows while those act.
static void find_strains(struct settler *s, const struct corrections *corrections,
                         int count, const double *given)
{
    for (int a = 0; a < s->n_acting; a++)
        s->answer[a] = s->at_zero[a] / s->slope[a] + given[(long)s->acting[a] * LANES];
    dense_symmetric_solve(s->n_acting, s->matrix, s->capacity, s->sign, s->answer);
    for (int k = 0; k < count; k++)
        s->strain[k] = given[(long)k * LANES];
    int a = 0;
    for (; a + 4 <= s->n_acting; a += 4)
        take_off_answers(s, corrections, count, a, 4);
    for (; a < s->n_acting; a++)
        take_off_answers(s, corrections, count, a, 1);
}

// Not where the factor is all but singular.
static bool are_finite(const double *number, int count)
{
    double none = 0;
    for (int k = 0; k < count; k++)
        none += 0 * number[k];
    return none == 0;
}

bool settle_lane(struct settler *s, struct corrections *corrections,
                 const struct lane_row *row, bool may_change, const double *given,
                 bool *touches, double *load)
{
    enum { ROUNDS = 20 };
    const int count = corrections_count(corrections);
    make_room(s, count);
    for (int round = 0; round < ROUNDS; round++) {
        if (!factor_acting(s, corrections, count, row, touches)) return false;
        if (!may_change) memset(s->at_zero, 0, (size_t)s->n_acting * sizeof(double));
        find_strains(s, corrections, count, given);
        if (!are_finite(s->strain, count)) return false;
        bool is_same = true;
        for (int k = 0; k < count && may_change; k++) {
            const bool now = row[k].contact > 0 && s->strain[k] <= row[k].closed_to;
            bool *touch = &touches[(long)k * LANES];
            is_same = is_same && now == *touch;
            *touch = now;
        }
        if (!is_same) continue;
        for (int k = 0; k < count; k++)
            load[(long)k * LANES] = 0;
        for (int a = 0; a < s->n_acting; a++)
            load[(long)s->acting[a] * LANES] = s->answer[a];
        return true;
    }
    return false;
}
