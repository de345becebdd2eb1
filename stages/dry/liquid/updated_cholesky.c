// SPDX-License-Identifier: GPL-3.0-or-later
// L D L' of the cluster's matrix, updated instead of factorised again. A link whose
// conductance grows by c changes the matrix by c (e_a - e_b)(e_a - e_b)', an arm by c
// e_a e_a': each is a column sqrt(|c|) (..) of one CHOLMOD update or downdate.
// Increases come before decreases, so that the matrix stays positive definite. The
// ordering is found once, from the pattern of all links the cluster may ever have.
// Rounding accumulates: the factor only preconditions, and is made again when
// conjugate gradients need many steps or more than MAX_CHANGES entries change at once.
#include "updated_cholesky.h"

#include "basics/memory.h"
#include "sparse/cholmod_serial.h"
#include "sparse/cholmod_solve_serial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// With more changes than this at once the matrix is factorised again.
enum { MAX_CHANGES = 300, SCRATCH_ARRAYS = 4 };

// Up to FEW_ARMS arms every change is followed; with more arms, only changes of more
// than ARM_CHANGE relative to the value in the factor.
enum { FEW_ARMS = 100 };
static const double ARM_CHANGE = 0.1;

// Each diagonal entry is raised by this part of itself: so the matrix stays positive
// definite even if no arm grounds it.
static const double GROUND = 1e-13;

struct updated_cholesky {
    cholmod_common *common;
    cholmod_factor *factor; // NULL: to be made
    int n;
    double *conductance; // (entries) in the factor, at the first of a link's two places
    double *ground;      // (n) of arms, in the factor
    int n_noted, capacity;
    int *noted; // (n_noted) entries that have changed, some twice
    double *scratch[SCRATCH_ARRAYS], *work; // (n)
};

// --- from scratch --------------------------------------------------------------------

bool updated_cholesky_order(cholmod_common *common, int n, int n_link,
                            const struct graph_link *link, int *row)
{
    cholmod_triplet *entries = new_entries(common, n, (size_t)n + (size_t)n_link);
    if (!entries) return false;
    for (int i = 0; i < n; i++)
        add_entry(entries, i, i, 1);
    for (int k = 0; k < n_link; k++)
        add_entry(entries, link[k].a, link[k].b, 1);
    cholmod_sparse *pattern = take_matrix(common, entries);
    cholmod_factor *factor = pattern ? cholmod_analyze(pattern, common) : NULL;
    for (int i = 0; factor && i < n; i++)
        row[((const int *)factor->Perm)[i]] = i;
    const bool good = factor;
    cholmod_free_factor(&factor, common);
    cholmod_free_sparse(&pattern, common);
    return good;
}

// Lower triangle. Links that conduct nothing now keep their place in the pattern, for
// they may later.
static cholmod_sparse *assemble(struct updated_cholesky *factor,
                                const struct cluster_laplacian *graph)
{
    cholmod_triplet *entries =
        new_entries(factor->common, factor->n,
                    (size_t)factor->n + (size_t)graph->offset[factor->n]);
    if (!entries) return NULL;
    for (int i = 0; i < factor->n; i++) {
        double sum = 0;
        for (int k = graph->offset[i]; k < graph->offset[i + 1]; k++) {
            sum += graph->conductance[k];
            factor->conductance[k] = graph->conductance[k];
            if (graph->column[k] > i)
                add_entry(entries, i, graph->column[k], -graph->conductance[k]);
        }
        factor->ground[i] = graph->ground[i];
        sum += graph->ground[i];
        add_entry(entries, i, i, sum > 0 ? sum * (1 + GROUND) : 1);
    }
    return take_matrix(factor->common, entries);
}

static bool factorise(struct updated_cholesky *factor,
                      const struct cluster_laplacian *graph)
{
    cholmod_common *common = factor->common;
    const int ordering = common->method[0].ordering, postorder = common->postorder;
    common->method[0].ordering = CHOLMOD_NATURAL;
    common->postorder = false;
    cholmod_free_factor(&factor->factor, common);
    cholmod_sparse *matrix = assemble(factor, graph);
    if (matrix) factor->factor = cholmod_analyze(matrix, common);
    const bool good = factor->factor &&
                      cholmod_factorize(matrix, factor->factor, common) &&
                      common->status == CHOLMOD_OK;
    cholmod_free_sparse(&matrix, common);
    if (!good) cholmod_free_factor(&factor->factor, common);
    common->method[0].ordering = ordering;
    common->postorder = postorder;
    factor->n_noted = 0;
    return good;
}

struct updated_cholesky *updated_cholesky_create(cholmod_common *common,
                                                 const struct cluster_laplacian *graph)
{
    struct updated_cholesky *factor = NEW_ARRAY(struct updated_cholesky, 1);
    *factor = (struct updated_cholesky){.common = common,
                                        .n = graph->n,
                                        .conductance =
                                            NEW_ARRAY(double, graph->offset[graph->n]),
                                        .ground = NEW_ARRAY(double, graph->n),
                                        .work = NEW_ARRAY(double, graph->n)};
    for (int k = 0; k < SCRATCH_ARRAYS; k++)
        factor->scratch[k] = NEW_ARRAY(double, graph->n);
    return factor;
}

void updated_cholesky_free(struct updated_cholesky *factor)
{
    if (!factor) return;
    cholmod_free_factor(&factor->factor, factor->common);
    free(factor->conductance);
    free(factor->ground);
    free(factor->noted);
    free(factor->work);
    for (int k = 0; k < SCRATCH_ARRAYS; k++)
        free(factor->scratch[k]);
    free(factor);
}

void updated_cholesky_forget(struct updated_cholesky *factor)
{
    cholmod_free_factor(&factor->factor, factor->common);
}

double **updated_cholesky_scratch(struct updated_cholesky *factor)
{
    return factor->scratch;
}

// --- from what it was ----------------------------------------------------------------

struct rank_one {
    int row[2]; // ascending; second -1: the ground
    double change;
};

void updated_cholesky_note(struct updated_cholesky *factor, int entry)
{
    GROW_ARRAY(factor->noted, factor->n_noted, factor->capacity);
    factor->noted[factor->n_noted++] = entry;
}

// Applies those of the N changes that are increases (UP) or decreases.
static bool change_rank(struct updated_cholesky *factor, const struct rank_one *change,
                        int n, bool up)
{
    cholmod_sparse *columns =
        cholmod_allocate_sparse((size_t)factor->n, (size_t)n, 2 * (size_t)n, 1, 1, 0,
                                CHOLMOD_REAL, factor->common);
    if (!columns) return false;
    int *begin = columns->p, *row = columns->i, n_column = 0, n_entry = 0;
    double *value = columns->x;
    for (int k = 0; k < n; k++) {
        if ((change[k].change > 0) != up) continue;
        const double root = sqrt(fabs(change[k].change));
        begin[n_column++] = n_entry;
        row[n_entry] = change[k].row[0];
        value[n_entry++] = root;
        if (change[k].row[1] < 0) continue;
        row[n_entry] = change[k].row[1];
        value[n_entry++] = -root;
    }
    begin[n_column] = n_entry;
    columns->ncol = (size_t)n_column;
    const bool good =
        n_column == 0 || (cholmod_updown(up, columns, factor->factor, factor->common) &&
                          factor->common->status == CHOLMOD_OK);
    columns->ncol = (size_t)n;
    cholmod_free_sparse(&columns, factor->common);
    return good;
}

// Lists the links that have changed. Returns their number; MAX_CHANGES + 1 if there are
// more than fit.
static int link_changes(struct updated_cholesky *factor,
                        const struct cluster_laplacian *graph, struct rank_one *change)
{
    int n = 0;
    for (int k = 0; k < factor->n_noted; k++) {
        const int here = factor->noted[k], there = graph->mirror[here];
        const double grown = graph->conductance[here] - factor->conductance[here];
        if (grown == 0) continue;
        if (n == MAX_CHANGES) return n + 1;
        const int a = graph->column[here], b = graph->column[there];
        factor->conductance[here] = factor->conductance[there] =
            graph->conductance[here];
        change[n++] = (struct rank_one){{a < b ? a : b, a < b ? b : a}, grown};
    }
    factor->n_noted = 0;
    return n;
}

static int ground_changes(struct updated_cholesky *factor,
                          const struct cluster_laplacian *graph,
                          struct rank_one *change, int n)
{
    const double least = graph->n_arm > FEW_ARMS ? ARM_CHANGE : 0;
    for (int i = 0; i < factor->n; i++) {
        const double grown = graph->ground[i] - factor->ground[i];
        if (grown == 0 || graph->present[i] == 0 ||
            (graph->ground[i] > 0 && fabs(grown) <= least * factor->ground[i]))
            continue;
        if (n == MAX_CHANGES) return n + 1;
        factor->ground[i] = graph->ground[i];
        change[n++] = (struct rank_one){{i, -1}, grown};
    }
    return n;
}

bool updated_cholesky_follow(struct updated_cholesky *factor,
                             const struct cluster_laplacian *graph)
{
    if (!factor->factor) return factorise(factor, graph);
    struct rank_one change[MAX_CHANGES];
    int n = link_changes(factor, graph, change);
    if (n <= MAX_CHANGES) n = ground_changes(factor, graph, change, n);
    if (n > MAX_CHANGES) return factorise(factor, graph);
    // What is added comes first: the matrix must stay positive definite.
    if (change_rank(factor, change, n, true) && change_rank(factor, change, n, false))
        return true;
    return factorise(factor, graph);
}

void updated_cholesky_solve(const struct updated_cholesky *factor, const double *b,
                            double *x)
{
    memcpy(x, b, (size_t)factor->n * sizeof *x);
    cholmod_solve_serial(factor->factor, x, factor->work);
}
