// SPDX-License-Identifier: GPL-3.0-or-later
// Of the loads q and strains e of those rows that are now unlike the factor, q is
// k (e + a) for what is bonded otherwise and k (e - c) for what touches otherwise,
// where e = given - W q: with k known (k^-1 + W) q = k^-1 q(0) + given. Stiffer ones
// first the matrix needs no pivots: it is definite in them, and, as the whole aggregate
// resists, what is left for the softer ones is negative definite.
#include "settle_lane.h"

#include "basics/memory.h"
#include "sparse/dense_symmetric.h"

#include <stdlib.h>
#include <string.h>

struct settler {
    int capacity;
    int n_acting, *acting; // rows, the stiffer first
    int n_factored, *factored;
    double *factored_slope;
    double *slope, *at_zero; // (n_acting)
    double *sign, *answer, *strain;
    double *matrix, *work;
};

struct settler *settler_new(void)
{
    return NEW_ARRAY(struct settler, 1);
}

void settler_free(struct settler *s)
{
    if (!s) return;
    void *const owned[] = {s->acting,  s->factored, s->factored_slope, s->slope,
                           s->at_zero, s->sign,     s->answer,         s->strain,
                           s->matrix,  s->work};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(s);
}

void settler_forget(struct settler *s)
{
    s->n_factored = -1;
}

static void make_room(struct settler *s, int count)
{
    if (s->matrix && count <= s->capacity) return;
    const size_t n = (size_t)(s->capacity = 2 * count + 64);
    int **const whole[] = {&s->acting, &s->factored};
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        *whole[k] = reallocate(*whole[k], n, sizeof **whole);
    double **const real[] = {&s->factored_slope, &s->slope,  &s->at_zero,
                             &s->sign,           &s->answer, &s->strain};
    for (size_t k = 0; k < sizeof real / sizeof *real; k++)
        *real[k] = reallocate(*real[k], n, sizeof **real);
    s->matrix = reallocate(s->matrix, n * n + 8, sizeof *s->matrix);
    s->work = reallocate(s->work, 24 * n, sizeof *s->work);
    s->n_factored = -1;
}

// Rows that resist otherwise than factored.
static void list_acting(struct settler *s, int count, const struct lane_row *row,
                        const bool *touches)
{
    s->n_acting = 0;
    for (int stiffer = 1; stiffer >= 0; stiffer--)
        for (int k = 0; k < count; k++) {
            const double contact =
                (touches[(long)k * LANES] - row[k].touched) * row[k].contact;
            const double slope = row[k].bond + contact;
            if (slope == 0 || (slope > 0) != stiffer) continue;
            s->acting[s->n_acting] = k;
            s->slope[s->n_acting] = slope;
            s->at_zero[s->n_acting++] =
                row[k].bond * row[k].strain - contact * row[k].closed_to;
        }
}

static bool is_factored(const struct settler *s)
{
    const size_t n = (size_t)s->n_acting;
    return s->n_factored == s->n_acting &&
           memcmp(s->factored, s->acting, n * sizeof *s->acting) == 0 &&
           memcmp(s->factored_slope, s->slope, n * sizeof *s->slope) == 0;
}

static bool factor(struct settler *s, struct corrections *corrections)
{
    const int n = s->n_acting;
    if (is_factored(s)) return true;
    for (int a = 0; a < n; a++) {
        const double *compliance = corrections_compliance(corrections, s->acting[a]);
        double *column = s->matrix + (long)a * n;
        for (int b = a; b < n; b++)
            column[b] = compliance[s->acting[b]];
        column[a] += 1 / s->slope[a];
        s->sign[a] = s->slope[a] > 0 ? 1 : -1;
    }
    corrections_count_work(corrections, (double)n * n * n / 6);
    s->n_factored = -1;
    if (!dense_symmetric_factor(n, s->matrix, n, s->sign, s->work)) return false;
    s->n_factored = n;
    memcpy(s->factored, s->acting, (size_t)n * sizeof *s->acting);
    memcpy(s->factored_slope, s->slope, (size_t)n * sizeof *s->slope);
    return true;
}

// The strains of all rows while those act.
static void find_strains(struct settler *s, const struct corrections *corrections,
                         int count, const double *given)
{
    for (int a = 0; a < s->n_acting; a++)
        s->answer[a] = s->at_zero[a] / s->slope[a] + given[(long)s->acting[a] * LANES];
    dense_symmetric_solve(s->n_acting, s->matrix, s->n_acting, s->sign, s->answer);
    for (int k = 0; k < count; k++)
        s->strain[k] = given[(long)k * LANES];
    for (int a = 0; a < s->n_acting; a++) {
        const double *restrict compliance =
            corrections_compliance(corrections, s->acting[a]);
        const double minus = -s->answer[a];
        double *restrict strain = s->strain;
        for (int k = 0; k < count; k++)
            strain[k] = fma(compliance[k], minus, strain[k]);
    }
}

bool settle_lane(struct settler *s, struct corrections *corrections,
                 const struct lane_row *row, bool may_change, const double *given,
                 bool *touches, double *load)
{
    enum { ROUNDS = 20 };
    const int count = corrections_count(corrections);
    make_room(s, count);
    for (int round = 0; round < ROUNDS; round++) {
        list_acting(s, count, row, touches);
        if (!factor(s, corrections)) return false;
        if (!may_change) memset(s->at_zero, 0, (size_t)s->n_acting * sizeof(double));
        find_strains(s, corrections, count, given);
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
