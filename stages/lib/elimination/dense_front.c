// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_front.h"

#include "basics/memory.h"
#include "basics/wide_vectors.h"

#include <stdlib.h>
#include <string.h>

static size_t entry_size(const struct triangle *triangle)
{
    return triangle->is_rounded ? sizeof(float) : sizeof(double);
}

static void *row_of(const struct triangle *triangle, int i)
{
    return (char *)triangle->entry + triangle_row(triangle, i) * entry_size(triangle);
}

// Entries of N rows; of whole panels if large.
static size_t room(const struct triangle *triangle, int n)
{
    return triangle_row(triangle,
                        triangle->is_large ? (n + PANEL - 1) / PANEL * PANEL : n);
}

static void make_room(struct triangle *triangle, int n_before, int n)
{
    if (room(triangle, n) <= triangle->capacity) return;
    triangle->capacity = room(triangle, n) + room(triangle, n) / 2;
    if (!triangle->is_large) {
        triangle->entry =
            reallocate(triangle->entry, triangle->capacity, sizeof(double));
        return;
    }
    void *entry = allocate_uncleared(triangle->capacity, entry_size(triangle));
    if (triangle->entry)
        memcpy(entry, triangle->entry, room(triangle, n_before) * entry_size(triangle));
    free(triangle->entry);
    triangle->entry = entry;
}

// --- what waits --------------------------------------------------------------------

// The more wait, the fewer passes over the entries, and the more to add to each row
// that is taken.
static int most_waiting(int n)
{
    const int most = n / 16;
    return most < 8 ? 8 : most < MOST_SOURCES ? most : MOST_SOURCES;
}

static int columns_in_block(const struct triangle *triangle)
{
    return BLOCK_BYTES / (int)entry_size(triangle);
}

// Where column P of the first that waits stands; those of the others follow, a block
// after each other.
static size_t waiting_column(const struct triangle *triangle, int p)
{
    const int columns = columns_in_block(triangle);
    return (size_t)(p / columns) * MOST_SOURCES * (size_t)columns +
           (size_t)(p % columns);
}

static double waiting_entry(const struct triangle *triangle, size_t at)
{
    return triangle->is_rounded ? (double)((float *)triangle->waiting)[at]
                                : ((double *)triangle->waiting)[at];
}

static void set_waiting(struct triangle *triangle, size_t at, double x)
{
    if (triangle->is_rounded)
        ((float *)triangle->waiting)[at] = (float)x;
    else
        ((double *)triangle->waiting)[at] = x;
}

static int blocks_of(const struct triangle *triangle, int n)
{
    return (n + columns_in_block(triangle) - 1) / columns_in_block(triangle);
}

static void make_waiting_room(struct triangle *triangle, int n)
{
    const int n_block = blocks_of(triangle, n);
    if (n_block <= triangle->n_block) return;
    if (!triangle->factor) triangle->factor = NEW_ARRAY(double, MOST_SOURCES);
    const size_t size = (size_t)MOST_SOURCES * BLOCK_BYTES;
    const int capacity = n_block + triangle->n_block / 2;
    void *waiting = allocate_aligned((size_t)capacity, size);
    if (triangle->waiting)
        memcpy(waiting, triangle->waiting, (size_t)triangle->n_block * size);
    free(triangle->waiting);
    triangle->waiting = waiting;
    triangle->n_block = capacity;
}

static void clear_waiting(struct triangle *triangle, int p)
{
    const size_t step = (size_t)columns_in_block(triangle);
    const size_t at = waiting_column(triangle, p);
    for (int k = 0; k < triangle->n_waiting; k++)
        set_waiting(triangle, at + (size_t)k * step, 0);
}

static void move_waiting(struct triangle *triangle, int p, int from)
{
    const size_t step = (size_t)columns_in_block(triangle);
    const size_t at = waiting_column(triangle, p);
    const size_t was = waiting_column(triangle, from);
    for (int k = 0; k < triangle->n_waiting; k++)
        set_waiting(triangle, at + (size_t)k * step,
                    waiting_entry(triangle, was + (size_t)k * step));
}

static void add_waiting(struct triangle *triangle, int n, double factor,
                        const double *row)
{
    make_waiting_room(triangle, n);
    const int columns = columns_in_block(triangle), k = triangle->n_waiting++;
    triangle->factor[k] = factor;
    for (int first = 0; first < n; first += columns) {
        const size_t at = waiting_column(triangle, first) + (size_t)k * (size_t)columns;
        const int end = n - first < columns ? n - first : columns;
        for (int c = 0; c < end; c++)
            set_waiting(triangle, at + (size_t)c, row[first + c]);
    }
}

void triangle_bring_up_to_date(struct triangle *triangle, int n)
{
    if (triangle->n_waiting == 0) return;
    triangle_pass *const pass[2][2] = {
        {triangle_pass_narrow_double, triangle_pass_wide_double},
        {triangle_pass_narrow_float, triangle_pass_wide_float}};
    pass[triangle->is_rounded][has_wide_vectors()](triangle, n);
    triangle->n_waiting = 0;
}

static void gather_waiting(const struct triangle *triangle, int n, int p, double *row)
{
    const size_t step = (size_t)columns_in_block(triangle);
    const size_t at = waiting_column(triangle, p);
    double weight[MOST_SOURCES];
    for (int k = 0; k < triangle->n_waiting; k++)
        weight[k] =
            triangle->factor[k] * waiting_entry(triangle, at + (size_t)k * step);
    triangle_gather *const gather[2][2] = {
        {triangle_gather_narrow_double, triangle_gather_wide_double},
        {triangle_gather_narrow_float, triangle_gather_wide_float}};
    gather[triangle->is_rounded][has_wide_vectors()](triangle, n, weight, row);
}

// --- rows --------------------------------------------------------------------------

// A panel that begins is cleared as a whole: what means nothing is added to as well.
void triangle_add_row(struct triangle *triangle, int n)
{
    make_room(triangle, n, n + 1);
    const int end = triangle->is_large && n % PANEL == 0 ? n + PANEL : n + 1;
    const size_t length = triangle_row(triangle, end) - triangle_row(triangle, n);
    if (length > 0) memset(row_of(triangle, n), 0, length * entry_size(triangle));
    if (triangle->n_waiting == 0) return;
    make_waiting_room(triangle, n + 1);
    clear_waiting(triangle, n);
}

void triangle_take(const struct triangle *triangle, int n, int p, double *row)
{
    for (int j = 0; j < p; j++)
        row[j] = triangle_entry(triangle, p, j);
    row[p] = 0;
    for (int i = p + 1; i < n; i++)
        row[i] = triangle_entry(triangle, i, p);
    if (triangle->n_waiting == 0) return;
    gather_waiting(triangle, n, p, row);
    row[p] = 0;
}

void triangle_remove(struct triangle *triangle, int n, int p)
{
    const int last = n - 1;
    if (p == last) return;
    memcpy(row_of(triangle, p), row_of(triangle, last),
           (size_t)p * entry_size(triangle));
    for (int i = p + 1; i < last; i++)
        triangle_set(triangle, i, p, triangle_entry(triangle, last, i));
    move_waiting(triangle, p, last);
}

void triangle_enlarge(struct triangle *triangle, int n, bool is_rounded)
{
    struct triangle large = {.is_large = true, .is_rounded = is_rounded};
    for (int i = 0; i < n; i++) {
        triangle_add_row(&large, i);
        for (int j = 0; j < i; j++)
            triangle_set(&large, i, j, triangle_entry(triangle, i, j));
    }
    triangle_free(triangle);
    *triangle = large;
}

void triangle_add_products(struct triangle *triangle, int n, double factor,
                           const double *row)
{
    if (triangle->is_large) {
        add_waiting(triangle, n, factor, row);
        if (triangle->n_waiting >= most_waiting(n))
            triangle_bring_up_to_date(triangle, n);
        return;
    }
    double *entry = triangle->entry;
    for (int i = 1; i < n; i++) {
        const double share = factor * row[i];
        for (int j = 0; j < i; j++)
            *entry++ += share * row[j];
    }
}

void triangle_state(struct triangle *triangle, int n, struct checkpoint_stream *stream)
{
    int n_waiting = triangle->n_waiting;
    stream_flags(stream, &triangle->is_large, 1);
    stream_integer(stream, &n_waiting, 0, MOST_SOURCES - 1);
    for (int i = 0; i < n; i++) {
        if (stream->restoring) triangle_add_row(triangle, i);
        stream_numbers(stream, (double *)triangle->entry + triangle_row(triangle, i),
                       i);
    }
    stream->failed |= n_waiting > 0 && !triangle->is_large;
    if (n_waiting == 0 || stream->failed) return;
    if (stream->restoring) make_waiting_room(triangle, n);
    triangle->n_waiting = n_waiting;
    stream_numbers(stream, triangle->factor, n_waiting);
    stream_numbers(stream, triangle->waiting,
                   (int64_t)blocks_of(triangle, n) * MOST_SOURCES *
                       columns_in_block(triangle));
}

void triangle_free(struct triangle *triangle)
{
    free(triangle->entry);
    free(triangle->factor);
    free(triangle->waiting);
    *triangle = (struct triangle){0};
}
