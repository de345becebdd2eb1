// SPDX-License-Identifier: GPL-3.0-or-later
// With f = G(x) - x (`step`) and the changes df_k (`residual_change`), dG_k
// (`image_change`) of the last steps, the newest first,
//     gram c = df . f,  gram = df . df   [Cholesky: lower, part],
//     x_new = x + f - sum_k c_k dG_k.
// A change that depends on newer ones to ALIKE of its square is left out. Where |f|
// grows by LOST, G is not linear and all changes are dropped. Sums in a fixed order.
#include "sparse/anderson_normal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double LOST = 4, ALIKE = 1e-8;

struct anderson_normal anderson_normal_init(int n, int depth)
{
    const size_t all = (size_t)n * (size_t)depth;
    return (struct anderson_normal){.n = n,
                                    .depth = depth,
                                    .n_kept = -1,
                                    .norm = INFINITY,
                                    .last_residual = NEW_ARRAY(double, n),
                                    .last_step = NEW_ARRAY(double, n),
                                    .residual_change = NEW_ARRAY(double, all),
                                    .image_change = NEW_ARRAY(double, all)};
}

void anderson_normal_free(struct anderson_normal *a)
{
    free(a->last_residual);
    free(a->last_step);
    free(a->residual_change);
    free(a->image_change);
}

void anderson_normal_begin(struct anderson_normal *a)
{
    a->n_kept = -1;
    a->newest = 0;
    a->norm = INFINITY;
}

// Eight sums, so that none waits for the one before.
static double product(const double *restrict a, const double *restrict b, int n)
{
    enum { LANES = 8 };
    double sum[LANES] = {0}, all = 0;
    int i = 0;
    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        all += a[i] * b[i];
    for (int k = 0; k < LANES; k++)
        all += sum[k];
    return all;
}

static double *row_of(double *rows, int k, int n)
{
    return rows + (ptrdiff_t)k * n;
}

// The new change takes the place of the oldest.
static void keep(struct anderson_normal *a, const double *restrict step)
{
    const int n = a->n;
    const double norm = sqrt(product(step, step, n));
    if (norm > LOST * a->norm) a->n_kept = -1;
    a->norm = norm;
    if (a->n_kept >= 0) {
        a->newest = (a->newest + 1) % a->depth;
        if (a->n_kept < a->depth) a->n_kept++;
        double *restrict residual = row_of(a->residual_change, a->newest, n);
        double *restrict image = row_of(a->image_change, a->newest, n);
        for (int i = 0; i < n; i++) {
            residual[i] = step[i] - a->last_residual[i];
            image[i] = residual[i] + a->last_step[i];
        }
        for (int k = 0; k < a->n_kept; k++) {
            const int at = (a->newest + a->depth - k) % a->depth;
            a->gram[at][a->newest] = a->gram[a->newest][at] =
                product(residual, row_of(a->residual_change, at, n), n);
        }
    } else {
        a->n_kept = 0;
    }
    memcpy(a->last_residual, step, (size_t)n * sizeof *step);
}

// The K-th row of the Cholesky factor, of changes AT; PART of it solved forward. False:
// it depends on those before.
static bool factor_row(const struct anderson_normal *a, int k, const int *at,
                       const bool *good, double lower[][ANDERSON_NORMAL_DEPTH],
                       double *part)
{
    const double own = a->gram[at[k]][at[k]];
    double left = own;
    for (int j = 0; j < k; j++) {
        if (!good[j]) continue;
        double sum = a->gram[at[k]][at[j]];
        for (int i = 0; i < j; i++)
            if (good[i]) sum -= lower[k][i] * lower[j][i];
        lower[k][j] = sum / lower[j][j];
        left -= lower[k][j] * lower[k][j];
        part[k] -= lower[k][j] * part[j];
    }
    if (!(left > ALIKE * own)) return false;
    lower[k][k] = sqrt(left);
    part[k] /= lower[k][k];
    return true;
}

void anderson_normal_step(struct anderson_normal *a, double *step)
{
    double lower[ANDERSON_NORMAL_DEPTH][ANDERSON_NORMAL_DEPTH],
        part[ANDERSON_NORMAL_DEPTH];
    bool good[ANDERSON_NORMAL_DEPTH] = {0};
    int at[ANDERSON_NORMAL_DEPTH];
    keep(a, step);
    const int n = a->n, m = a->n_kept;
    for (int k = 0; k < m; k++) {
        at[k] = (a->newest + a->depth - k) % a->depth;
        part[k] = product(row_of(a->residual_change, at[k], n), step, n);
        good[k] = factor_row(a, k, at, good, lower, part);
    }
    for (int k = m - 1; k >= 0; k--) {
        if (!good[k]) continue;
        for (int j = k + 1; j < m; j++)
            if (good[j]) part[k] -= lower[j][k] * part[j];
        part[k] /= lower[k][k];
        const double *restrict image = row_of(a->image_change, at[k], n);
        for (int i = 0; i < n; i++)
            step[i] -= part[k] * image[i];
    }
    memcpy(a->last_step, step, (size_t)n * sizeof *step);
}
