// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of 3x3 blocks:
//     image_i = sum over columns j of block_ij x_j,     block_ji = block_ij^T
//     z_i     = (block_ii)^-1 residual_i,               (Jacobi by blocks)
// where a diagonal block is inverted by its cofactors; one that is singular to rounding
// counts as a third of its trace. Each row is summed in the order in which its columns
// were first asked for, by one thread: so a row lists all its columns, though half of
// its blocks are kept with other rows.
#include "block_rows.h"

#include "basics/memory.h"

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

struct block_rows block_rows_init(int n, int32_t *order)
{
    struct block_rows rows = {.n = n, .order = order ? order : NEW_ARRAY(int32_t, n)};
    rows.rank = NEW_ARRAY(int32_t, n);
    rows.start = NEW_ARRAY(int, n + 1);
    rows.place = NEW_ARRAY(int, n);
    rows.inverse = allocate((size_t)n, sizeof *rows.inverse);
    for (int i = 0; i < n; i++) {
        if (!order) rows.order[i] = i;
        rows.rank[rows.order[i]] = i;
        rows.place[i] = -1;
    }
    return rows;
}

void block_rows_free(struct block_rows *rows)
{
    free(rows->order);
    free(rows->rank);
    free(rows->start);
    free(rows->column);
    free(rows->at);
    free(rows->block);
    free(rows->inverse);
    free(rows->place);
}

static int new_block(struct block_rows *rows)
{
    if (rows->n_block >= rows->block_room) {
        rows->block_room = rows->n_block + rows->n_block / 2 + 64;
        rows->block =
            reallocate(rows->block, (size_t)rows->block_room, sizeof *rows->block);
    }
    for (int k = 0; k < 9; k++)
        rows->block[rows->n_block][k] = 0;
    return rows->n_block++;
}

// Whether row I has been filled, so that it keeps the block of the row being filled.
static bool is_filled(const struct block_rows *rows, int i)
{
    return rows->rank[i] < rows->filled;
}

// The block at COLUMN of row I, which is filled.
static int find_block(const struct block_rows *rows, int i, int column)
{
    const int end = rows->start[rows->rank[i] + 1];
    int k = rows->start[rows->rank[i]];
    while (k < end && rows->column[k] != column)
        k++;
    assert(k < end);
    return rows->at[k];
}

// Lists COLUMN as the Kth of all.
static void list_column(struct block_rows *rows, int k, int column)
{
    if (k >= rows->room) {
        rows->room = k + k / 2 + 64;
        rows->column =
            reallocate(rows->column, (size_t)rows->room, sizeof *rows->column);
        rows->at = reallocate(rows->at, (size_t)rows->room, sizeof *rows->at);
    }
    rows->column[k] = column;
    rows->at[k] = is_filled(rows, column)
                      ? ~find_block(rows, column, rows->order[rows->filled])
                      : new_block(rows);
    rows->place[column] = k;
}

double *block_rows_at(struct block_rows *rows, int column)
{
    int *count = &rows->start[rows->filled + 1];
    const int begin = rows->start[rows->filled];
    if (*count < begin) *count = begin;
    if (rows->place[column] < begin) list_column(rows, (*count)++, column);
    const int at = rows->at[rows->place[column]];
    return at < 0 ? NULL : rows->block[at];
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
    static const double none[9] = {0};
    const int begin = rows->start[rows->filled], row = rows->order[rows->filled];
    int *end = &rows->start[++rows->filled];
    if (*end < begin) *end = begin;
    const bool has_diagonal = rows->place[row] >= begin;
    invert(has_diagonal ? rows->block[rows->at[rows->place[row]]] : none,
           rows->inverse[row]);
}

static void add_product(const double block[9], const double *x, double sum[3])
{
    sum[0] += block[0] * x[0] + block[1] * x[1] + block[2] * x[2];
    sum[1] += block[3] * x[0] + block[4] * x[1] + block[5] * x[2];
    sum[2] += block[6] * x[0] + block[7] * x[1] + block[8] * x[2];
}

// As add_product of the block AT, by arithmetic: a branch would be guessed wrong half
// of the time.
static void add_either(const double (*blocks)[9], int at, const double *x,
                       double sum[3])
{
    const int transposed = at >> 31; // -1: it is
    const ptrdiff_t down = 3 + 2 * transposed, along = 1 - 2 * transposed;
    const double *block = blocks[at ^ transposed];
    for (int axis = 0; axis < 3; axis++, block += down)
        sum[axis] += block[0] * x[0] + block[along] * x[1] + block[2 * along] * x[2];
}

void block_rows_multiply(const struct block_rows *rows, const double *x, double *image)
{
    enum { AHEAD = 16 };
    const int last = rows->start[rows->n] - 1;
#pragma omp parallel for schedule(static)
    for (int r = 0; r < rows->n; r++) {
        double sum[3] = {0};
        for (int k = rows->start[r]; k < rows->start[r + 1]; k++) {
            const int ahead = k + AHEAD < last ? k + AHEAD : last;
            const int at = rows->at[ahead];
            __builtin_prefetch(rows->block[at ^ at >> 31]);
            __builtin_prefetch(rows->block[at ^ at >> 31] + 8);
            __builtin_prefetch(x + 3 * (ptrdiff_t)rows->column[ahead]);
            add_either((const double(*)[9])rows->block, rows->at[k],
                       x + 3 * (ptrdiff_t)rows->column[k], sum);
        }
        for (int axis = 0; axis < 3; axis++)
            image[3 * (ptrdiff_t)rows->order[r] + axis] = sum[axis];
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
