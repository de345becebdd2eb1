// SPDX-License-Identifier: GPL-3.0-or-later
// The residual and the correction of the balances of one cluster: in node i
//     residual_i = source_i + sum_j conductance_ij (potential_j - potential_i)
//                  + sum over arms of conductance (level - potential_i),
//     (L + diag(ground)) correction = residual,
// L the graph Laplacian of the links, ground the sum of each node's arms. Potentials
// have two parts (struct compensated): across a wide throat they differ by less than
// the last digit of a double. A uniform rise of the whole cluster is taken out first
// (level_potentials), the rest is solved by conjugate gradients, preconditioned with
// the updated factor or a rough one. Rows of nodes that have left stay, multiplied by
// present = 0.
#include "cluster_laplacian.h"

#include "basics/memory.h"
#include "rough_factor.h"
#include "sparse/conjugate_gradients.h"
#include "updated_cholesky.h"

#include <math.h>
#include <stdlib.h>

// If conjugate gradients take more steps than this, the factor has become inaccurate. A
// rough one takes more from the start.
enum { MAX_STEPS = 30, MAX_ROUGH_STEPS = 300 };

// --- the rows ------------------------------------------------------------------------

static void allocate_rows(struct cluster_laplacian *graph, int n, int n_link)
{
    *graph = (struct cluster_laplacian){.n = n,
                                        .present = NEW_ARRAY(double, n),
                                        .offset = NEW_ARRAY(int, n + 2),
                                        .column = NEW_ARRAY(int, 2 * n_link),
                                        .mirror = NEW_ARRAY(int, 2 * n_link),
                                        .conductance = NEW_ARRAY(double, 2 * n_link),
                                        .ground = NEW_ARRAY(double, n),
                                        .potential = NEW_ARRAY(struct compensated, n),
                                        .source = NEW_ARRAY(double, n),
                                        .residual = NEW_ARRAY(double, n)};
    for (int i = 0; i < n; i++)
        graph->present[i] = 1;
}

static void fill_rows(struct cluster_laplacian *graph, int n_link,
                      const struct graph_link *link, const int *row, int *entry)
{
    for (int k = 0; k < n_link; k++) {
        graph->offset[row[link[k].a] + 2]++;
        graph->offset[row[link[k].b] + 2]++;
    }
    for (int i = 0; i < graph->n; i++)
        graph->offset[i + 2] += graph->offset[i + 1];
    for (int k = 0; k < n_link; k++) {
        const int a = row[link[k].a], b = row[link[k].b];
        const int here = graph->offset[a + 1]++, there = graph->offset[b + 1]++;
        graph->column[here] = b;
        graph->column[there] = a;
        graph->mirror[here] = there;
        graph->mirror[there] = here;
        graph->conductance[here] = graph->conductance[there] = link[k].conductance;
        entry[k] = here;
    }
}

struct cluster_laplacian *cluster_laplacian_create(cholmod_common *common, int n,
                                                   int n_link,
                                                   const struct graph_link *link,
                                                   bool rough, int *row, int *entry)
{
    if (!rough && !updated_cholesky_order(common, n, n_link, link, row)) return NULL;
    for (int i = 0; rough && i < n; i++)
        row[i] = i;
    struct cluster_laplacian *graph = NEW_ARRAY(struct cluster_laplacian, 1);
    allocate_rows(graph, n, n_link);
    fill_rows(graph, n_link, link, row, entry);
    if (rough)
        graph->rough = rough_factor_create(n);
    else
        graph->factor = updated_cholesky_create(common, graph);
    return graph;
}

void cluster_laplacian_free(struct cluster_laplacian *graph)
{
    if (!graph) return;
    updated_cholesky_free(graph->factor);
    rough_factor_free(graph->rough);
    free(graph->present);
    free(graph->offset);
    free(graph->column);
    free(graph->mirror);
    free(graph->conductance);
    free(graph->ground);
    free(graph->potential);
    free(graph->source);
    free(graph->residual);
    free(graph);
}

// --- changes -------------------------------------------------------------------------

void cluster_laplacian_set(struct cluster_laplacian *graph, int entry,
                           double conductance)
{
    if (graph->conductance[entry] == conductance) return;
    graph->conductance[entry] = graph->conductance[graph->mirror[entry]] = conductance;
    if (graph->factor) updated_cholesky_note(graph->factor, entry);
}

void cluster_laplacian_leave(struct cluster_laplacian *graph, int row)
{
    graph->n_left += graph->present[row] != 0;
    graph->present[row] = 0;
}

void cluster_laplacian_cut(struct cluster_laplacian *graph, int row)
{
    cluster_laplacian_leave(graph, row);
    for (int k = graph->offset[row]; k < graph->offset[row + 1]; k++)
        cluster_laplacian_set(graph, k, 0);
}

void cluster_laplacian_set_arms(struct cluster_laplacian *graph, int n_arm,
                                const struct graph_arm *arm)
{
    for (int k = 0; k < graph->n; k++)
        graph->ground[k] = 0;
    for (int k = 0; k < n_arm; k++)
        graph->ground[arm[k].a] += arm[k].conductance;
    graph->n_arm = n_arm;
    graph->arm = arm;
}

// --- the balances --------------------------------------------------------------------

double cluster_laplacian_residual(struct cluster_laplacian *graph)
{
    const struct compensated *potential = graph->potential;
    double *residual = graph->residual;
    for (int i = 0; i < graph->n; i++) {
        double sum = 0;
        for (int k = graph->offset[i]; k < graph->offset[i + 1]; k++)
            sum += graph->conductance[k] *
                   compensated_difference(potential[graph->column[k]], potential[i]);
        residual[i] = graph->present[i] != 0 ? graph->source[i] + sum : 0;
    }
    for (int k = 0; k < graph->n_arm; k++) {
        const struct graph_arm *arm = &graph->arm[k];
        const struct compensated level = {.value = arm->level};
        residual[arm->a] +=
            arm->conductance * compensated_difference(level, potential[arm->a]);
    }
    double largest = 0, sum = 0;
    for (int i = 0; i < graph->n; i++) {
        if (fabs(residual[i]) > largest) largest = fabs(residual[i]);
        sum += residual[i];
    }
    return isfinite(sum) ? largest : INFINITY;
}

static void multiply(void *context, const double *x, double *product)
{
    const struct cluster_laplacian *graph = context;
    for (int i = 0; i < graph->n; i++) {
        double sum = graph->ground[i] * x[i];
        for (int k = graph->offset[i]; k < graph->offset[i + 1]; k++)
            sum += graph->conductance[k] * (x[i] - x[graph->column[k]]);
        product[i] = sum;
    }
}

static void precondition(void *context, const double *residual, double *z)
{
    const struct cluster_laplacian *graph = context;
    if (graph->rough)
        rough_factor_apply(graph->rough, residual, z);
    else
        updated_cholesky_solve(graph->factor, residual, z);
    for (int i = 0; i < graph->n; i++)
        z[i] *= graph->present[i];
}

// Raises all potentials alike until the residuals add up to nothing. A cluster mostly
// rises or falls nearly as one, and the rest is then found with more digits.
static void level_potentials(struct cluster_laplacian *graph)
{
    double residual = 0, ground = 0;
    for (int i = 0; i < graph->n; i++) {
        residual += graph->residual[i];
        ground += graph->present[i] * graph->ground[i];
    }
    if (!(ground > 0)) return;
    const double rise = residual / ground;
    for (int i = 0; i < graph->n; i++) {
        compensated_add(&graph->potential[i], rise);
        graph->residual[i] -= graph->present[i] * graph->ground[i] * rise;
    }
}

static bool follow(struct cluster_laplacian *graph)
{
    if (graph->factor) return updated_cholesky_follow(graph->factor, graph);
    rough_factor_follow(graph->rough, graph);
    return true;
}

// What is left, and the steps that it took from a residual of SIZE, tell whether the
// factor is still good.
static void judge_factor(struct cluster_laplacian *graph, int steps, double size,
                         double tolerance)
{
    if (graph->rough)
        rough_factor_took(graph->rough, steps, fmax(0, log10(size / tolerance)));
    else if (!(sqrt(sum_of_products(graph->residual, graph->residual, graph->n)) <=
               tolerance))
        updated_cholesky_forget(graph->factor);
}

// A rough factor holds floats: the residual is scaled for it.
static double scale_of(const struct cluster_laplacian *graph)
{
    if (graph->factor) return 1;
    const double norm =
        sqrt(sum_of_products(graph->residual, graph->residual, graph->n));
    return norm > 0 ? norm : 1;
}

bool cluster_laplacian_correct(struct cluster_laplacian *graph, double tolerance)
{
    if (!follow(graph)) return false;
    level_potentials(graph);
    double **scratch = graph->rough ? rough_factor_scratch(graph->rough)
                                    : updated_cholesky_scratch(graph->factor);
    const struct linear_problem problem = {
        graph->n, graph, multiply, precondition, {scratch[0], scratch[1], scratch[2]}};
    double *correction = scratch[3];
    const double scale = scale_of(graph);
    for (int i = 0; i < graph->n; i++)
        graph->residual[i] /= scale;
    const int steps =
        conjugate_gradients(&problem, graph->residual, correction, tolerance / scale,
                            graph->rough ? MAX_ROUGH_STEPS : MAX_STEPS);
    judge_factor(graph, steps, scale, tolerance);
    for (int i = 0; i < graph->n; i++)
        compensated_add(&graph->potential[i], scale * correction[i]);
    return true;
}
