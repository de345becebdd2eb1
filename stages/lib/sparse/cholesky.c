// SPDX-License-Identifier: GPL-3.0-or-later
// Balances of a network by CHOLMOD's simplicial factor: lower triangle, AMD ordering,
// one right side at a time. The entries are A_ii = diagonal_i, A_ij = -value_k summed
// over links from i to j; then P A P^T = L D L^T, and x = P^T L^-T D^-1 L^-1 P b.
// Links to a column of n or more lead to nodes of given pressure: they are in the
// diagonal, and no entry. A is positive definite where each cluster of nodes has such a
// link; otherwise there is no factor: STATUS_NOT_CONVERGED.
#include "cholesky.h"

#include "basics/memory.h"
#include "sparse/cholmod_serial.h"

#include <stdlib.h>
#include <string.h>

struct cholesky {
    cholmod_common common;
    cholmod_factor *factor;
};

static cholmod_sparse *lower_triangle(const struct conductance_matrix *matrix,
                                      cholmod_common *common)
{
    const int n = matrix->n;
    cholmod_triplet *entries =
        new_entries(common, n, (size_t)n + (size_t)matrix->offset[n]);
    if (!entries) return NULL;
    for (int i = 0; i < n; i++) {
        add_entry(entries, i, i, matrix->diagonal[i]);
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] > i && matrix->column[k] < n)
                add_entry(entries, i, matrix->column[k], -matrix->value[k]);
    }
    return take_matrix(common, entries);
}

enum status cholesky_create(const struct conductance_matrix *matrix,
                            struct cholesky **made, struct reason *reason)
{
    struct cholesky *cholesky = *made = NEW_ARRAY(struct cholesky, 1);
    cholmod_common *common = &cholesky->common;
    cholmod_serial_start(common);
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
