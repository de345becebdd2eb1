// SPDX-License-Identifier: GPL-3.0-or-later
// All potentials of the gas, by conjugate gradients from those of before:
//     sum_j conductance_ij (x_i - x_j) = residual_i,  phi_i += max(-phi_i / 2, x_i),
// until what is on its way is a small part of what may be. The inner rows of the
// preconditioner, those whose neighbours were all in the gas, are kept while they
// serve. Levels are compensated numbers: beside a narrow place on the way they are
// nearly alike, and a residual keeps its digits.
#include "kept_vapour.h"

#include "gas_preconditioner.h"

#include "basics/memory.h"
#include "sparse/conjugate_gradients.h"

#include <math.h>
#include <stdlib.h>

// Of STEP, what a solution may leave.
static const double ENOUGH = 0.6;
// To make a factor takes as long as so many iterations.
enum { ITERATIONS_OF_FACTOR = 10, MOST_CORRECTIONS = 30, MOST_ITERATIONS = 500 };

static bool is_wet(const struct kept_vapour *kept, int site)
{
    return site < kept->links.n && !is_in_gas(kept, site);
}

// Whether an open throat leads from SITE to a wet one.
static bool leads_to_wet(const struct kept_vapour *kept, int site)
{
    const struct conductance_matrix *links = &kept->links;
    for (int k = links->offset[site]; k < links->offset[site + 1]; k++)
        if (links->value[k] > 0 && is_wet(kept, links->column[k])) return true;
    return false;
}

// Puts rows in the order of sites, inner ones first. Returns how many are inner.
static int sort_rows(struct kept_vapour *kept)
{
    const int n_row = kept->n_row;
    int *front = NEW_ARRAY(int, n_row), n_front = 0;
    kept->n_row = 0;
    for (int k = 0; k < kept->links.n; k++) {
        const int site = kept->order[k];
        if (!is_in_gas(kept, site)) continue;
        if (leads_to_wet(kept, site))
            front[n_front++] = site;
        else
            kept->row_site[kept->n_row++] = site;
    }
    const int n_inner = kept->n_row;
    for (int k = 0; k < n_front; k++)
        kept->row_site[kept->n_row++] = front[k];
    for (int r = 0; r < n_row; r++)
        kept->row[kept->row_site[r]] = r;
    free(front);
    return n_inner;
}

// The column of what is not in the gas: each has its own, above all rows.
static int column_of(const struct kept_vapour *kept, int site)
{
    return is_in_gas(kept, site) ? kept->row[site] : kept->links.n + site;
}

// SITE was not in the gas when ROW was made.
static void lead_to_row(struct kept_vapour *kept, int row, int site)
{
    struct conductance_matrix *balances = &kept->balances;
    for (int k = balances->offset[row]; k < balances->offset[row + 1]; k++)
        if (balances->column[k] == kept->links.n + site)
            balances->column[k] = kept->row[site];
}

// Adds the rows that have come since. Both directions of a link are there, in the order
// of the links.
static void add_rows(struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    struct conductance_matrix *balances = &kept->balances;
    for (int r = balances->n, m = balances->offset[r]; r < kept->n_row; r++) {
        const int site = kept->row_site[r];
        balances->diagonal[r] = links->diagonal[site];
        for (int k = links->offset[site]; k < links->offset[site + 1]; k++) {
            if (!(links->value[k] > 0)) continue;
            const int column = column_of(kept, links->column[k]);
            if (column < balances->n) lead_to_row(kept, column, site);
            balances->column[m] = column;
            balances->value[m++] = links->value[k];
        }
        balances->offset[r + 1] = m;
    }
    balances->n = kept->n_row;
}

static void multiply(void *context, const double *x, double *image)
{
    const struct kept_vapour *kept = context;
    conductance_matrix_multiply(&kept->balances, x, image);
}

static void precondition(void *context, const double *residual, double *z)
{
    const struct kept_vapour *kept = context;
    gas_preconditioner_apply(kept->preconditioner, residual, z);
}

static struct compensated level_of(const struct kept_vapour *kept, int site)
{
    return site < kept->links.n ? kept->level[site] : (struct compensated){1, 0};
}

// What wet sites evaporate straight into the air.
static void find_flows_to_air(struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    for (int l = 0; l < kept->n_beside_air; l++) {
        const int site = kept->beside_air[l];
        if (is_in_gas(kept, site)) continue;
        for (int k = links->offset[site]; k < links->offset[site + 1]; k++)
            if (links->column[k] == links->n && links->value[k] > 0)
                air_links_link(&kept->air, site, links->value[k]);
    }
}

// Residuals, and what wet sites evaporate, from the potentials.
static void find_flows(struct kept_vapour *kept)
{
    const struct conductance_matrix *balances = &kept->balances;
    const int n = kept->links.n;
    air_links_clear(&kept->air);
    find_flows_to_air(kept);
    kept->on_its_way = kept->below_zero = 0;
    for (int r = 0; r < balances->n; r++) {
        const int site = kept->row_site[r];
        double residual = 0;
        for (int k = balances->offset[r]; k < balances->offset[r + 1]; k++) {
            const int column = balances->column[k];
            const int other = column < n ? kept->row_site[column] : column - n;
            const double flow =
                balances->value[k] *
                compensated_difference(level_of(kept, other), kept->level[site]);
            residual += flow;
            if (column >= n && other < n && flow < 0)
                air_links_link(&kept->air, other, -flow);
        }
        kept->residual[site] = residual;
        kept->on_its_way += residual;
        kept->below_zero -= fmin(0, residual);
    }
}

static bool gas_leads_to_wet(const struct kept_vapour *kept)
{
    for (int r = 0; r < kept->n_row; r++)
        if (leads_to_wet(kept, kept->row_site[r])) return true;
    return false;
}

// Reduces the residuals to REDUCTION of their size, or as far as this goes. A level
// above 0 stays so: wet sites beside it would evaporate 0 and lose their shares
// (evaporation_shares.h), and get none when they evaporate again.
static int correct(struct kept_vapour *kept, double reduction)
{
    const int n = kept->n_row;
    double *b = NEW_ARRAY(double, n), *x = NEW_ARRAY(double, n);
    struct linear_problem linear = {n, kept, multiply, precondition, {0}};
    for (int k = 0; k < 3; k++)
        linear.work[k] = NEW_ARRAY(double, n);
    for (int r = 0; r < n; r++)
        b[r] = kept->residual[kept->row_site[r]];
    const double size = sqrt(sum_of_products(b, b, n));
    for (int r = 0; r < n; r++)
        b[r] /= size;
    const int iterations =
        conjugate_gradients(&linear, b, x, reduction, MOST_ITERATIONS);
    for (int r = 0; r < n; r++) {
        struct compensated *level = &kept->level[kept->row_site[r]];
        compensated_add(level, fmax(-0.5 * compensated_value(*level), x[r] * size));
    }
    for (int k = 0; k < 3; k++)
        free(linear.work[k]);
    free(b);
    free(x);
    return iterations;
}

static void eliminate_inner_rows(struct kept_vapour *kept)
{
    const int n_inner = sort_rows(kept);
    kept->balances.n = 0;
    add_rows(kept);
    find_flows(kept);
    kept->preconditioner =
        gas_preconditioner_create(&kept->balances, n_inner, kept->links.n);
    kept->solutions = 0;
    kept->cost = ITERATIONS_OF_FACTOR;
}

// Returns what the front takes, in iterations.
static double prepare(struct kept_vapour *kept)
{
    if (kept->preconditioner)
        add_rows(kept);
    else
        eliminate_inner_rows(kept);
    return ITERATIONS_OF_FACTOR *
           gas_preconditioner_follow(kept->preconditioner, &kept->balances);
}

// Inner rows serve until a solution takes longer than they have taken on average with
// them, the time to eliminate them included.
static void judge_factor(struct kept_vapour *kept, double cost)
{
    kept->solutions++;
    kept->cost += cost;
    if (cost * kept->solutions <= kept->cost) return;
    gas_preconditioner_free(kept->preconditioner);
    kept->preconditioner = NULL;
}

void kept_vapour_solve(struct kept_vapour *kept)
{
    const double before = compensated_value(kept->air.all), waiting = kept->on_its_way;
    double cost = prepare(kept);
    int corrections = 0;
    for (; corrections < MOST_CORRECTIONS; corrections++) {
        const double error = kept_vapour_error(kept);
        const double evaporation = compensated_value(kept->air.all);
        const double enough = ENOUGH * kept->step * evaporation;
        if (!(error > enough)) break;
        if (evaporation == 0 && corrections > 0 && !gas_leads_to_wet(kept)) break;
        cost += correct(kept, fmax(1e-3, fmin(0.5, 0.5 * enough / error)));
        find_flows(kept);
    }
    kept->failed |= corrections == MOST_CORRECTIONS;
    judge_factor(kept, cost);
    if (before > 0 && waiting > 0)
        kept->reaches_wet =
            fmax(0, fmin(1, (compensated_value(kept->air.all) - before) / waiting));
}
