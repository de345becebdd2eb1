// SPDX-License-Identifier: GPL-3.0-or-later
// Policy iteration (Howard 1960; for M-matrices Bokanowski, Maroso and Zidani 2009):
//     levels of the sites that are not held, by their balances;
//     hold those that fell below the least, free those held whose surplus is below 0;
//     until none changes.
// The first rounds begin with some sweeps of projected Gauss-Seidel, which find at once
// what is held near a site that changes: half as many rounds are left. From the second
// of the others on no level falls, because the matrix is an M-matrix. So no set of held
// sites comes back, and the rounds are finitely many. A part of the network
// never loses its last held site: what they supply is what is taken there, 0 or more,
// so not all surpluses are below 0.
//
// The balances of the sites that are not held are one linear system a round, which
// sparse/linear_solver.h solves from the levels of before, until the true residual,
// from differences of compensated levels, is small enough.
#include "film_flow.h"

#include "basics/memory.h"
#include "film_balance.h"

#include <math.h>
#include <stdlib.h>

// Which sites are held is found to so many tolerances first.
static const double COARSE = 1e4;

// Sweeps of projected Gauss-Seidel before each of the first rounds.
enum { SWEEPS = 3, RELAXED = 5 };
// They round levels. No level above its least by less than this part frees a site: it
// may be the last one held in its part of the network, which rounding must not free.
static const double ROUNDING = 1e-12;

enum { MOST_ROUNDS = 1000 };

// Holds and frees sites; returns how many.
static int change_held(struct film_flow *flow, double tolerance, const double *residual)
{
    int changed = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        const struct compensated least = {.value = flow->least[i]};
        const double above = compensated_difference(flow->level[i], least);
        const bool hold = flow->held[i] ? !(residual[i] > tolerance) : above < 0;
        changed += hold != flow->held[i];
        flow->held[i] = hold;
        if (hold) flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    return changed;
}

// The level of site I that balances it with those around it, or its least.
static double balanced_level(const struct film_flow *flow, const double *level, int i)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double sum = -flow->taken[i];
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
        sum += matrix->value[k] * level[matrix->column[k]];
    return fmax(flow->least[i], sum / matrix->diagonal[i]);
}

// Projected Gauss-Seidel, forwards and back: what changes near a site that has been
// held or freed changes at once. Only where they MAY_HOLD sites: sweeps from a poor
// guess hold too many, and policy iteration frees them one after another.
static void relax(struct film_flow *flow, bool may_hold)
{
    const int n = flow->matrix->n;
    double *level = NEW_ARRAY(double, n);
    double most = 0; // no level is above it
    for (int i = 0; i < n; i++)
        most = fmax(most, flow->least[i]);
    for (int i = 0; i < n; i++)
        level[i] = fmin(most, compensated_value(flow->level[i]));
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < n; i++)
            level[i] = balanced_level(flow, level, i);
        for (int i = n - 1; i >= 0; i--)
            level[i] = balanced_level(flow, level, i);
    }
    for (int i = 0; i < n; i++) {
        const bool low = !(level[i] > (1 + ROUNDING) * flow->least[i]);
        flow->held[i] = low && (may_hold || flow->held[i]);
        flow->level[i].value = flow->held[i] ? flow->least[i] : level[i];
        flow->level[i].lost = 0;
    }
    free(level);
}

bool film_flow_solve(struct film_flow *flow, double tolerance)
{
    const int n = flow->matrix->n;
    double *residual = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        if (flow->held[i])
            flow->level[i] = (struct compensated){.value = flow->least[i]};
    bool found = false;
    double coarse = COARSE * tolerance;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        flow->rounds++;
        if (round < RELAXED && coarse > tolerance) relax(flow, round > 0);
        if (!film_balance(flow, coarse, residual)) break;
        if (change_held(flow, coarse, residual) > 0) continue;
        found = !(coarse > tolerance);
        if (found) break;
        coarse = tolerance;
    }
    for (int i = 0; i < n; i++)
        flow->surplus[i] = flow->held[i] ? fmax(0, -residual[i]) : 0;
    free(residual);
    return found;
}
