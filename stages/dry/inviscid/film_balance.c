// SPDX-License-Identifier: GPL-3.0-or-later
// Small systems have a Cholesky factor (sparse/cholesky.h) of the sites that are
// not held. Larger ones are solved by conjugate gradients on all sites, in which those
// that are held stay 0. In both the true residual, from differences of compensated
// levels, decides when it is enough.
//
// The preconditioner is kept while few sites are held and freed, and from one moment of
// drying to the next, since making one costs as much as some 20 iterations. With M the
// approximate factor of the sites that were not held when it was made,
//     z = M^-1 r                at those of them that are there and not held now,
//         r / diagonal          at the others that are not held.
// Both parts are symmetric and positive definite.
#include "film_balance.h"

#include "basics/memory.h"
#include "elimination/approximate_cholesky.h"
#include "sparse/cholesky.h"
#include "sparse/conjugate_gradients.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

// Each correction reduces the residual so far at most.
static const double REDUCTION = 1e-4;
// Of the tolerance, what a correction aims at.
static const double MARGIN = 0.3;
// A new factor is made once so many sites have been held or freed since the last: each
// costs an iteration or two, and a factor as much as some 20.
enum { MOST_CHANGED = 20 };

// Sites with more links (clusters around which films are everywhere) are no part of the
// factor: eliminating them takes time that grows as the square of their links, and
// without them it costs two iterations each.
enum { MOST_LINKS = 100 };

enum { DIRECT_MOST = 1500, MOST_CORRECTIONS = 30, MOST_ITERATIONS = 500 };

struct film_factor {
    struct approximate_cholesky *approximate; // NULL: to be made
    int n;
    int *place;    // (n) of its rows, ascending
    int *site;     // (n) the site there now; -1: none
    double *b, *x; // (n)
};

struct film_factor *film_factor_create(void)
{
    return NEW_ARRAY(struct film_factor, 1);
}

static void forget(struct film_factor *factor)
{
    approximate_cholesky_free(factor->approximate);
    free(factor->place);
    free(factor->site);
    free(factor->b);
    free(factor->x);
    *factor = (struct film_factor){0};
}

void film_factor_free(struct film_factor *factor)
{
    if (!factor) return;
    forget(factor);
    free(factor);
}

// --- sites that are not held -------------------------------------------------------

// The sites in another order: first those that are not held, N of them.
struct free_sites {
    int n;
    int *site, *order; // (all) the site at each place, and the place of each site
    struct conductance_matrix matrix; // (n)
};

static bool is_hub(const struct film_flow *flow, int i, int most)
{
    return flow->matrix->offset[i + 1] - flow->matrix->offset[i] > most;
}

static void number_free(const struct film_flow *flow, struct free_sites *sites,
                        int most)
{
    const int n_all = flow->matrix->n;
    sites->n = 0;
    for (int hold = 0; hold < 2; hold++)
        for (int i = 0, n = sites->n; i < n_all; i++) {
            if ((flow->held[i] || is_hub(flow, i, most)) != hold) continue;
            sites->order[i] = n;
            sites->site[n++] = i;
            if (!hold) sites->n = n;
        }
}

// The rows of the sites that are not held, under their numbers.
static struct free_sites free_sites_init(const struct film_flow *flow, int most)
{
    const struct conductance_matrix *all = flow->matrix;
    const size_t n_all = (size_t)all->n;
    struct free_sites sites = {.site = NEW_ARRAY(int, n_all),
                               .order = NEW_ARRAY(int, n_all)};
    number_free(flow, &sites, most);
    struct conductance_matrix *matrix = &sites.matrix;
    *matrix =
        (struct conductance_matrix){.n = sites.n,
                                    .n_all = all->n,
                                    .offset = NEW_ARRAY(int, n_all + 2),
                                    .column = NEW_ARRAY(int, all->offset[all->n]),
                                    .value = NEW_ARRAY(double, all->offset[all->n]),
                                    .diagonal = NEW_ARRAY(double, n_all)};
    for (int row = 0; row < sites.n; row++) {
        const int i = sites.site[row];
        int to = matrix->offset[row];
        for (int k = all->offset[i]; k < all->offset[i + 1]; k++, to++) {
            matrix->column[to] = sites.order[all->column[k]];
            matrix->value[to] = all->value[k];
        }
        matrix->offset[row + 1] = to;
        matrix->diagonal[row] = all->diagonal[i];
    }
    return sites;
}

static void free_sites_free(struct free_sites *sites)
{
    free(sites->site);
    free(sites->order);
    conductance_matrix_free(&sites->matrix);
}

// --- the residual ------------------------------------------------------------------

// The sum of the flows to and from site I, by size.
static double flows_at(const struct film_flow *flow, int i)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double sum = 0;
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
        sum += matrix->value[k] * fabs(compensated_difference(
                                      flow->level[matrix->column[k]], flow->level[i]));
    return sum;
}

// The sum of what does not balance, less what rounding makes: of flows, which are large
// until all sites are held that must be, and of levels, which have the digits of two
// numbers. With those of one all levels would be equal where films conduct 1e9 times
// what evaporates.
static double imbalance(const struct film_flow *flow, const double *residual)
{
    double sum = 0, rounding = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        if (flow->held[i]) continue;
        const double level = compensated_value(flow->level[i]);
        sum += fabs(residual[i]);
        rounding += flows_at(flow, i) + 1e-15 * flow->matrix->diagonal[i] * level;
    }
    return sum - 1e-15 * rounding;
}

static void find_residual(const struct film_flow *flow, double *residual)
{
    conductance_matrix_residual(flow->matrix, NULL, flow->level, residual);
    for (int i = 0; i < flow->matrix->n; i++)
        residual[i] -= flow->taken[i];
}

// --- small systems -----------------------------------------------------------------

static bool solve_directly(struct film_flow *flow, double tolerance, double *residual)
{
    struct free_sites sites = free_sites_init(flow, INT_MAX);
    struct cholesky *cholesky = NULL;
    struct reason reason;
    double *b = NEW_ARRAY(double, sites.n), *x = NEW_ARRAY(double, sites.n);
    bool found = false,
         able = cholesky_create(&sites.matrix, &cholesky, &reason) == STATUS_OK;
    for (int most = MOST_CORRECTIONS; able && !found && most > 0; most--) {
        for (int k = 0; k < sites.n; k++)
            b[k] = residual[sites.site[k]];
        able = cholesky_solve(cholesky, b, x);
        for (int k = 0; able && k < sites.n; k++)
            compensated_add(&flow->level[sites.site[k]], x[k]);
        find_residual(flow, residual);
        found = !(imbalance(flow, residual) > tolerance);
    }
    cholesky_free(cholesky);
    free_sites_free(&sites);
    free(b);
    free(x);
    return found;
}

// --- large systems -----------------------------------------------------------------

static void make_factor(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    struct free_sites sites = free_sites_init(flow, MOST_LINKS);
    forget(factor);
    factor->approximate = approximate_cholesky_create(&sites.matrix);
    factor->n = sites.n;
    factor->place = NEW_ARRAY(int, sites.n);
    factor->site = NEW_ARRAY(int, sites.n);
    factor->b = NEW_ARRAY(double, sites.n);
    factor->x = NEW_ARRAY(double, sites.n);
    for (int k = 0; k < sites.n; k++)
        factor->place[k] = flow->place[sites.site[k]];
    free_sites_free(&sites);
}

// Both lists of places ascend. Returns how many sites are held that were not, or the
// other way round, or have come or gone.
static int find_sites(const struct film_flow *flow)
{
    struct film_factor *factor = flow->factor;
    int there = 0, wanted = 0;
    for (int k = 0, i = 0; k < factor->n; k++) {
        while (i < flow->matrix->n && flow->place[i] < factor->place[k])
            i++;
        factor->site[k] =
            i < flow->matrix->n && flow->place[i] == factor->place[k] ? i : -1;
        there += factor->site[k] >= 0 && !flow->held[i];
    }
    for (int i = 0; i < flow->matrix->n; i++)
        wanted += !flow->held[i] && !is_hub(flow, i, MOST_LINKS);
    return abs(factor->n - there) + abs(wanted - there);
}

static void multiply(void *context, const double *x, double *image)
{
    const struct film_flow *flow = context;
    conductance_matrix_multiply(flow->matrix, x, image);
    for (int i = 0; i < flow->matrix->n; i++)
        if (flow->held[i]) image[i] = 0;
}

static void precondition(void *context, const double *residual, double *z)
{
    const struct film_flow *flow = context;
    const struct film_factor *factor = flow->factor;
    for (int i = 0; i < flow->matrix->n; i++)
        z[i] = flow->held[i] ? 0 : residual[i] / flow->matrix->diagonal[i];
    for (int k = 0; k < factor->n; k++)
        factor->b[k] = factor->site[k] >= 0 ? residual[factor->site[k]] : 0;
    approximate_cholesky_apply(factor->approximate, factor->b, factor->x);
    for (int k = 0; k < factor->n; k++)
        if (factor->site[k] >= 0 && !flow->held[factor->site[k]])
            z[factor->site[k]] = factor->x[k];
}

static void correct(struct film_flow *flow, double reduction, const double *residual,
                    double *work)
{
    const size_t n = (size_t)flow->matrix->n;
    const struct film_factor *factor = flow->factor;
    if (!factor->approximate || find_sites(flow) > MOST_CHANGED) {
        make_factor(flow);
        find_sites(flow);
    }
    double *r = work, *x = work + n;
    for (size_t i = 0; i < n; i++)
        r[i] = flow->held[i] ? 0 : residual[i];
    const double size = sqrt(sum_of_products(r, r, (int)n));
    for (size_t i = 0; i < n; i++)
        r[i] /= size;
    const struct linear_problem problem = {(int)n,
                                           flow,
                                           multiply,
                                           precondition,
                                           {work + 2 * n, work + 3 * n, work + 4 * n}};
    flow->iterations += conjugate_gradients(&problem, r, x, reduction, MOST_ITERATIONS);
    for (size_t i = 0; i < n; i++)
        compensated_add(&flow->level[i], size * x[i]);
}

static bool solve_iteratively(struct film_flow *flow, double tolerance,
                              double *residual)
{
    double *work = NEW_ARRAY(double, 5 * (size_t)flow->matrix->n);
    double left = imbalance(flow, residual);
    for (int most = MOST_CORRECTIONS; left > tolerance && most > 0; most--) {
        correct(flow, fmax(REDUCTION, MARGIN * tolerance / left), residual, work);
        find_residual(flow, residual);
        left = imbalance(flow, residual);
    }
    free(work);
    return left <= tolerance;
}

bool film_balance(struct film_flow *flow, double tolerance, double *residual)
{
    find_residual(flow, residual);
    if (!(imbalance(flow, residual) > tolerance)) return true;
    return flow->matrix->n <= DIRECT_MOST
               ? solve_directly(flow, tolerance, residual)
               : solve_iteratively(flow, tolerance, residual);
}
