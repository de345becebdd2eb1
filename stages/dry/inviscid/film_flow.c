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

enum { MOST_ROUNDS = 1000 };

// Holds and frees sites; returns how many.
static int change_held(struct film_flow *flow, double tolerance, const double *residual)
{
    int changed = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        const double level = compensated_value(flow->level[i]);
        const bool hold =
            flow->held[i] ? !(residual[i] > tolerance) : level < flow->least[i];
        changed += hold != flow->held[i];
        flow->held[i] = hold;
        if (hold) flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    return changed;
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
