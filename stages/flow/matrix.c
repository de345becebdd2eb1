// SPDX-License-Identifier: GPL-3.0-or-later
#include "matrix.h"

#include <stdlib.h>

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
