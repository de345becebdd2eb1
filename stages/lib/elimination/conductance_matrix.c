// SPDX-License-Identifier: GPL-3.0-or-later
#include "conductance_matrix.h"

#include "basics/memory.h"

#include <stdlib.h>

struct matrix matrix_of_links(int n, int n_all, int n_link, const struct link *link)
{
    struct matrix matrix = {.n = n,
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

void matrix_free(struct matrix *matrix)
{
    free(matrix->offset);
    free(matrix->column);
    free(matrix->value);
    free(matrix->diagonal);
    *matrix = (struct matrix){0};
}

void matrix_multiply(const struct matrix *matrix, const double *x, double *result)
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

void matrix_residual(const struct matrix *matrix, const double *given,
                     const struct compensated *x, double *residual)
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
