// SPDX-License-Identifier: GPL-3.0-or-later
// Policy iteration (Howard 1960; for M-matrices Bokanowski, Maroso and Zidani 2009):
//     levels of the sites that are not held, by their balances;
//     hold those that fell below the least, free those held whose surplus is below 0;
//     until none changes.
// From the second round on no level falls, because the matrix is an M-matrix. So no set
// of held sites comes back, and the rounds are finitely many. A part of the network
// never loses its last held site: what they supply is what is taken there, 0 or more,
// so not all surpluses are below 0.
//
// The balances are solved by conjugate gradients from the levels of before, which the
// events between have hardly changed, preconditioned by a symmetric Gauss-Seidel sweep,
// and corrected until the true residual, from differences of compensated levels, is
// small enough.
#include "film_flow.h"

#include "basics/memory.h"
#include "sparse/conjugate_gradients.h"

#include <math.h>
#include <stdlib.h>

// Which sites are held is found to so many tolerances first.
static const double COARSE = 1e5;

enum { MOST_ROUNDS = 1000, MOST_CORRECTIONS = 30, MOST_ITERATIONS = 400 };

// Conjugate gradients on the sites that are not held: all arrays are 0 at the others.
static void multiply_free(void *context, const double *x, double *ap)
{
    const struct film_flow *flow = context;
    conductance_matrix_multiply(flow->matrix, x, ap);
    for (int i = 0; i < flow->matrix->n; i++)
        if (flow->held[i]) ap[i] = 0;
}

// Z = (D + U)^-1 D (D + L)^-1 RESIDUAL.
static void sweep(void *context, const double *residual, double *z)
{
    const struct film_flow *flow = context;
    const struct conductance_matrix *matrix = flow->matrix;
    for (int i = 0; i < matrix->n; i++) {
        double sum = residual[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] < i) sum += matrix->value[k] * z[matrix->column[k]];
        z[i] = flow->held[i] ? 0 : sum / matrix->diagonal[i];
    }
    for (int i = matrix->n - 1; i >= 0; i--) {
        double sum = 0;
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] > i) sum += matrix->value[k] * z[matrix->column[k]];
        if (!flow->held[i]) z[i] += sum / matrix->diagonal[i];
    }
}

// The balances as they are: SURPLUS with its sign turned, at all sites. Returns the sum
// of its sizes where no site is held, less what rounding of levels makes.
static double find_residual(const struct film_flow *flow, const double *given,
                            double *residual)
{
    const int n = flow->matrix->n;
    double sum = 0, rounding = 0;
    conductance_matrix_residual(flow->matrix, given, flow->level, residual);
    for (int i = 0; i < n; i++) {
        if (flow->held[i]) continue;
        sum += fabs(residual[i]);
        rounding += flow->matrix->diagonal[i] * compensated_value(flow->level[i]);
    }
    return sum - 1e-15 * rounding;
}

// The levels where no site is held. RESIDUAL is left as find_residual finds it.
static bool balance(struct film_flow *flow, const double *given, double tolerance,
                    double *residual, double *work[5])
{
    const int n = flow->matrix->n;
    const struct linear_problem problem = {
        n, flow, multiply_free, sweep, {work[0], work[1], work[2]}};
    for (int k = 0; k < MOST_CORRECTIONS; k++) {
        if (!(find_residual(flow, given, residual) > tolerance)) return true;
        double *right = work[3], *x = work[4];
        for (int i = 0; i < n; i++)
            right[i] = flow->held[i] ? 0 : residual[i];
        flow->iterations += conjugate_gradients(
            &problem, right, x, tolerance / (2 * sqrt(n)), MOST_ITERATIONS);
        for (int i = 0; i < n; i++)
            if (!flow->held[i]) compensated_add(&flow->level[i], x[i]);
    }
    return false;
}

// Holds and frees sites; returns how many.
static int change_held(struct film_flow *flow, double tolerance, const double *residual)
{
    int changed = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        const double level = compensated_value(flow->level[i]);
        const bool hold = flow->held[i] ? !(residual[i] > tolerance)
                                        : level < flow->least[i];
        changed += hold != flow->held[i];
        flow->held[i] = hold;
        if (hold) flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    return changed;
}

bool film_flow_solve(struct film_flow *flow, double tolerance)
{
    const int n = flow->matrix->n;
    double *room = NEW_ARRAY(double, 7 * (size_t)n), *work[5];
    double *residual = room + 5 * n, *given = room + 6 * n;
    for (int k = 0; k < 5; k++)
        work[k] = room + k * n;
    for (int i = 0; i < n; i++) {
        given[i] = -flow->taken[i];
        if (flow->held[i]) flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    bool found = false;
    double coarse = COARSE * tolerance;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        flow->rounds++;
        if (!balance(flow, given, coarse, residual, work)) break;
        if (change_held(flow, coarse, residual) > 0) continue;
        found = !(coarse > tolerance);
        if (found) break;
        coarse = tolerance;
    }
    for (int i = 0; i < n; i++)
        flow->surplus[i] = flow->held[i] ? fmax(0, -residual[i]) : 0;
    free(room);
    return found;
}
