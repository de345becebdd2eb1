// SPDX-License-Identifier: GPL-3.0-or-later
#include "supernodal_state.h"

#include "basics/memory.h"
#include "dense_kernels.h"

#include <stdlib.h>
#include <string.h>

// ---- one supernode ------------------------------------------------------------------

// WIDE columns from FIRST on; X are the rows of the panel.
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
    four sum[4] = {{0}};
    double own[4];
    int i = begin;
    for (; i + 4 <= rows; i += 4)
        for (int j = 0; j < wide; j++)
            sum[j] =
                fused(load_four(panel + (long)j * rows + i), load_four(x + i), sum[j]);
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
    double *ordered = f->column[0];
    memcpy(ordered, half, (size_t)f->n * sizeof *ordered);
    for (int s = f->n_super - 1; s >= 0; s--)
        backward_through(f, &f->super[s], ordered);
    for (int k = 0; k < f->n; k++)
        x[k] = ordered[f->place[k]];
    memset(ordered, 0, (size_t)f->n * sizeof *ordered);
}

// ---- halves -------------------------------------------------------------------------

static int compare_ints(const void *a, const void *b)
{
    const int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

static void find_way(struct supernodal *f, int count, const int *index,
                     struct halves *halves)
{
    int capacity = 0;
    for (int k = 0; k < count; k++)
        for (int s = f->super_of[f->place[index[k]]]; s >= 0 && !f->is_on_way[s];
             s = f->super[s].parent) {
            f->is_on_way[s] = true;
            GROW_ARRAY(halves->super, halves->n_super, capacity);
            halves->super[halves->n_super++] = s;
            halves->size += f->super[s].columns;
        }
    for (int k = 0; k < halves->n_super; k++)
        f->is_on_way[halves->super[k]] = false;
    if (count > 0)
        qsort(halves->super, (size_t)halves->n_super, sizeof(int), compare_ints);
}

struct halves supernodal_halves(struct supernodal *f, int columns, int count,
                                const int *index, const double *value)
{
    struct halves halves = {.columns = columns};
    find_way(f, count, index, &halves);
    halves.value = NEW_ARRAY(double, (size_t)columns *(size_t)halves.size);
    for (int c = 0; c < columns; c++)
        for (int k = 0; k < count; k++)
            f->column[c][f->place[index[k]]] = value[c * count + k];
    double *to = halves.value;
    for (int k = 0; k < halves.n_super; k++) {
        const struct supernode *super = &f->super[halves.super[k]];
        const size_t bytes = (size_t)super->columns * sizeof *to;
        for (int c = 0; c < columns; c++) {
            forward_through(f, super, f->column[c]);
            memcpy(to + (size_t)c * (size_t)halves.size, f->column[c] + super->first,
                   bytes);
            memset(f->column[c] + super->first, 0, bytes);
        }
        to += super->columns;
    }
    return halves;
}

void halves_free(struct halves *halves)
{
    free(halves->super);
    free(halves->value);
    *halves = (struct halves){0};
}

void halves_product(const struct supernodal *f, const struct halves *a,
                    const struct halves *b, double *product)
{
    memset(product, 0, (size_t)(a->columns * b->columns) * sizeof *product);
    long from_a = 0, from_b = 0;
    for (int k = 0, l = 0; k < a->n_super && l < b->n_super;) {
        const int s = a->super[k], t = b->super[l];
        if (s == t) {
            const int columns = f->super[s].columns;
            for (int i = 0; i < a->columns; i++)
                for (int j = 0; j < b->columns; j++)
                    product[i * b->columns + j] +=
                        dot_product(columns, a->value + (long)i * a->size + from_a,
                                    b->value + (long)j * b->size + from_b);
        }
        if (s <= t) from_a += f->super[s].columns, k++;
        if (t <= s) from_b += f->super[t].columns, l++;
    }
}

void halves_apply(const struct supernodal *f, const struct halves *halves,
                  const double *half, double *product)
{
    memset(product, 0, (size_t)halves->columns * sizeof *product);
    const double *from = halves->value;
    for (int k = 0; k < halves->n_super; k++) {
        const struct supernode *super = &f->super[halves->super[k]];
        for (int c = 0; c < halves->columns; c++)
            product[c] += dot_product(super->columns, from + (long)c * halves->size,
                                      half + super->first);
        from += super->columns;
    }
}

void halves_take_off(const struct supernodal *f, const struct halves *halves,
                     const double *share, double *half)
{
    const double *from = halves->value;
    for (int k = 0; k < halves->n_super; k++) {
        const struct supernode *super = &f->super[halves->super[k]];
        for (int c = 0; c < halves->columns; c++) {
            const double *column = from + (long)c * halves->size;
            if (share[c] == 0) continue;
            for (int i = 0; i < super->columns; i++)
                half[super->first + i] -= share[c] * column[i];
        }
        from += super->columns;
    }
}
