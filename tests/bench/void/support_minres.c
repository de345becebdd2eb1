// SPDX-License-Identifier: GPL-3.0-or-later
// Minimal residuals [Paige & Saunders 1975], preconditioned as in Elman, Silvester &
// Wathen, algorithm 4.1: v and z = M^-1 v are Lanczos vectors with
//     gamma' v' = A z - delta v - gamma v_last,    delta = z.A z,
// Givens rotations (c, s) make the tridiagonal matrix triangular, w = z over it, and
//     x += c eta w,    |eta| the residual that is left.
#include "support_minres.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// RESULT = (Z - A LAST - B NOW) / C, and the old LAST becomes free for the next.
static void combine(int n, double *last, const double *now, const double *z, double a,
                    double b, double c)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++)
        last[i] = (z[i] - a * last[i] - b * now[i]) / c;
}

static void swap(double **a, double **b)
{
    double *keep = *a;
    *a = *b;
    *b = keep;
}

static void add_multiple(int n, double factor, const double *w, double *x)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++)
        x[i] += factor * w[i];
}

// The Lanczos vectors and directions, and the last two rotations.
struct lanczos {
    double *v_last, *v, *z_last, *z, *az, *w_last, *w;
    double gamma_last, gamma, eta, c_last, c, s_last, s;
};

static void step(const struct linear_problem *problem, struct lanczos *at, double *x)
{
    const int n = problem->n;
    add_multiple(n, 1 / at->gamma - 1, at->z, at->z);
    problem->multiply(problem->context, at->z, at->az);
    const double delta = sum_of_products(at->az, at->z, n);
    combine(n, at->v_last, at->v, at->az, at->gamma / at->gamma_last, delta / at->gamma,
            1);
    swap(&at->v_last, &at->v);
    problem->precondition(problem->context, at->v, at->z_last);
    swap(&at->z_last, &at->z);
    const double gamma = sqrt(fmax(0, sum_of_products(at->z, at->v, n)));
    const double a0 = at->c * delta - at->c_last * at->s * at->gamma;
    const double a1 = hypot(a0, gamma);
    const double a2 = at->s * delta + at->c_last * at->c * at->gamma;
    const double a3 = at->s_last * at->gamma;
    combine(n, at->w_last, at->w, at->z_last, a3, a2, a1);
    swap(&at->w_last, &at->w);
    at->c_last = at->c;
    at->s_last = at->s;
    at->c = a0 / a1;
    at->s = gamma / a1;
    add_multiple(n, at->c * at->eta, at->w, x);
    at->eta *= -at->s;
    at->gamma_last = at->gamma;
    at->gamma = gamma;
}

int minimal_residuals(const struct linear_problem *problem, const double *right,
                      double *x, double tolerance, int most, double *left)
{
    const int n = problem->n;
    struct lanczos at = {.gamma_last = 1, .c_last = 1, .c = 1};
    double **vector[] = {&at.v_last, &at.v,      &at.z_last, &at.z,
                         &at.az,     &at.w_last, &at.w};
    for (int k = 0; k < 7; k++)
        *vector[k] = NEW_ARRAY(double, n);
    add_multiple(n, 1, right, at.v);
    problem->precondition(problem->context, at.v, at.z);
    at.gamma = at.eta = sqrt(sum_of_products(at.z, at.v, n));
    const double first = at.eta;
    int iteration = 0;
    while (iteration < most && fabs(at.eta) > tolerance * first && at.gamma > 0) {
        step(problem, &at, x);
        iteration++;
    }
    *left = fabs(at.eta) / first;
    for (int k = 0; k < 7; k++)
        free(*vector[k]);
    return iteration;
}
