// SPDX-License-Identifier: GPL-3.0-or-later
// Solution with a supernodal factor, supernode by supernode: forward L y = b gathers
// the rows of a panel, solves in its triangle and subtracts from the rows below;
// backward L^T x = y subtracts the rows below first. Columns go four, two or one at a
// time, so that each number of a row is read once for several columns. In code order
//     forward   y_j = (b_j - sum_{l<j} L_jl y_l) / L_jj,   b_i -= L_ij y_j for i below;
//     backward  x_j = (y_j - sum_{i below} L_ij x_i - sum_{l>j} L_lj x_l) / L_jj.
// L_ij lies at panel[j rows + i]; a fixed order of sums gives the same digits on every
// machine.
#include "supernodal_internal.h"

#include "dense_kernels.h"

#include <string.h>

// ---- one supernode ------------------------------------------------------------------

// Solves in WIDE columns from FIRST on; X are the rows of the panel.
static inline __attribute__((always_inline)) void
forward_columns(const struct supernode *super, int first, int wide, double *restrict x)
{
    const int rows = super->rows;
    const double *restrict panel = super->panel + (long)first * rows;
    double own[4];
    for (int j = 0; j < wide; j++) {
        own[j] = x[first + j];
        for (int l = 0; l < j; l++)
            own[j] -= panel[(long)l * rows + first + j] * own[l];
        own[j] /= panel[(long)j * rows + first + j];
        x[first + j] = own[j];
    }
    for (int i = first + wide; i < rows; i++) {
        double left = x[i];
        for (int j = 0; j < wide; j++)
            left = fma(-panel[(long)j * rows + i], own[j], left);
        x[i] = left;
    }
}

static inline __attribute__((always_inline)) void
backward_columns(const struct supernode *super, int first, int wide, double *restrict x)
{
    const int rows = super->rows, begin = first + wide;
    const double *restrict panel = super->panel + (long)first * rows;
    double4 sum[4] = {{0}};
    double own[4];
    int i = begin;
    for (; i + 4 <= rows; i += 4)
        for (int j = 0; j < wide; j++)
            sum[j] = fmadd(load_unaligned(panel + (long)j * rows + i),
                           load_unaligned(x + i), sum[j]);
    for (int j = 0; j < wide; j++)
        own[j] = (sum[j][0] + sum[j][1]) + (sum[j][2] + sum[j][3]);
    for (; i < rows; i++)
        for (int j = 0; j < wide; j++)
            own[j] = fma(panel[(long)j * rows + i], x[i], own[j]);
    for (int j = wide - 1; j >= 0; j--) {
        double left = x[first + j] - own[j];
        for (int l = j + 1; l < wide; l++)
            left -= panel[(long)j * rows + first + l] * x[first + l];
        x[first + j] = left / panel[(long)j * rows + first + j];
    }
}

static void gather(const struct supernode *super, const double *x, double *rows)
{
    memcpy(rows, x + super->first, (size_t)super->columns * sizeof *rows);
    for (int i = super->columns; i < super->rows; i++)
        rows[i] = x[super->row[i]];
}

void forward_through(struct supernodal *f, const struct supernode *super, double *x)
{
    double *rows = f->work;
    const int columns = super->columns;
    gather(super, x, rows);
    int first = 0;
    for (; first + 4 <= columns; first += 4)
        forward_columns(super, first, 4, rows);
    if (columns - first >= 2) {
        forward_columns(super, first, 2, rows);
        first += 2;
    }
    if (first < columns) forward_columns(super, first, 1, rows);
    memcpy(x + super->first, rows, (size_t)columns * sizeof *rows);
    for (int i = columns; i < super->rows; i++)
        x[super->row[i]] = rows[i];
}

static void backward_through(struct supernodal *f, const struct supernode *super,
                             double *x)
{
    double *rows = f->work;
    gather(super, x, rows);
    int end = super->columns;
    if (end % 2) backward_columns(super, --end, 1, rows);
    if (end % 4) backward_columns(super, end -= 2, 2, rows);
    while (end > 0)
        backward_columns(super, end -= 4, 4, rows);
    memcpy(x + super->first, rows, (size_t)super->columns * sizeof *rows);
}

void supernodal_forward(struct supernodal *f, const double *x, double *half)
{
    for (int k = 0; k < f->n; k++)
        half[f->place[k]] = x[k];
    for (int s = 0; s < f->n_super; s++)
        forward_through(f, &f->super[s], half);
}

void supernodal_backward(struct supernodal *f, const double *half, double *x)
{
    double *ordered = f->lanes;
    memcpy(ordered, half, (size_t)f->n * sizeof *ordered);
    for (int s = f->n_super - 1; s >= 0; s--)
        backward_through(f, &f->super[s], ordered);
    for (int k = 0; k < f->n; k++)
        x[k] = ordered[f->place[k]];
    memset(ordered, 0, (size_t)f->n * sizeof *ordered);
}
