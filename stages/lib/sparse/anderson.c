// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson acceleration with f = G(x) - x (`step`) and, of the last m <= ANDERSON_DEPTH
// steps, the changes df_k (`residual_change`) and dG_k (`image_change`):
//     basis, r:  df = basis r, by Gram and Schmidt, twice;
//     part = basis . f,  r c = part (backwards);
//     x_new = x + f - sum_k c_k dG_k.
// The sum is the best combination of the changes for f in least squares, so where G is
// linear this is GMRES. A df_k nearly dependent on newer ones (below ALIKE) is left
// out. When |f| grows by more than LOST, G is not linear here: all changes are dropped.
#include "sparse/anderson.h"

#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Growth of |f| after which the changes are dropped.
static const double LOST = 10;

// A change with less than this share normal to the others adds nothing.
static const double ALIKE = 1e-3;

struct anderson anderson_init(int most)
{
    struct anderson anderson = {.last_residual = NEW_ARRAY(double, most),
                                .last_step = NEW_ARRAY(double, most)};
    for (int k = 0; k < ANDERSON_DEPTH; k++) {
        anderson.residual_change[k] = NEW_ARRAY(double, most);
        anderson.image_change[k] = NEW_ARRAY(double, most);
        anderson.basis[k] = NEW_ARRAY(double, most);
    }
    return anderson;
}

void anderson_free(struct anderson *anderson)
{
    for (int k = 0; k < ANDERSON_DEPTH; k++) {
        free(anderson->residual_change[k]);
        free(anderson->image_change[k]);
        free(anderson->basis[k]);
    }
    free(anderson->last_residual);
    free(anderson->last_step);
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

// The oldest change is replaced by a new one, which comes first.
static void make_place(struct anderson *anderson)
{
    const int last = ANDERSON_DEPTH - 1;
    double *residual_change = anderson->residual_change[last],
           *image_change = anderson->image_change[last];
    const size_t bytes = (size_t)last * sizeof *anderson->residual_change;
    memmove(anderson->residual_change + 1, anderson->residual_change, bytes);
    memmove(anderson->image_change + 1, anderson->image_change, bytes);
    anderson->residual_change[0] = residual_change;
    anderson->image_change[0] = image_change;
}

static void keep(struct anderson *anderson, const double *step)
{
    const double norm = sqrt(product(step, step, anderson->n));
    if (norm > LOST * anderson->norm) anderson->n_kept = -1;
    anderson->norm = norm;
    if (anderson->n_kept >= 0) make_place(anderson);
    for (int i = 0; anderson->n_kept >= 0 && i < anderson->n; i++) {
        anderson->residual_change[0][i] = step[i] - anderson->last_residual[i];
        anderson->image_change[0][i] =
            anderson->residual_change[0][i] + anderson->last_step[i];
    }
    if (anderson->n_kept < ANDERSON_DEPTH) anderson->n_kept++;
    memcpy(anderson->last_residual, step, (size_t)anderson->n * sizeof *step);
}

// Orthogonalises the K-th change by Gram and Schmidt, twice for the digits; its parts
// along the changes before it go to R (k+1). Returns whether it is independent of them.
static bool orthogonalise(struct anderson *anderson, int k, double *r)
{
    double *basis = anderson->basis[k];
    const int n = anderson->n;
    memcpy(basis, anderson->residual_change[k], (size_t)n * sizeof *basis);
    const double before = sqrt(product(basis, basis, n));
    memset(r, 0, (size_t)(k + 1) * sizeof *r);
    for (int pass = 0; pass < 2; pass++)
        for (int j = 0; j < k; j++) {
            const double part = product(anderson->basis[j], basis, n);
            r[j] += part;
            for (int i = 0; i < n; i++)
                basis[i] -= part * anderson->basis[j][i];
        }
    r[k] = sqrt(product(basis, basis, n));
    const bool good = r[k] > ALIKE * before;
    for (int i = 0; i < n; i++)
        basis[i] = good ? basis[i] / r[k] : 0;
    return good;
}

void anderson_step(struct anderson *anderson, double *step)
{
    keep(anderson, step);
    const int n = anderson->n, m = anderson->n_kept;
    double r[ANDERSON_DEPTH][ANDERSON_DEPTH], part[ANDERSON_DEPTH];
    bool good[ANDERSON_DEPTH] = {false};
    for (int k = 0; k < m; k++) {
        good[k] = orthogonalise(anderson, k, r[k]);
        part[k] = product(anderson->basis[k], step, n);
    }
    for (int k = m - 1; k >= 0; k--) {
        if (!good[k]) continue;
        part[k] /= r[k][k];
        for (int j = 0; j < k; j++)
            part[j] -= part[k] * r[k][j];
        for (int i = 0; i < n; i++)
            step[i] -= part[k] * anderson->image_change[k][i];
    }
    memcpy(anderson->last_step, step, (size_t)n * sizeof *step);
}
