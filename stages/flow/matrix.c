// SPDX-License-Identifier: GPL-3.0-or-later
#include "matrix.h"

#include "basics/memory.h"

#include <stdlib.h>

enum { BLOCK = 4096 };

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

double dot_product(const double *x, const double *y, int n)
{
    const int blocks = (n + BLOCK - 1) / BLOCK;
    double *part = NEW_ARRAY(double, blocks);
#pragma omp parallel for schedule(static) if (n > 20000)
    for (int b = 0; b < blocks; b++) {
        const int end = (b + 1) * BLOCK < n ? (b + 1) * BLOCK : n;
        double sum = 0;
        for (int i = b * BLOCK; i < end; i++)
            sum += x[i] * y[i];
        part[b] = sum;
    }
    double sum = 0;
    for (int b = 0; b < blocks; b++)
        sum += part[b];
    free(part);
    return sum;
}
