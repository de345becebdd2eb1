// SPDX-License-Identifier: GPL-3.0-or-later
#include "cholesky.h"

#include "basics/memory.h"
#include "sparse/plain_cholmod.h"

#include <stdlib.h>
#include <string.h>

struct cholesky {
    cholmod_common common;
    cholmod_factor *factor;
};

// Lower triangle by columns: of a symmetric matrix, the upper one by rows.
static cholmod_sparse *lower_triangle(const struct matrix *matrix,
                                      cholmod_common *common)
{
    const size_t n = (size_t)matrix->n;
    size_t n_entry = n;
    for (int i = 0; i < matrix->n; i++)
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            n_entry += matrix->column[k] > i && matrix->column[k] < matrix->n;
    cholmod_triplet *entries =
        cholmod_allocate_triplet(n, n, n_entry, -1, CHOLMOD_REAL, common);
    if (!entries) return NULL;
    int *row = entries->i, *column = entries->j;
    double *value = entries->x;
    size_t count = 0;
    for (int i = 0; i < matrix->n; i++) {
        row[count] = column[count] = i;
        value[count++] = matrix->diagonal[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
            if (matrix->column[k] <= i || matrix->column[k] >= matrix->n) continue;
            row[count] = matrix->column[k];
            column[count] = i;
            value[count++] = -matrix->value[k];
        }
    }
    entries->nnz = count;
    cholmod_sparse *lower = cholmod_triplet_to_sparse(entries, count, common);
    cholmod_free_triplet(&entries, common);
    return lower;
}

enum status cholesky_make(const struct matrix *matrix, struct cholesky **made,
                          struct reason *reason)
{
    struct cholesky *cholesky = *made = NEW_ARRAY(struct cholesky, 1);
    cholmod_common *common = &cholesky->common;
    plain_cholmod_start(common);
    cholmod_sparse *lower = lower_triangle(matrix, common);
    if (lower) cholesky->factor = cholmod_analyze(lower, common);
    if (cholesky->factor) cholmod_factorize(lower, cholesky->factor, common);
    cholmod_free_sparse(&lower, common);
    if (common->status == CHOLMOD_OUT_OF_MEMORY)
        return refuse(reason, STATUS_INTERNAL,
                      "out of memory in the balances of %d pores", matrix->n);
    if (common->status != CHOLMOD_OK)
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "the balances of %d pores have no Cholesky factor (CHOLMOD status "
            "%d)",
            matrix->n, common->status);
    return STATUS_OK;
}

void cholesky_free(struct cholesky *cholesky)
{
    if (!cholesky) return;
    cholmod_free_factor(&cholesky->factor, &cholesky->common);
    cholmod_finish(&cholesky->common);
    free(cholesky);
}

bool cholesky_solve(struct cholesky *cholesky, const double *b, double *x)
{
    const size_t n = cholesky->factor->n;
    cholmod_dense right = {.nrow = n,
                           .ncol = 1,
                           .nzmax = n,
                           .d = n,
                           .x = (void *)b,
                           .xtype = CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
    cholmod_dense *answer =
        cholmod_solve(CHOLMOD_A, cholesky->factor, &right, &cholesky->common);
    if (!answer) return false;
    memcpy(x, answer->x, n * sizeof *x);
    cholmod_free_dense(&answer, &cholesky->common);
    return true;
}
