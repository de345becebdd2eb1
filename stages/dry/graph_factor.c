// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph_factor.h"

#include "basics/memory.h"
#include "sparse/plain_cholmod.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// More changes than this at once, or nodes left aside than this share, are factorised.
enum { MOST_CHANGES = 64 };
static const double MOST_ASIDE = 0.3;

struct named_link {
    int link, a, b;
    double conductance;
};

struct graph_factor {
    cholmod_common common;
    cholmod_factor *factor;
    cholmod_dense *right, *solution, *workspace[2]; // kept from solve to solve
    int *place;    // (n_node) row in the factor, -1: none
    int *position; // of each row, in the order of elimination
    bool *aside;   // (n_row) decoupled from the rest
    int *row_node; // (n_row)
    int n_row, n_aside;
    double *conductance; // (n_link) in the factor
    bool *present;       // (n_node) in the graph as named now
    const int *node;     // (n_named_node) the graph's nodes
    int n_named_node;
    struct named_link *named;
    int n_named, capacity;
    bool forget;
    int n_total, n_link_total;
};

struct graph_factor *graph_factor_make(int n_node, int n_link)
{
    struct graph_factor *factor = NEW_ARRAY(struct graph_factor, 1);
    factor->place = NEW_ARRAY(int, n_node);
    factor->position = NEW_ARRAY(int, n_node);
    factor->aside = NEW_ARRAY(bool, n_node);
    factor->row_node = NEW_ARRAY(int, n_node);
    factor->conductance = NEW_ARRAY(double, n_link);
    factor->present = NEW_ARRAY(bool, n_node);
    factor->forget = true;
    factor->n_total = n_node;
    factor->n_link_total = n_link;
    for (int i = 0; i < n_node; i++)
        factor->place[i] = -1;
    plain_cholmod_start(&factor->common);
    return factor;
}

static void free_dense(struct graph_factor *factor)
{
    cholmod_free_dense(&factor->right, &factor->common);
    cholmod_free_dense(&factor->solution, &factor->common);
    cholmod_free_dense(&factor->workspace[0], &factor->common);
    cholmod_free_dense(&factor->workspace[1], &factor->common);
}

void graph_factor_free(struct graph_factor *factor)
{
    if (!factor) return;
    free_dense(factor);
    cholmod_free_factor(&factor->factor, &factor->common);
    cholmod_finish(&factor->common);
    free(factor->place);
    free(factor->position);
    free(factor->aside);
    free(factor->row_node);
    free(factor->conductance);
    free(factor->present);
    free(factor->named);
    free(factor);
}

void graph_factor_forget(struct graph_factor *factor)
{
    factor->forget = true;
}

// --- the graph as it is named
// ----------------------------------------------------------

void graph_factor_begin(struct graph_factor *factor, int n_node, const int *node)
{
    factor->n_named = 0;
    factor->n_named_node = n_node;
    factor->node = node;
    for (int k = 0; k < n_node; k++) {
        factor->present[node[k]] = true;
        factor->forget |= factor->place[node[k]] < 0;
    }
}

void graph_factor_link(struct graph_factor *factor, int link, int a, int b,
                       double conductance)
{
    if (!factor->forget && factor->conductance[link] == conductance) return;
    GROW_ARRAY(factor->named, factor->n_named, factor->capacity);
    factor->named[factor->n_named++] = (struct named_link){link, a, b, conductance};
}

// --- from scratch
// ----------------------------------------------------------------------

static void add_entry(cholmod_triplet *entries, int row, int column, double value)
{
    ((int *)entries->i)[entries->nnz] = row > column ? row : column;
    ((int *)entries->j)[entries->nnz] = row > column ? column : row;
    ((double *)entries->x)[entries->nnz] = value;
    entries->nnz++;
}

static void number_rows(struct graph_factor *factor)
{
    for (int k = 0; k < factor->n_row; k++)
        factor->place[factor->row_node[k]] = -1;
    factor->n_row = factor->n_named_node;
    factor->n_aside = 0;
    for (int k = 0; k < factor->n_row; k++) {
        factor->row_node[k] = factor->node[k];
        factor->place[factor->node[k]] = k;
        factor->aside[k] = false;
    }
    memset(factor->conductance, 0, (size_t)factor->n_link_total * sizeof(double));
}

// Lower triangle. Links that conduct nothing now keep their place in the pattern, for
// they may later.
static cholmod_sparse *assemble(struct graph_factor *factor)
{
    const size_t n = (size_t)factor->n_row;
    cholmod_triplet *entries = cholmod_allocate_triplet(
        n, n, 3 * (size_t)factor->n_named, -1, CHOLMOD_REAL, &factor->common);
    if (!entries) return NULL;
    for (int k = 0; k < factor->n_named; k++) {
        const struct named_link *link = &factor->named[k];
        const int a = factor->place[link->a];
        if (a < 0 || (link->b >= 0 && factor->place[link->b] < 0)) continue;
        factor->conductance[link->link] = link->conductance;
        add_entry(entries, a, a, link->conductance);
        if (link->b < 0) continue;
        const int b = factor->place[link->b];
        add_entry(entries, b, b, link->conductance);
        add_entry(entries, a, b, -link->conductance);
    }
    cholmod_sparse *matrix =
        cholmod_triplet_to_sparse(entries, entries->nnz, &factor->common);
    cholmod_free_triplet(&entries, &factor->common);
    return matrix;
}

static bool factorise(struct graph_factor *factor)
{
    number_rows(factor);
    free_dense(factor);
    cholmod_common *common = &factor->common;
    cholmod_free_factor(&factor->factor, common);
    cholmod_sparse *matrix = assemble(factor);
    if (matrix) factor->factor = cholmod_analyze(matrix, common);
    const bool good = factor->factor &&
                      cholmod_factorize(matrix, factor->factor, common) &&
                      common->status == CHOLMOD_OK;
    cholmod_free_sparse(&matrix, common);
    if (!good) return false;
    for (int k = 0; k < factor->n_row; k++)
        factor->position[((const int *)factor->factor->Perm)[k]] = k;
    factor->right =
        cholmod_zeros((size_t)factor->n_row, 1, CHOLMOD_REAL, &factor->common);
    factor->forget = false;
    return factor->right != NULL;
}

// --- from what it was
// ------------------------------------------------------------------

struct rank_one {
    int row[2]; // in the order of elimination, ascending; second -1: the ground
    double change;
};

// Adds or takes the N changes in CHANGE that have the sign of UP.
static bool change_rank(struct graph_factor *factor, const struct rank_one *change,
                        int n, bool up)
{
    cholmod_sparse *columns =
        cholmod_allocate_sparse((size_t)factor->n_row, (size_t)n, 2 * (size_t)n, 1, 1,
                                0, CHOLMOD_REAL, &factor->common);
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
    const bool good = n_column == 0 ||
                      (cholmod_updown(up, columns, factor->factor, &factor->common) &&
                       factor->common.status == CHOLMOD_OK);
    columns->ncol = (size_t)n;
    cholmod_free_sparse(&columns, &factor->common);
    return good;
}

// Grounds the nodes that are in the factor but not in the graph any more, so that what
// is left among them does no harm. Returns how many.
static int set_aside(struct graph_factor *factor, struct rank_one *change)
{
    int n = 0;
    for (int k = 0; k < factor->n_row && n < MOST_CHANGES; k++) {
        if (factor->aside[k] || factor->present[factor->row_node[k]]) continue;
        factor->aside[k] = true;
        change[n++] = (struct rank_one){{factor->position[k], -1}, 1};
    }
    factor->n_aside += n;
    return n;
}

static struct rank_one changed_link(struct graph_factor *factor,
                                    const struct named_link *link)
{
    const double change = link->conductance - factor->conductance[link->link];
    int a = factor->position[factor->place[link->a]];
    int b = link->b < 0 ? -1 : factor->position[factor->place[link->b]];
    if (b >= 0 && b < a) {
        const int other = a;
        a = b;
        b = other;
    }
    factor->conductance[link->link] = link->conductance;
    return (struct rank_one){{a, b}, change};
}

static bool follow(struct graph_factor *factor)
{
    struct rank_one change[2 * MOST_CHANGES];
    int n = set_aside(factor, change);
    if (n == MOST_CHANGES || factor->n_named > MOST_CHANGES ||
        factor->n_aside > MOST_ASIDE * factor->n_row)
        return false;
    for (int k = 0; k < factor->n_named; k++) {
        const struct named_link *link = &factor->named[k];
        if (factor->place[link->a] < 0 || (link->b >= 0 && factor->place[link->b] < 0))
            return false;
        change[n++] = changed_link(factor, link);
    }
    // What is added comes first: the matrix must stay positive definite.
    return change_rank(factor, change, n, true) &&
           change_rank(factor, change, n, false);
}

bool graph_factor_finish(struct graph_factor *factor)
{
    bool good = factor->forget ? factorise(factor) : follow(factor);
    if (!good) factor->forget = true;
    for (int k = 0; k < factor->n_named_node; k++)
        factor->present[factor->node[k]] = false;
    return good;
}

bool graph_factor_solve(struct graph_factor *factor, const double *right,
                        double *solution)
{
    double *b = factor->right->x;
    memset(b, 0, (size_t)factor->n_row * sizeof *b);
    for (int k = 0; k < factor->n_named_node; k++)
        b[factor->place[factor->node[k]]] = right[k];
    if (!cholmod_solve2(CHOLMOD_A, factor->factor, factor->right, NULL,
                        &factor->solution, NULL, &factor->workspace[0],
                        &factor->workspace[1], &factor->common))
        return false;
    const double *x = factor->solution->x;
    for (int k = 0; k < factor->n_named_node; k++)
        solution[k] = x[factor->place[factor->node[k]]];
    return true;
}
