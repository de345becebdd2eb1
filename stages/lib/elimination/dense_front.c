// SPDX-License-Identifier: GPL-3.0-or-later
// A symmetric matrix that gains products factor row row^T again and again: the front of
// a multifrontal elimination.
//
// A small one adds each product at once. A large one defers them: `pending` holds up to
// MAX_PENDING rows (of doubles half as many), in blocks of columns that fit in the
// cache, and a pass adds
//     entry[i][j] += sum_k factor[k] pending[k][i] pending[k][j]
// for all of them, which reads the entries once (dense_front_kernel.h). A row that is
// copied while products are pending is completed from them. The order of the sums is
// fixed, whatever the processor.
#include "dense_front.h"

#include "basics/cpu_features.h"
#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static size_t entry_size(const struct dense_front *dense)
{
    return dense->is_rounded ? sizeof(float) : sizeof(double);
}

// Not of floats, which lie in strips.
static double *row_of(const struct dense_front *dense, int i)
{
    return (double *)dense->entry + dense_front_row(dense, i);
}

static float *float_at(const struct dense_front *dense, int i, int j)
{
    return (float *)dense->entry + dense_front_in_strip(dense, i, j);
}

// Number of entries of N rows; whole panels if large.
static size_t n_entries(const struct dense_front *dense, int n)
{
    return dense_front_row(dense,
                           dense->is_large ? (n + PANEL - 1) / PANEL * PANEL : n);
}

static void reserve_rows(struct dense_front *dense, int n_before, int n)
{
    if (n_entries(dense, n) <= dense->capacity) return;
    dense->capacity = n_entries(dense, n) + n_entries(dense, n) / 2;
    if (!dense->is_large) {
        dense->entry = reallocate(dense->entry, dense->capacity, sizeof(double));
        return;
    }
    void *entry = allocate_uncleared(dense->capacity, entry_size(dense));
    if (dense->entry)
        memcpy(entry, dense->entry, n_entries(dense, n_before) * entry_size(dense));
    free(dense->entry);
    dense->entry = entry;
}

static int room_pending(const struct dense_front *dense)
{
    return dense->is_rounded ? MAX_PENDING : MAX_PENDING_DOUBLES;
}

// --- what waits --------------------------------------------------------------------

// The more are pending, the fewer passes over the entries, but the more to add to each
// row that is copied.
static int max_pending(const struct dense_front *dense, int n)
{
    const int most = n / 16;
    return most < 8 ? 8 : most < room_pending(dense) ? most : room_pending(dense);
}

static int columns_in_block(const struct dense_front *dense)
{
    return BLOCK_BYTES / (int)entry_size(dense);
}

// Position of column P of the first pending row; those of the others follow, one block
// of columns apart.
static size_t pending_column(const struct dense_front *dense, int p)
{
    const int columns = columns_in_block(dense);
    return (size_t)(p / columns) * (size_t)(room_pending(dense) * columns) +
           (size_t)(p % columns);
}

static double pending_entry(const struct dense_front *dense, size_t at)
{
    return dense->is_rounded ? (double)((float *)dense->pending)[at]
                             : ((double *)dense->pending)[at];
}

static void set_pending(struct dense_front *dense, size_t at, double x)
{
    if (dense->is_rounded)
        ((float *)dense->pending)[at] = (float)x;
    else
        ((double *)dense->pending)[at] = x;
}

static int blocks_of(const struct dense_front *dense, int n)
{
    return (n + columns_in_block(dense) - 1) / columns_in_block(dense);
}

static void reserve_pending(struct dense_front *dense, int n)
{
    const int n_block = blocks_of(dense, n);
    if (n_block <= dense->n_block) return;
    if (!dense->factor) dense->factor = NEW_ARRAY(double, MAX_PENDING);
    const size_t size = (size_t)room_pending(dense) * BLOCK_BYTES;
    const int capacity = n_block + dense->n_block / 2;
    void *pending = allocate_aligned((size_t)capacity, size);
    if (dense->pending) memcpy(pending, dense->pending, (size_t)dense->n_block * size);
    free(dense->pending);
    dense->pending = pending;
    dense->n_block = capacity;
}

static void clear_pending(struct dense_front *dense, int p)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = pending_column(dense, p);
    for (int k = 0; k < dense->n_pending; k++)
        set_pending(dense, at + (size_t)k * step, 0);
}

static void move_pending(struct dense_front *dense, int p, int from)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = pending_column(dense, p);
    const size_t was = pending_column(dense, from);
    for (int k = 0; k < dense->n_pending; k++)
        set_pending(dense, at + (size_t)k * step,
                    pending_entry(dense, was + (size_t)k * step));
}

static void add_pending(struct dense_front *dense, int n, double factor,
                        const double *row)
{
    reserve_pending(dense, n);
    const int columns = columns_in_block(dense), k = dense->n_pending++;
    dense->factor[k] = factor;
    for (int first = 0; first < n; first += columns) {
        const size_t at = pending_column(dense, first) + (size_t)k * (size_t)columns;
        const int end = n - first < columns ? n - first : columns;
        for (int c = 0; c < end; c++)
            set_pending(dense, at + (size_t)c, row[first + c]);
    }
}

void dense_front_flush(struct dense_front *dense, int n)
{
    if (dense->n_pending == 0) return;
    dense_front_pass *const pass[2][2] = {
        {dense_front_pass_avx2_double, dense_front_pass_avx512_double},
        {dense_front_pass_avx2_float, dense_front_pass_avx512_float}};
    pass[dense->is_rounded][has_avx512()](dense, n);
    dense->n_pending = 0;
}

static void gather_pending(const struct dense_front *dense, int n, int p, double *row)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = pending_column(dense, p);
    double weight[MAX_PENDING];
    for (int k = 0; k < dense->n_pending; k++)
        weight[k] = dense->factor[k] * pending_entry(dense, at + (size_t)k * step);
    dense_front_gather *const gather[2][2] = {
        {dense_front_gather_avx2_double, dense_front_gather_avx512_double},
        {dense_front_gather_avx2_float, dense_front_gather_avx512_float}};
    gather[dense->is_rounded][has_avx512()](dense, n, weight, row);
}

// --- rows --------------------------------------------------------------------------

static void clear_row(struct dense_front *dense, int i)
{
    if (dense->is_rounded) {
        for (int j = 0; j < i; j += STRIP)
            memset(float_at(dense, i, j), 0, STRIP * sizeof(float));
        return;
    }
    const size_t length = dense_front_row(dense, i + 1) - dense_front_row(dense, i);
    if (length > 0) memset(row_of(dense, i), 0, length * sizeof(double));
}

// A new panel is cleared as a whole, since passes add to its unused part too.
static void clear_panel(struct dense_front *dense, int i)
{
    const size_t begin = dense_front_row(dense, i) * entry_size(dense);
    const size_t end = dense_front_row(dense, i + PANEL) * entry_size(dense);
    memset((char *)dense->entry + begin, 0, end - begin);
}

void dense_front_add_row(struct dense_front *dense, int n)
{
    reserve_rows(dense, n, n + 1);
    if (dense->is_large && n % PANEL == 0)
        clear_panel(dense, n);
    else
        clear_row(dense, n);
    if (dense->n_pending == 0) return;
    reserve_pending(dense, n + 1);
    clear_pending(dense, n);
}

// Column P below the diagonal, of large rows. Those of a panel are LENGTH numbers
// apart: each is in a cache line of its own, which the processor does not foresee.
static void copy_column(const struct dense_front *dense, int n, int p, double *row)
{
    enum { AHEAD = 24 };
    for (int i = p + 1; i < n;) {
        const int end = (i / PANEL + 1) * PANEL;
        const size_t length = (size_t)end;
        size_t at = dense_front_row(dense, i) + (size_t)p;
        for (; i < end && i < n; i++, at += length) {
            __builtin_prefetch((double *)dense->entry + at + AHEAD * length);
            row[i] = dense_front_number(dense, at);
        }
    }
}

static void take_doubles(struct dense_front *dense, int n, int p, double *row)
{
    const int last = n - 1;
    memcpy(row, row_of(dense, p), (size_t)p * sizeof *row);
    if (dense->is_large)
        copy_column(dense, n, p, row);
    else
        for (int i = p + 1; i < n; i++)
            row[i] = dense_front_entry(dense, i, p);
    if (p == last) return;
    memcpy(row_of(dense, p), row_of(dense, last), (size_t)p * sizeof *row);
    for (int i = p + 1; i < last; i++)
        dense_front_set(dense, i, p, dense_front_entry(dense, last, i));
}

// Column P of the rows from BEGIN to END - 1 of a panel, all below the diagonal, for
// those of the last row. Meanwhile it fetches that of the next panel.
static void take_in_panel(struct dense_front *dense, int begin, int end, int p,
                          int last, double *row)
{
    float *own = float_at(dense, begin, p);
    const float *next = float_at(dense, begin + PANEL, p);
    for (int i = begin; i < end;) {
        const float *from = float_at(dense, last, i);
        const int strip = i + STRIP - i % STRIP, stop = strip < end ? strip : end;
        for (; i < stop; i++, own += STRIP, next += STRIP) {
            __builtin_prefetch(next, 1);
            row[i] = (double)*own;
            *own = *from++;
        }
    }
}

static void take_floats(struct dense_front *dense, int n, int p, double *row)
{
    const int last = n - 1;
    for (int j = 0; j < p; j += STRIP) {
        float *own = float_at(dense, p, j);
        const float *from = float_at(dense, last, j);
        for (int c = 0; c < STRIP && j + c < p; c++) {
            row[j + c] = (double)own[c];
            own[c] = from[c];
        }
    }
    if (p < last) row[last] = (double)*float_at(dense, last, p);
    for (int i = p + 1, end; i < last; i = end) {
        end = i + PANEL - i % PANEL < last ? i + PANEL - i % PANEL : last;
        take_in_panel(dense, i, end, p, last, row);
    }
}

void dense_front_take_row(struct dense_front *dense, int n, int p, double *row)
{
    if (dense->is_rounded)
        take_floats(dense, n, p, row);
    else
        take_doubles(dense, n, p, row);
    if (dense->n_pending > 0) {
        gather_pending(dense, n, p, row);
        move_pending(dense, p, n - 1);
    }
    row[p] = 0;
}

void dense_front_enlarge(struct dense_front *dense, int n, bool is_rounded)
{
    struct dense_front large = {.is_large = true, .is_rounded = is_rounded};
    for (int i = 0; i < n; i++) {
        dense_front_add_row(&large, i);
        for (int j = 0; j < i; j++)
            dense_front_set(&large, i, j, dense_front_entry(dense, i, j));
    }
    dense_front_free(dense);
    *dense = large;
}

void dense_front_add_products(struct dense_front *dense, int n, double factor,
                              const double *row)
{
    if (dense->is_large) {
        add_pending(dense, n, factor, row);
        if (dense->n_pending >= max_pending(dense, n)) dense_front_flush(dense, n);
        return;
    }
    double *entry = dense->entry;
    for (int i = 1; i < n; i++) {
        const double share = factor * row[i];
        for (int j = 0; j < i; j++)
            *entry++ += share * row[j];
    }
}

// --- state -------------------------------------------------------------------------

// Floats go through doubles, which hold them exactly.
static void row_state(struct dense_front *dense, int i, double *row,
                      struct checkpoint_stream *stream)
{
    if (!dense->is_rounded) {
        stream_numbers(stream, row_of(dense, i), i);
        return;
    }
    for (int j = 0; j < i && !stream->restoring; j++)
        row[j] = dense_front_entry(dense, i, j);
    stream_numbers(stream, row, i);
    for (int j = 0; j < i && stream->restoring; j++)
        dense_front_set(dense, i, j, row[j]);
}

static void pending_state(struct dense_front *dense, int n, double *row,
                          struct checkpoint_stream *stream)
{
    const int64_t in_block = (int64_t)room_pending(dense) * columns_in_block(dense);
    const int64_t count = blocks_of(dense, n) * in_block;
    if (!dense->is_rounded) {
        stream_numbers(stream, dense->pending, count);
        return;
    }
    for (int64_t at = 0, size; at < count; at += size) {
        size = count - at < n ? count - at : n;
        for (int64_t k = 0; k < size && !stream->restoring; k++)
            row[k] = pending_entry(dense, (size_t)(at + k));
        stream_numbers(stream, row, size);
        for (int64_t k = 0; k < size && stream->restoring; k++)
            set_pending(dense, (size_t)(at + k), row[k]);
    }
}

void dense_front_state(struct dense_front *dense, int n, bool is_rounded,
                       struct checkpoint_stream *stream)
{
    int n_pending = dense->n_pending;
    stream_flags(stream, &dense->is_large, 1);
    dense->is_rounded = dense->is_large && is_rounded;
    stream_integer(stream, &n_pending, 0, room_pending(dense) - 1);
    double *row = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++) {
        if (stream->restoring) dense_front_add_row(dense, i);
        row_state(dense, i, row, stream);
    }
    stream->failed |= n_pending > 0 && !dense->is_large;
    if (n_pending > 0 && !stream->failed) {
        if (stream->restoring) reserve_pending(dense, n);
        dense->n_pending = n_pending;
        stream_numbers(stream, dense->factor, n_pending);
        pending_state(dense, n, row, stream);
    }
    free(row);
}

void dense_front_free(struct dense_front *dense)
{
    free(dense->entry);
    free(dense->factor);
    free(dense->pending);
    *dense = (struct dense_front){0};
}
