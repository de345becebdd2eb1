// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of 3x3 blocks:
//     image_i = sum over columns j of block_ij x_j,
//     z_i     = (block_ii)^-1 residual_i,     (Jacobi by blocks)
// where a diagonal block is inverted by its cofactors; one that is singular to rounding
// counts as a third of its trace. Each row is summed in the order in which its columns
// were first asked for, by one thread.
#include "block_rows.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

struct block_rows block_rows_init(int n)
{
    struct block_rows rows = {.n = n};
    rows.start = NEW_ARRAY(int, n + 1);
    rows.place = NEW_ARRAY(int, n);
    rows.inverse = allocate((size_t)n, sizeof *rows.inverse);
    for (int i = 0; i < n; i++)
        rows.place[i] = -1;
    return rows;
}

void block_rows_free(struct block_rows *rows)
{
    free(rows->start);
    free(rows->column);
    free(rows->block);
    free(rows->inverse);
    free(rows->place);
}

// Room for one more block.
static void grow(struct block_rows *rows, int count)
{
    if (count < rows->capacity) return;
    rows->capacity = count + count / 2 + 64;
    rows->column =
        reallocate(rows->column, (size_t)rows->capacity, sizeof *rows->column);
    rows->block = reallocate(rows->block, (size_t)rows->capacity, sizeof *rows->block);
}

double *block_rows_at(struct block_rows *rows, int column)
{
    int *count = &rows->start[rows->filled + 1];
    const int begin = rows->start[rows->filled];
    if (*count < begin) *count = begin;
    if (rows->place[column] < begin) {
        grow(rows, *count);
        for (int k = 0; k < 9; k++)
            rows->block[*count][k] = 0;
        rows->column[*count] = column;
        rows->place[column] = (*count)++;
    }
    return rows->block[rows->place[column]];
}

static void invert(const double a[9], double inverse[9])
{
    const double cofactor[9] = {a[4] * a[8] - a[5] * a[7], a[2] * a[7] - a[1] * a[8],
                                a[1] * a[5] - a[2] * a[4], a[5] * a[6] - a[3] * a[8],
                                a[0] * a[8] - a[2] * a[6], a[2] * a[3] - a[0] * a[5],
                                a[3] * a[7] - a[4] * a[6], a[1] * a[6] - a[0] * a[7],
                                a[0] * a[4] - a[1] * a[3]};
    const double size = (a[0] + a[4] + a[8]) / 3;
    const double determinant =
        a[0] * cofactor[0] + a[1] * cofactor[3] + a[2] * cofactor[6];
    const bool is_regular = determinant > 1e-9 * size * size * size;
    for (int k = 0; k < 9; k++)
        if (is_regular)
            inverse[k] = cofactor[k] / determinant;
        else
            inverse[k] = k % 4 == 0 && size > 0 ? 1 / size : 0;
}

void block_rows_end_row(struct block_rows *rows)
{
    const int row = rows->filled++;
    const int begin = rows->start[row];
    int *end = &rows->start[row + 1];
    if (*end < begin) *end = begin;
    static const double none[9] = {0};
    const bool has_diagonal = rows->place[row] >= begin;
    invert(has_diagonal ? rows->block[rows->place[row]] : none, rows->inverse[row]);
}

static void add_product(const double block[9], const double *x, double sum[3])
{
    sum[0] += block[0] * x[0] + block[1] * x[1] + block[2] * x[2];
    sum[1] += block[3] * x[0] + block[4] * x[1] + block[5] * x[2];
    sum[2] += block[6] * x[0] + block[7] * x[1] + block[8] * x[2];
}

void block_rows_multiply(const struct block_rows *rows, const double *x, double *image)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < rows->n; i++) {
        double sum[3] = {0};
        for (int k = rows->start[i]; k < rows->start[i + 1]; k++)
            add_product(rows->block[k], x + 3 * (ptrdiff_t)rows->column[k], sum);
        for (int axis = 0; axis < 3; axis++)
            image[3 * i + axis] = sum[axis];
    }
}

void block_rows_precondition(const struct block_rows *rows, const double *residual,
                             double *z)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < rows->n; i++) {
        double sum[3] = {0};
        add_product(rows->inverse[i], residual + 3 * (ptrdiff_t)i, sum);
        for (int axis = 0; axis < 3; axis++)
            z[3 * i + axis] = sum[axis];
    }
}
