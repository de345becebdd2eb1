// SPDX-License-Identifier: GPL-3.0-or-later
// Supernodal Cholesky factor, left to right: P A P^T = L L^T. CHOLMOD orders the matrix
// and finds supernodes (successive columns with the same rows below), once for a
// pattern. For each supernode s, with its panel holding rows `row` of columns
// first..first+columns-1:
//     factor_panel: L_ss = chol(A_ss), rows below = A_below L_ss^-T;
//     update_above: for each later supernode that has some of these rows, subtract
//         L_rows L_rows^T from its panel (rows found by `local`).
// A pivot below DBL_EPSILON times the matrix's own diagonal is replaced by that, so the
// factor exists for a semidefinite matrix; supernodal_is_positive then says no.
#include "supernodal_internal.h"

#include "basics/memory.h"
#include "cholmod_serial.h"
#include "dense_kernels.h"
#include "vector_kernels.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- pattern ------------------------------------------------------------------------

static void copy_supernodes(struct supernodal *f, const cholmod_factor *analysed)
{
    const int *first = analysed->super, *start = analysed->pi, *place = analysed->Perm;
    f->n_super = (int)analysed->nsuper;
    f->super = NEW_ARRAY(struct supernode, f->n_super);
    f->super_of = NEW_ARRAY(int, f->n);
    f->place = NEW_ARRAY(int, f->n);
    f->row = duplicate(analysed->s, analysed->ssize, sizeof *f->row);
    for (int k = 0; k < f->n; k++)
        f->place[place[k]] = k;
    for (int s = 0; s < f->n_super; s++) {
        struct supernode *super = &f->super[s];
        *super = (struct supernode){.first = first[s],
                                    .columns = first[s + 1] - first[s],
                                    .rows = start[s + 1] - start[s],
                                    .row = f->row + start[s]};
        for (int c = 0; c < super->columns; c++)
            f->super_of[super->first + c] = s;
        f->size += (size_t)super->columns * (size_t)super->rows;
        if (super->columns > f->widest) f->widest = super->columns;
        if (super->rows > f->tallest) f->tallest = super->rows;
    }
    f->panels = allocate_aligned(f->size + 8, sizeof *f->panels);
    double *panel = f->panels;
    for (int s = 0; s < f->n_super; s++) {
        struct supernode *super = &f->super[s];
        super->panel = panel;
        panel += (size_t)super->columns * (size_t)super->rows;
        super->parent =
            super->rows > super->columns ? f->super_of[super->row[super->columns]] : -1;
    }
}

static int find_row(const struct supernode *super, int row)
{
    int low = 0, high = super->rows;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (super->row[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void find_targets(struct supernodal *f, const int *start, const int *row)
{
    f->target = NEW_ARRAY(long, f->n_entry);
    for (int c = 0; c < f->n; c++)
        for (int k = start[c]; k < start[c + 1]; k++) {
            f->target[k] = -1;
            if (row[k] < c) continue;
            const int i = f->place[row[k]], j = f->place[c];
            const int column = i < j ? i : j;
            const struct supernode *super = &f->super[f->super_of[column]];
            f->target[k] = super->panel - f->panels + find_row(super, i < j ? j : i) +
                           (long)(column - super->first) * super->rows;
        }
}

struct supernodal *supernodal_create(int n, const int *start, const int *row)
{
    if (n == 0) return NULL;
    struct supernodal *f = NEW_ARRAY(struct supernodal, 1);
    f->n = n;
    f->n_entry = start[n];
    cholmod_common common;
    cholmod_serial_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL; // the analysis only: no BLAS in that
    cholmod_sparse matrix = {.nrow = (size_t)n,
                             .ncol = (size_t)n,
                             .nzmax = (size_t)start[n],
                             .p = duplicate(start, (size_t)n + 1, sizeof *start),
                             .i = duplicate(row, (size_t)start[n], sizeof *row),
                             .stype = -1,
                             .itype = CHOLMOD_INT,
                             .xtype = CHOLMOD_PATTERN,
                             .sorted = 1,
                             .packed = 1};
    cholmod_factor *analysed = cholmod_analyze(&matrix, &common);
    copy_supernodes(f, analysed);
    cholmod_free_factor(&analysed, &common);
    cholmod_finish(&common);
    free(matrix.p);
    free(matrix.i);
    find_targets(f, start, row);
    f->work = NEW_ARRAY(double, ((size_t)f->tallest + PACKED) * (size_t)f->widest);
    f->local = NEW_ARRAY(int, f->tallest);
    f->in_reach = NEW_ARRAY(bool, f->n_super);
    f->lanes =
        allocate_aligned((size_t)n, (size_t)MOST_SOLVES * BATCH * sizeof *f->lanes);
    return f;
}

void supernodal_free(struct supernodal *f)
{
    if (!f) return;
    void *const owned[] = {f->super,  f->super_of, f->place, f->row,      f->panels,
                           f->target, f->work,     f->local, f->in_reach, f->lanes};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(f);
}

double supernodal_work(const struct supernodal *f)
{
    double work = 0;
    for (int s = 0; s < f->n_super; s++)
        for (int c = 0; c < f->super[s].columns; c++)
            work += 0.5 * (f->super[s].rows - c) * (double)(f->super[s].rows - c);
    return work;
}

// ---- numbers ------------------------------------------------------------------------

// Factors columns FIRST to END - 1 of a panel whose earlier columns are done. A pivot
// is at least the rounding of the matrix's own diagonal.
static bool factor_columns(const struct supernode *super, int first, int end,
                           const double *diagonal)
{
    for (int j = first; j < end; j++) {
        double *column = super->panel + (long)j * super->rows;
        const double pivot = sqrt(fmax(column[j], DBL_EPSILON * diagonal[j - first]));
        if (!(pivot > 0 && isfinite(pivot))) return false;
        column[j] = pivot;
        for (int i = j + 1; i < end; i++)
            column[i] /= pivot;
        for (int l = j + 1; l < end; l++) {
            double *other = super->panel + (long)l * super->rows;
            for (int i = l; i < end; i++)
                other[i] = fma(-column[l], column[i], other[i]);
        }
    }
    vector_kernels()->finish_columns(super, first, end);
    return true;
}

// Subtracts the products of columns FROM to TO - 1 from columns FIRST to END - 1.
static void subtract_columns(struct supernodal *f, const struct supernode *super,
                             int from, int to, int first, int end)
{
    if (from == to) return;
    const int rows = super->rows, below = rows - first;
    double *product = f->work, *packed = f->work + (long)f->tallest * f->widest;
    const double *before = super->panel + (long)from * rows + first;
    multiply_transposed(below, end - first, to - from, before, rows, before, rows,
                        product, below, true, packed);
    for (int j = first; j < end; j++) {
        double *column = super->panel + (long)j * rows;
        const double *off = product + (long)(j - first) * below - first;
        for (int i = j; i < rows; i++)
            column[i] -= off[i];
    }
}

// Factors a panel in wide parts, and these in narrow ones, to read what lies before
// them less often.
static bool factor_panel(struct supernodal *f, const struct supernode *super)
{
    enum { WIDE_PART = 48, NARROW_PART = 8 };
    double diagonal[WIDE_PART];
    for (int first = 0, end; first < super->columns; first = end) {
        end = first + WIDE_PART < super->columns ? first + WIDE_PART : super->columns;
        for (int j = first; j < end; j++)
            diagonal[j - first] = super->panel[(long)j * super->rows + j];
        subtract_columns(f, super, 0, first, first, end);
        for (int k = first, last; k < end; k = last) {
            last = k + NARROW_PART < end ? k + NARROW_PART : end;
            subtract_columns(f, super, first, k, k, last);
            if (!factor_columns(super, k, last, diagonal + k - first)) return false;
        }
    }
    return true;
}

// Takes L L^T of the rows from FIRST to END - 1 of SUPER, which are columns of ABOVE,
// off that.
static void update(struct supernodal *f, const struct supernode *super, int first,
                   int end, const struct supernode *above)
{
    const int rows = super->rows - first, columns = end - first;
    double *product = f->work, *packed = f->work + (long)f->tallest * f->widest;
    const double *panel = super->panel + first;
    multiply_transposed(rows, columns, super->columns, panel, super->rows, panel,
                        super->rows, product, rows, true, packed);
    for (int i = 0, at = 0; i < rows; i++) {
        while (above->row[at] < super->row[first + i])
            at++;
        f->local[i] = at;
    }
    for (int j = 0; j < columns; j++) {
        double *to = above->panel + (long)f->local[j] * above->rows;
        const double *from = product + (long)j * rows;
        for (int i = j; i < rows; i++)
            to[f->local[i]] -= from[i];
    }
}

static void update_above(struct supernodal *f, const struct supernode *super)
{
    for (int first = super->columns, end; first < super->rows; first = end) {
        const int above = f->super_of[super->row[first]];
        for (end = first; end < super->rows && f->super_of[super->row[end]] == above;)
            end++;
        update(f, super, first, end, &f->super[above]);
    }
}

bool supernodal_factor(struct supernodal *f, const double *value)
{
    memset(f->panels, 0, f->size * sizeof *f->panels);
    for (int k = 0; k < f->n_entry; k++)
        if (f->target[k] >= 0) f->panels[f->target[k]] = value[k];
    for (int s = 0; s < f->n_super; s++) {
        if (!factor_panel(f, &f->super[s])) return false;
        update_above(f, &f->super[s]);
    }
    return true;
}

// A pivot that was not positive is negative, or the least for its size.
bool supernodal_is_positive(const struct supernodal *f, const double *diagonal)
{
    for (int r = 0; r < f->n; r++) {
        const struct supernode *super = &f->super[f->super_of[f->place[r]]];
        const int own = f->place[r] - super->first;
        const double pivot = super->panel[(long)own * super->rows + own];
        if (!(pivot > 0 && pivot * pivot > 4 * DBL_EPSILON * diagonal[r])) return false;
    }
    return true;
}
