// SPDX-License-Identifier: GPL-3.0-or-later
// Corrections of pressures so that balances close, by iterative refinement: with
// residual r = balances of x (in compensated numbers), solve A c = r, then x += c, and
// find r again. Conjugate gradients reduce r by
// `reduction` in each. The right side is scaled to norm 1, as the preconditioner holds
// floats.
#include "linear_solver.h"

#include "basics/memory.h"
#include "sparse/conjugate_gradients.h"

#include <math.h>
#include <stdlib.h>

// Up to this number of unknowns the Cholesky factor is faster (make bench-flow).
enum { DIRECT_MOST = 1500 };

enum { MOST_ITERATIONS = 500 };

static void multiply(void *context, const double *x, double *image)
{
    conductance_matrix_multiply(((const struct linear_solver *)context)->matrix, x,
                                image);
}

static void precondition(void *context, const double *residual, double *z)
{
    approximate_cholesky_apply(((const struct linear_solver *)context)->factor,
                               residual, z);
}

enum status linear_solver_init(const struct conductance_matrix *matrix,
                               enum solver solver, struct linear_solver *linear,
                               struct reason *reason)
{
    *linear = (struct linear_solver){.matrix = matrix,
                                     .correction = NEW_ARRAY(double, matrix->n)};
    if (solver == SOLVER_CHOLESKY ||
        (solver == SOLVER_AUTO && matrix->n <= DIRECT_MOST))
        return cholesky_create(matrix, &linear->cholesky, reason);
    linear->factor = approximate_cholesky_create(matrix);
    linear->residual = NEW_ARRAY(double, matrix->n);
    for (int k = 0; k < 3; k++)
        linear->work[k] = NEW_ARRAY(double, matrix->n);
    return STATUS_OK;
}

void linear_solver_free(struct linear_solver *linear)
{
    approximate_cholesky_free(linear->factor);
    cholesky_free(linear->cholesky);
    free(linear->correction);
    free(linear->residual);
    for (int k = 0; k < 3; k++)
        free(linear->work[k]);
    *linear = (struct linear_solver){0};
}

// Solves for B, scaled to norm 1, as the preconditioner holds floats.
static int iterate(struct linear_solver *linear, const double *b, double *x,
                   double reduction)
{
    const int n = linear->matrix->n;
    const double size = sqrt(sum_of_products(b, b, n));
    const struct linear_problem problem = {
        n,
        linear,
        multiply,
        precondition,
        {linear->work[0], linear->work[1], linear->work[2]}};
    for (int i = 0; i < n; i++)
        linear->residual[i] = size > 0 ? b[i] / size : 0;
    const int iterations = resume_conjugate_gradients(&problem, linear->residual, x,
                                                      reduction, MOST_ITERATIONS);
    for (int i = 0; i < n; i++)
        x[i] *= size;
    return iterations;
}

enum status linear_correct(struct linear_solver *linear, const double *given,
                           struct compensated *x, double *residual, double reduction,
                           int *iterations, struct reason *reason)
{
    const int n = linear->matrix->n;
    if (linear->factor)
        *iterations += iterate(linear, residual, linear->correction, reduction);
    else if (!cholesky_solve(linear->cholesky, residual, linear->correction))
        return refuse(reason, STATUS_INTERNAL,
                      "out of memory in the balances of %d pores", n);
    for (int i = 0; i < n; i++)
        compensated_add(&x[i], linear->correction[i]);
    conductance_matrix_residual(linear->matrix, given, x, residual);
    return STATUS_OK;
}
