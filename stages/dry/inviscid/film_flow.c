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
#include "sparse/linear_solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Which sites are held is found to so many tolerances first.
static const double COARSE = 1e5;

// Each correction reduces the residual so far.
static const double REDUCTION = 1e-4;

enum { MOST_ROUNDS = 1000, MOST_CORRECTIONS = 30 };

// The sites in another order: first those that are not held, N of them.
struct free_sites {
    int n;
    int *site, *order; // (all) the site at each place, and the place of each site
    struct conductance_matrix matrix; // (n)
    struct compensated *level;        // (all)
    double *given, *residual;         // (n)
};

static void number_free(const struct film_flow *flow, struct free_sites *sites)
{
    const int n_all = flow->matrix->n;
    sites->n = 0;
    for (int hold = 0; hold < 2; hold++)
        for (int i = 0, n = sites->n; i < n_all; i++) {
            if (flow->held[i] != hold) continue;
            sites->order[i] = n;
            sites->site[n++] = i;
            if (!hold) sites->n = n;
        }
}

// The rows of the sites that are not held, under their numbers.
static struct free_sites free_sites_init(const struct film_flow *flow)
{
    const struct conductance_matrix *all = flow->matrix;
    const size_t n_all = (size_t)all->n;
    struct free_sites sites = {.site = NEW_ARRAY(int, n_all),
                               .order = NEW_ARRAY(int, n_all),
                               .level = NEW_ARRAY(struct compensated, n_all),
                               .given = NEW_ARRAY(double, n_all),
                               .residual = NEW_ARRAY(double, n_all)};
    number_free(flow, &sites);
    struct conductance_matrix *matrix = &sites.matrix;
    *matrix =
        (struct conductance_matrix){.n = sites.n,
                                    .n_all = all->n,
                                    .offset = NEW_ARRAY(int, n_all + 2),
                                    .column = NEW_ARRAY(int, all->offset[all->n]),
                                    .value = NEW_ARRAY(double, all->offset[all->n]),
                                    .diagonal = NEW_ARRAY(double, n_all)};
    for (int row = 0; row < all->n; row++) {
        const int i = sites.site[row];
        sites.level[row] = flow->level[i];
        if (row >= sites.n) continue;
        int to = matrix->offset[row];
        for (int k = all->offset[i]; k < all->offset[i + 1]; k++, to++) {
            matrix->column[to] = sites.order[all->column[k]];
            matrix->value[to] = all->value[k];
        }
        matrix->offset[row + 1] = to;
        matrix->diagonal[row] = all->diagonal[i];
        sites.given[row] = -flow->taken[i];
    }
    return sites;
}

static void free_sites_free(struct free_sites *sites)
{
    free(sites->site);
    free(sites->order);
    free(sites->level);
    free(sites->given);
    free(sites->residual);
    conductance_matrix_free(&sites->matrix);
}

// The sum of what does not balance, less what rounding of levels makes.
static double imbalance(const struct free_sites *sites)
{
    double sum = 0, rounding = 0;
    for (int i = 0; i < sites->n; i++) {
        sum += fabs(sites->residual[i]);
        rounding += sites->matrix.diagonal[i] * compensated_value(sites->level[i]);
    }
    return sum - 1e-15 * rounding;
}

static bool correct(struct film_flow *flow, struct free_sites *sites, double tolerance)
{
    struct linear_solver linear = {0};
    struct reason reason;
    conductance_matrix_residual(&sites->matrix, sites->given, sites->level,
                                sites->residual);
    if (!(imbalance(sites) > tolerance)) return true;
    bool found =
        linear_solver_init(&sites->matrix, SOLVER_AUTO, &linear, &reason) == STATUS_OK;
    int most = found ? MOST_CORRECTIONS : 0;
    for (found = false; most > 0 && !found; most--) {
        if (linear_correct(&linear, sites->given, sites->level, sites->residual,
                           REDUCTION, &flow->iterations, &reason))
            break;
        found = !(imbalance(sites) > tolerance);
    }
    linear_solver_free(&linear);
    return found;
}

// The levels where no site is held, and the balances of all sites: SURPLUS with its
// sign turned.
static bool balance(struct film_flow *flow, const double *given, double tolerance,
                    double *residual)
{
    struct free_sites sites = free_sites_init(flow);
    const bool found = sites.n == 0 || correct(flow, &sites, tolerance);
    for (int k = 0; k < sites.n; k++)
        flow->level[sites.site[k]] = sites.level[k];
    free_sites_free(&sites);
    conductance_matrix_residual(flow->matrix, given, flow->level, residual);
    return found;
}

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
    double *residual = NEW_ARRAY(double, n), *given = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++) {
        given[i] = -flow->taken[i];
        if (flow->held[i])
            flow->level[i] = (struct compensated){.value = flow->least[i]};
    }
    bool found = false;
    double coarse = COARSE * tolerance;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        flow->rounds++;
        if (!balance(flow, given, coarse, residual)) break;
        if (change_held(flow, coarse, residual) > 0) continue;
        found = !(coarse > tolerance);
        if (found) break;
        coarse = tolerance;
    }
    for (int i = 0; i < n; i++)
        flow->surplus[i] = flow->held[i] ? fmax(0, -residual[i]) : 0;
    free(residual);
    free(given);
    return found;
}
