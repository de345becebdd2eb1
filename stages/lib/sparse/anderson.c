// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/anderson.h"

#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// A step after which the difference has grown by this much has left where G is linear.
static const double LOST = 10;

// A fall of which so little is left at right angles to the others adds nothing.
static const double ALIKE = 1e-3;

struct anderson anderson_make(int most)
{
    struct anderson anderson = {.last = NEW_ARRAY(double, most),
                                .sent = NEW_ARRAY(double, most)};
    for (int k = 0; k < ANDERSON_DEPTH; k++) {
        anderson.fall[k] = NEW_ARRAY(double, most);
        anderson.rise[k] = NEW_ARRAY(double, most);
        anderson.base[k] = NEW_ARRAY(double, most);
    }
    return anderson;
}

void anderson_free(struct anderson *anderson)
{
    for (int k = 0; k < ANDERSON_DEPTH; k++) {
        free(anderson->fall[k]);
        free(anderson->rise[k]);
        free(anderson->base[k]);
    }
    free(anderson->last);
    free(anderson->sent);
    *anderson = (struct anderson){0};
}

void anderson_begin(struct anderson *anderson, int n)
{
    anderson->n = n;
    anderson->n_kept = -1; // not even a last x
    anderson->norm = INFINITY;
}

static double product(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// The oldest difference makes room for a new one, which comes first.
static void move_down(struct anderson *anderson)
{
    const int last = ANDERSON_DEPTH - 1;
    double *fall = anderson->fall[last], *rise = anderson->rise[last];
    const size_t bytes = (size_t)last * sizeof *anderson->fall;
    memmove(anderson->fall + 1, anderson->fall, bytes);
    memmove(anderson->rise + 1, anderson->rise, bytes);
    anderson->fall[0] = fall;
    anderson->rise[0] = rise;
}

static void keep(struct anderson *anderson, const double *step)
{
    const double norm = sqrt(product(step, step, anderson->n));
    if (norm > LOST * anderson->norm) anderson->n_kept = -1;
    anderson->norm = norm;
    if (anderson->n_kept >= 0) move_down(anderson);
    for (int i = 0; anderson->n_kept >= 0 && i < anderson->n; i++) {
        anderson->fall[0][i] = step[i] - anderson->last[i];
        anderson->rise[0][i] = anderson->fall[0][i] + anderson->sent[i];
    }
    if (anderson->n_kept < ANDERSON_DEPTH) anderson->n_kept++;
    memcpy(anderson->last, step, (size_t)anderson->n * sizeof *step);
}

// Gram and Schmidt's, twice for the digits. What remains of the K-th fall, and its
// parts along those before it in R (k+1).
static bool straighten(struct anderson *anderson, int k, double *r)
{
    double *base = anderson->base[k];
    const int n = anderson->n;
    memcpy(base, anderson->fall[k], (size_t)n * sizeof *base);
    const double before = sqrt(product(base, base, n));
    memset(r, 0, (size_t)(k + 1) * sizeof *r);
    for (int pass = 0; pass < 2; pass++)
        for (int j = 0; j < k; j++) {
            const double part = product(anderson->base[j], base, n);
            r[j] += part;
            for (int i = 0; i < n; i++)
                base[i] -= part * anderson->base[j][i];
        }
    r[k] = sqrt(product(base, base, n));
    const bool good = r[k] > ALIKE * before;
    for (int i = 0; i < n; i++)
        base[i] = good ? base[i] / r[k] : 0;
    return good;
}

void anderson_step(struct anderson *anderson, double *step)
{
    keep(anderson, step);
    const int n = anderson->n, m = anderson->n_kept;
    double r[ANDERSON_DEPTH][ANDERSON_DEPTH], part[ANDERSON_DEPTH];
    bool good[ANDERSON_DEPTH];
    for (int k = 0; k < m; k++) {
        good[k] = straighten(anderson, k, r[k]);
        part[k] = product(anderson->base[k], step, n);
    }
    for (int k = m - 1; k >= 0; k--) {
        if (!good[k]) continue;
        part[k] /= r[k][k];
        for (int j = 0; j < k; j++)
            part[j] -= part[k] * r[k][j];
        for (int i = 0; i < n; i++)
            step[i] -= part[k] * anderson->rise[k][i];
    }
    memcpy(anderson->sent, step, (size_t)n * sizeof *step);
}
