// SPDX-License-Identifier: GPL-3.0-or-later
// Balances of a network of conductances in compressed rows: row i is
//     sum_k value_k (x_i - x_column(k)) = diagonal_i x_i - sum_k value_k x_column(k).
// The residual is summed from differences of compensated numbers, so it keeps its
// digits where x is nearly constant; the product is for directions of an iteration.
#include "conductance_matrix.h"

#include "basics/memory.h"

#include <stdlib.h>

struct conductance_matrix conductance_matrix_of_links(int n, int n_all, int n_link,
                                                      const struct link *link)
{
    struct conductance_matrix matrix = {.n = n,
                                        .n_all = n_all,
                                        .offset = NEW_ARRAY(int, n_all + 2),
                                        .diagonal = NEW_ARRAY(double, n)};
    for (int l = 0; l < n_link; l++)
        for (int end = 0; end < 2; end++)
            matrix.offset[link[l].site[end] + 2]++;
    for (int i = 0; i < n_all; i++)
        matrix.offset[i + 2] += matrix.offset[i + 1];
    matrix.column = NEW_ARRAY(int, matrix.offset[n + 1]);
    matrix.value = NEW_ARRAY(double, matrix.offset[n + 1]);
    for (int l = 0; l < n_link; l++)
        for (int end = 0; end < 2; end++) {
            const int row = link[l].site[end];
            if (row >= n) continue;
            const int k = matrix.offset[row + 1]++;
            matrix.column[k] = link[l].site[1 - end];
            matrix.value[k] = link[l].conductance;
            matrix.diagonal[row] += link[l].conductance;
        }
    return matrix;
}

void conductance_matrix_free(struct conductance_matrix *matrix)
{
    free(matrix->offset);
    free(matrix->column);
    free(matrix->value);
    free(matrix->diagonal);
    *matrix = (struct conductance_matrix){0};
}

void conductance_matrix_multiply(const struct conductance_matrix *matrix,
                                 const double *x, double *result)
{
    const int n = matrix->n;
#pragma omp parallel for schedule(static) if (n > 20000)
    for (int i = 0; i < n; i++) {
        double sum = matrix->diagonal[i] * x[i];
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            if (matrix->column[k] < n) sum -= matrix->value[k] * x[matrix->column[k]];
        result[i] = sum;
    }
}

void conductance_matrix_residual(const struct conductance_matrix *matrix,
                                 const double *given, const struct compensated *x,
                                 double *residual)
{
#pragma omp parallel for schedule(static) if (matrix->n > 20000)
    for (int i = 0; i < matrix->n; i++) {
        double sum = given ? given[i] : 0;
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            sum +=
                matrix->value[k] * compensated_difference(x[matrix->column[k]], x[i]);
        residual[i] = sum;
    }
}
