// SPDX-License-Identifier: GPL-3.0-or-later
// All potentials of the gas, by conjugate gradients from those of before:
//     sum_j conductance_ij (x_i - x_j) = residual_i,  phi_i += max(-phi_i / 2, x_i),
// until what is on its way is a small part of what may be. The approximate factor of
// the preconditioner knows the sites that were in the gas when it was made. It is kept
// while it serves. Levels are compensated numbers: beside a narrow place on the way
// they are nearly alike, and a residual keeps its digits.
#include "kept_vapour.h"

#include "gas_preconditioner.h"

#include "basics/memory.h"
#include "sparse/conjugate_gradients.h"

#include <math.h>
#include <stdlib.h>

// Of STEP, what a solution may leave.
static const double ENOUGH = 0.3;
// To make a factor takes as long as so many iterations.
enum { ITERATIONS_OF_FACTOR = 30, MOST_CORRECTIONS = 30, MOST_ITERATIONS = 500 };

// Where no factor knows the rows: puts them in the order of sites.
static void sort_rows(struct kept_vapour *kept)
{
    kept->n_row = 0;
    for (int k = 0; k < kept->links.n; k++) {
        const int site = kept->order[k];
        if (kept->row[site] < 0) continue;
        kept->row[site] = kept->n_row;
        kept->row_site[kept->n_row++] = site;
    }
}

// In the order of rows; what is not in the gas is column n. Both directions of a link
// are there, in the order of the links.
static struct conductance_matrix matrix_of_gas(const struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    const int n = kept->n_row;
    int room = 0;
    for (int r = 0; r < n; r++)
        room += links->offset[kept->row_site[r] + 1] - links->offset[kept->row_site[r]];
    struct conductance_matrix matrix = {.n = n,
                                        .n_all = n + 1,
                                        .offset = NEW_ARRAY(int, n + 2),
                                        .column = NEW_ARRAY(int, room),
                                        .value = NEW_ARRAY(double, room),
                                        .diagonal = NEW_ARRAY(double, n)};
    int m = 0;
    for (int r = 0; r < n; r++) {
        const int site = kept->row_site[r];
        matrix.diagonal[r] = links->diagonal[site];
        for (int k = links->offset[site]; k < links->offset[site + 1]; k++) {
            if (!(links->value[k] > 0)) continue;
            const int other = links->column[k];
            matrix.column[m] = is_in_gas(kept, other) ? kept->row[other] : n;
            matrix.value[m++] = links->value[k];
        }
        matrix.offset[r + 1] = m;
    }
    matrix.offset[n + 1] = m;
    return matrix;
}

static void multiply(void *context, const double *x, double *image)
{
    const struct gas_preconditioner *gas = context;
    conductance_matrix_multiply(gas->matrix, x, image);
}

static void precondition(void *context, const double *residual, double *z)
{
    gas_preconditioner_apply(context, residual, z);
}

static struct compensated level_of(const struct kept_vapour *kept, int site)
{
    return site < kept->links.n ? kept->level[site] : (struct compensated){1, 0};
}

void kept_vapour_find_flows(struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    air_links_clear(&kept->air);
    kept->on_its_way = kept->below_zero = 0;
    for (int i = 0; i < links->n; i++) {
        double flow = 0;
        for (int k = links->offset[i]; k < links->offset[i + 1]; k++)
            if (links->value[k] > 0)
                flow += links->value[k] *
                        compensated_difference(level_of(kept, links->column[k]),
                                               kept->level[i]);
        if (!is_in_gas(kept, i)) {
            if (flow > 0) air_links_link(&kept->air, i, flow);
            continue;
        }
        kept->residual[i] = flow;
        kept->on_its_way += flow;
        kept->below_zero -= fmin(0, flow);
    }
}

// Whether a way leads from the gas to a wet site.
static bool leads_to_wet(const struct kept_vapour *kept)
{
    const struct conductance_matrix *links = &kept->links;
    for (int r = 0; r < kept->n_row; r++) {
        const int site = kept->row_site[r];
        for (int k = links->offset[site]; k < links->offset[site + 1]; k++)
            if (links->value[k] > 0 && links->column[k] < links->n &&
                !is_in_gas(kept, links->column[k]))
                return true;
    }
    return false;
}

// Reduces the residuals to REDUCTION of their size, or as far as this goes. A level
// above 0 stays so: wet sites beside it would evaporate 0 and lose their shares
// (evaporation_shares.h), and get none when they evaporate again.
static int correct(struct kept_vapour *kept, struct gas_preconditioner *gas,
                   double reduction)
{
    const int n = kept->n_row;
    double *b = NEW_ARRAY(double, n), *x = NEW_ARRAY(double, n);
    struct linear_problem linear = {n, gas, multiply, precondition, {0}};
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

static void follow_with_factor(struct kept_vapour *kept,
                               const struct conductance_matrix *matrix)
{
    if (kept->factor) return;
    kept->factor = approximate_cholesky_create(matrix);
    kept->n_factor = matrix->n;
    kept->factor_solutions = 0;
    kept->factor_iterations = ITERATIONS_OF_FACTOR;
}

// A factor serves until a solution takes longer than they have taken on average with
// it, the time to make it included.
static void judge_factor(struct kept_vapour *kept, int iterations)
{
    kept->factor_solutions++;
    kept->factor_iterations += iterations;
    if (iterations * kept->factor_solutions <= kept->factor_iterations) return;
    approximate_cholesky_free(kept->factor);
    kept->factor = NULL;
}

void kept_vapour_solve(struct kept_vapour *kept)
{
    const double before = compensated_value(kept->air.all), waiting = kept->on_its_way;
    if (!kept->factor) sort_rows(kept);
    struct conductance_matrix matrix = matrix_of_gas(kept);
    follow_with_factor(kept, &matrix);
    struct gas_preconditioner gas =
        gas_preconditioner_of(&matrix, kept->factor, kept->n_factor);
    int iterations = 0, corrections = 0;
    for (; corrections < MOST_CORRECTIONS; corrections++) {
        const double error = kept_vapour_error(kept);
        const double evaporation = compensated_value(kept->air.all);
        const double enough = ENOUGH * kept->step * evaporation;
        if (!(error > enough)) break;
        if (evaporation == 0 && corrections > 0 && !leads_to_wet(kept)) break;
        iterations += correct(kept, &gas, fmax(1e-3, fmin(0.5, 0.5 * enough / error)));
        kept_vapour_find_flows(kept);
    }
    kept->failed |= corrections == MOST_CORRECTIONS;
    gas_preconditioner_free(&gas);
    conductance_matrix_free(&matrix);
    judge_factor(kept, iterations);
    if (before > 0 && waiting > 0)
        kept->reaches_wet =
            fmax(0, fmin(1, (compensated_value(kept->air.all) - before) / waiting));
}
