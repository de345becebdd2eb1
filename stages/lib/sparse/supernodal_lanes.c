// SPDX-License-Identifier: GPL-3.0-or-later
// Solutions of several right-hand sides side by side, four or eight to a row: the
// factor is read once for all, and each lane has the digits that it would have alone.
#include "supernodal_state.h"

#include "dense_kernels.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

INLINE four all_of(double a)
{
    return (four){a, a, a, a};
}

// Of the row that SUPER's Ith is.
INLINE double *lanes_of(const struct supernode *super, int i, int quads, double *x)
{
    return x + (long)super->row[i] * 4 * quads;
}

// WIDE columns from FIRST on.
INLINE void forward_columns(const struct supernode *super, int first, int wide,
                            int quads, double *x)
{
    const int rows = super->rows;
    const double *panel = super->panel + (long)first * rows;
    four own[4][2];
    for (int j = 0; j < wide; j++) {
        double *at = lanes_of(super, first + j, quads, x);
        for (int q = 0; q < quads; q++) {
            own[j][q] = load_four(at + 4 * q);
            for (int l = 0; l < j; l++)
                own[j][q] = fused(all_of(-panel[(long)l * rows + first + j]), own[l][q],
                                  own[j][q]);
            own[j][q] /= all_of(panel[(long)j * rows + first + j]);
            store_four(at + 4 * q, own[j][q]);
        }
    }
    for (int i = first + wide; i < rows; i++) {
        double *at = lanes_of(super, i, quads, x);
        for (int q = 0; q < quads; q++) {
            four left = load_four(at + 4 * q);
            for (int j = 0; j < wide; j++)
                left = fused(all_of(-panel[(long)j * rows + i]), own[j][q], left);
            store_four(at + 4 * q, left);
        }
    }
}

INLINE void backward_columns(const struct supernode *super, int first, int wide,
                             int quads, double *x)
{
    const int rows = super->rows;
    const double *panel = super->panel + (long)first * rows;
    four left[4][2];
    for (int j = 0; j < wide; j++)
        for (int q = 0; q < quads; q++)
            left[j][q] = load_four(lanes_of(super, first + j, quads, x) + 4 * q);
    for (int i = first + wide; i < rows; i++) {
        const double *at = lanes_of(super, i, quads, x);
        for (int j = 0; j < wide; j++)
            for (int q = 0; q < quads; q++)
                left[j][q] = fused(all_of(-panel[(long)j * rows + i]),
                                   load_four(at + 4 * q), left[j][q]);
    }
    for (int j = wide - 1; j >= 0; j--)
        for (int q = 0; q < quads; q++) {
            for (int l = j + 1; l < wide; l++)
                left[j][q] = fused(all_of(-panel[(long)j * rows + first + l]),
                                   left[l][q], left[j][q]);
            left[j][q] /= all_of(panel[(long)j * rows + first + j]);
            store_four(lanes_of(super, first + j, quads, x) + 4 * q, left[j][q]);
        }
}

INLINE void forward(const struct supernode *super, int quads, double *x)
{
    const int columns = super->columns;
    int first = 0;
    for (; first + 4 <= columns; first += 4)
        forward_columns(super, first, 4, quads, x);
    if (columns - first >= 2) {
        forward_columns(super, first, 2, quads, x);
        first += 2;
    }
    if (first < columns) forward_columns(super, first, 1, quads, x);
}

INLINE void backward(const struct supernode *super, int quads, double *x)
{
    int end = super->columns;
    if (end % 2) backward_columns(super, --end, 1, quads, x);
    if (end % 4) backward_columns(super, end -= 2, 2, quads, x);
    while (end > 0)
        backward_columns(super, end -= 4, 4, quads, x);
}

void forward_four(const struct supernode *super, double *x)
{
    forward(super, 1, x);
}

void forward_eight(const struct supernode *super, double *x)
{
    forward(super, 2, x);
}

void supernodal_forward_lanes(const struct supernodal *f, const double *x, double *half)
{
    const size_t bytes = LANES * sizeof *x;
    for (int k = 0; k < f->n; k++)
        memcpy(half + (long)f->place[k] * LANES, x + (long)k * LANES, bytes);
    for (int s = 0; s < f->n_super; s++)
        forward(&f->super[s], 2, half);
}

void supernodal_backward_lanes(const struct supernodal *f, double *half, double *x)
{
    const size_t bytes = LANES * sizeof *x;
    for (int s = f->n_super - 1; s >= 0; s--)
        backward(&f->super[s], 2, half);
    for (int k = 0; k < f->n; k++)
        memcpy(x + (long)k * LANES, half + (long)f->place[k] * LANES, bytes);
}
