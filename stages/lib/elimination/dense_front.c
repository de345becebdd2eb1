// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_front.h"

#include "basics/cpu_features.h"
#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static size_t entry_size(const struct dense_front *dense)
{
    return dense->is_rounded ? sizeof(float) : sizeof(double);
}

static void *row_of(const struct dense_front *dense, int i)
{
    return (char *)dense->entry + dense_front_row(dense, i) * entry_size(dense);
}

// Entries of N rows; of whole panels if large.
static size_t room(const struct dense_front *dense, int n)
{
    return dense_front_row(dense,
                           dense->is_large ? (n + PANEL - 1) / PANEL * PANEL : n);
}

static void make_room(struct dense_front *dense, int n_before, int n)
{
    if (room(dense, n) <= dense->capacity) return;
    dense->capacity = room(dense, n) + room(dense, n) / 2;
    if (!dense->is_large) {
        dense->entry = reallocate(dense->entry, dense->capacity, sizeof(double));
        return;
    }
    void *entry = allocate_uncleared(dense->capacity, entry_size(dense));
    if (dense->entry)
        memcpy(entry, dense->entry, room(dense, n_before) * entry_size(dense));
    free(dense->entry);
    dense->entry = entry;
}

// --- what waits --------------------------------------------------------------------

// The more wait, the fewer passes over the entries, and the more to add to each row
// that is taken.
static int most_waiting(int n)
{
    const int most = n / 16;
    return most < 8 ? 8 : most < MOST_SOURCES ? most : MOST_SOURCES;
}

static int columns_in_block(const struct dense_front *dense)
{
    return BLOCK_BYTES / (int)entry_size(dense);
}

// Where column P of the first that waits stands; those of the others follow, a block
// after each other.
static size_t waiting_column(const struct dense_front *dense, int p)
{
    const int columns = columns_in_block(dense);
    return (size_t)(p / columns) * MOST_SOURCES * (size_t)columns +
           (size_t)(p % columns);
}

static double waiting_entry(const struct dense_front *dense, size_t at)
{
    return dense->is_rounded ? (double)((float *)dense->waiting)[at]
                             : ((double *)dense->waiting)[at];
}

static void set_waiting(struct dense_front *dense, size_t at, double x)
{
    if (dense->is_rounded)
        ((float *)dense->waiting)[at] = (float)x;
    else
        ((double *)dense->waiting)[at] = x;
}

static int blocks_of(const struct dense_front *dense, int n)
{
    return (n + columns_in_block(dense) - 1) / columns_in_block(dense);
}

static void make_waiting_room(struct dense_front *dense, int n)
{
    const int n_block = blocks_of(dense, n);
    if (n_block <= dense->n_block) return;
    if (!dense->factor) dense->factor = NEW_ARRAY(double, MOST_SOURCES);
    const size_t size = (size_t)MOST_SOURCES * BLOCK_BYTES;
    const int capacity = n_block + dense->n_block / 2;
    void *waiting = allocate_aligned((size_t)capacity, size);
    if (dense->waiting) memcpy(waiting, dense->waiting, (size_t)dense->n_block * size);
    free(dense->waiting);
    dense->waiting = waiting;
    dense->n_block = capacity;
}

static void clear_waiting(struct dense_front *dense, int p)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = waiting_column(dense, p);
    for (int k = 0; k < dense->n_waiting; k++)
        set_waiting(dense, at + (size_t)k * step, 0);
}

static void move_waiting(struct dense_front *dense, int p, int from)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = waiting_column(dense, p);
    const size_t was = waiting_column(dense, from);
    for (int k = 0; k < dense->n_waiting; k++)
        set_waiting(dense, at + (size_t)k * step,
                    waiting_entry(dense, was + (size_t)k * step));
}

static void add_waiting(struct dense_front *dense, int n, double factor,
                        const double *row)
{
    make_waiting_room(dense, n);
    const int columns = columns_in_block(dense), k = dense->n_waiting++;
    dense->factor[k] = factor;
    for (int first = 0; first < n; first += columns) {
        const size_t at = waiting_column(dense, first) + (size_t)k * (size_t)columns;
        const int end = n - first < columns ? n - first : columns;
        for (int c = 0; c < end; c++)
            set_waiting(dense, at + (size_t)c, row[first + c]);
    }
}

void dense_front_bring_up_to_date(struct dense_front *dense, int n)
{
    if (dense->n_waiting == 0) return;
    dense_front_pass *const pass[2][2] = {
        {dense_front_pass_avx2_double, dense_front_pass_avx512_double},
        {dense_front_pass_avx2_float, dense_front_pass_avx512_float}};
    pass[dense->is_rounded][has_avx512()](dense, n);
    dense->n_waiting = 0;
}

static void gather_waiting(const struct dense_front *dense, int n, int p, double *row)
{
    const size_t step = (size_t)columns_in_block(dense);
    const size_t at = waiting_column(dense, p);
    double weight[MOST_SOURCES];
    for (int k = 0; k < dense->n_waiting; k++)
        weight[k] = dense->factor[k] * waiting_entry(dense, at + (size_t)k * step);
    dense_front_gather *const gather[2][2] = {
        {dense_front_gather_avx2_double, dense_front_gather_avx512_double},
        {dense_front_gather_avx2_float, dense_front_gather_avx512_float}};
    gather[dense->is_rounded][has_avx512()](dense, n, weight, row);
}

// --- rows --------------------------------------------------------------------------

// A panel that begins is cleared as a whole: what means nothing is added to as well.
void dense_front_add_row(struct dense_front *dense, int n)
{
    make_room(dense, n, n + 1);
    const int end = dense->is_large && n % PANEL == 0 ? n + PANEL : n + 1;
    const size_t length = dense_front_row(dense, end) - dense_front_row(dense, n);
    if (length > 0) memset(row_of(dense, n), 0, length * entry_size(dense));
    if (dense->n_waiting == 0) return;
    make_waiting_room(dense, n + 1);
    clear_waiting(dense, n);
}

void dense_front_take(const struct dense_front *dense, int n, int p, double *row)
{
    for (int j = 0; j < p; j++)
        row[j] = dense_front_entry(dense, p, j);
    row[p] = 0;
    for (int i = p + 1; i < n; i++)
        row[i] = dense_front_entry(dense, i, p);
    if (dense->n_waiting == 0) return;
    gather_waiting(dense, n, p, row);
    row[p] = 0;
}

void dense_front_remove(struct dense_front *dense, int n, int p)
{
    const int last = n - 1;
    if (p == last) return;
    memcpy(row_of(dense, p), row_of(dense, last), (size_t)p * entry_size(dense));
    for (int i = p + 1; i < last; i++)
        dense_front_set(dense, i, p, dense_front_entry(dense, last, i));
    move_waiting(dense, p, last);
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
        add_waiting(dense, n, factor, row);
        if (dense->n_waiting >= most_waiting(n)) dense_front_bring_up_to_date(dense, n);
        return;
    }
    double *entry = dense->entry;
    for (int i = 1; i < n; i++) {
        const double share = factor * row[i];
        for (int j = 0; j < i; j++)
            *entry++ += share * row[j];
    }
}

void dense_front_state(struct dense_front *dense, int n,
                       struct checkpoint_stream *stream)
{
    int n_waiting = dense->n_waiting;
    stream_flags(stream, &dense->is_large, 1);
    stream_integer(stream, &n_waiting, 0, MOST_SOURCES - 1);
    for (int i = 0; i < n; i++) {
        if (stream->restoring) dense_front_add_row(dense, i);
        stream_numbers(stream, (double *)dense->entry + dense_front_row(dense, i), i);
    }
    stream->failed |= n_waiting > 0 && !dense->is_large;
    if (n_waiting == 0 || stream->failed) return;
    if (stream->restoring) make_waiting_room(dense, n);
    dense->n_waiting = n_waiting;
    stream_numbers(stream, dense->factor, n_waiting);
    stream_numbers(stream, dense->waiting,
                   (int64_t)blocks_of(dense, n) * MOST_SOURCES *
                       columns_in_block(dense));
}

void dense_front_free(struct dense_front *dense)
{
    free(dense->entry);
    free(dense->factor);
    free(dense->waiting);
    *dense = (struct dense_front){0};
}
