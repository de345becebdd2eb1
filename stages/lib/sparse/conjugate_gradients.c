// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients for A x = b, with r the residual, M the
// preconditioner and `ap` = A p:
//     z = M^-1 r,  beta = z.Ap / p.Ap (of the last p),  p = z - beta p,
//     alpha = p.r / p.Ap,  x += alpha p,  r -= alpha Ap.
// beta is found from Ap and not from r.z, so p stays conjugate to the last p even when
// M is only approximately symmetric (floats) or the call resumes after a restart with
// another r. Sums run over blocks of fixed length: the same digits for any number of
// threads.
#include "conjugate_gradients.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

enum { BLOCK = 4096, PARTIAL_SUMS = 8, LARGE = 20000 };

// In partial sums that processors add side by side.
static double block_product(const double *x, const double *y, int n)
{
    double partial[PARTIAL_SUMS] = {0}, sum = 0;
    int i = 0;
    for (; i + PARTIAL_SUMS <= n; i += PARTIAL_SUMS)
        for (int l = 0; l < PARTIAL_SUMS; l++)
            partial[l] += x[i + l] * y[i + l];
    for (; i < n; i++)
        sum += x[i] * y[i];
    for (int l = 0; l < PARTIAL_SUMS; l++)
        sum += partial[l];
    return sum;
}

double sum_of_products(const double *x, const double *y, int n)
{
    if (n <= BLOCK) return block_product(x, y, n);
    const int blocks = (n + BLOCK - 1) / BLOCK;
    double *part = NEW_ARRAY(double, blocks);
#pragma omp parallel for schedule(static) if (n > LARGE)
    for (int b = 0; b < blocks; b++) {
        const int begin = b * BLOCK, end = begin + BLOCK < n ? begin + BLOCK : n;
        part[b] = block_product(x + begin, y + begin, end - begin);
    }
    double sum = 0;
    for (int b = 0; b < blocks; b++)
        sum += part[b];
    free(part);
    return sum;
}

int resume_conjugate_gradients(const struct linear_problem *problem, double *residual,
                               double *x, double tolerance, int most)
{
    const int n = problem->n;
    double *z = problem->work[0], *p = problem->work[1], *ap = problem->work[2];
    double curvature = sum_of_products(p, ap, n);
    int iteration = 0;
    for (int i = 0; i < n; i++)
        x[i] = 0;
    while (iteration < most &&
           sqrt(sum_of_products(residual, residual, n)) > tolerance) {
        problem->precondition(problem->context, residual, z);
        const double beta = curvature > 0 ? sum_of_products(z, ap, n) / curvature
                                          : 0; // along the last p
#pragma omp parallel for schedule(static) if (n > LARGE)
        for (int i = 0; i < n; i++)
            p[i] = z[i] - beta * p[i];
        problem->multiply(problem->context, p, ap);
        curvature = sum_of_products(p, ap, n);
        if (!(curvature > 0)) break;
        const double alpha = sum_of_products(p, residual, n) / curvature;
#pragma omp parallel for schedule(static) if (n > LARGE)
        for (int i = 0; i < n; i++) {
            x[i] += alpha * p[i];
            residual[i] -= alpha * ap[i];
        }
        iteration++;
    }
    return iteration;
}

int conjugate_gradients(const struct linear_problem *problem, double *residual,
                        double *x, double tolerance, int most)
{
    for (int i = 0; i < problem->n; i++)
        problem->work[1][i] = problem->work[2][i] = 0;
    return resume_conjugate_gradients(problem, residual, x, tolerance, most);
}
