// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangle.h"

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

// A panel that begins is cleared as a whole: what means nothing is added to as well.
void triangle_add_row(struct triangle *triangle, int n)
{
    make_room(triangle, n, n + 1);
    const int end = triangle->is_large && n % PANEL == 0 ? n + PANEL : n + 1;
    const size_t length = triangle_row(triangle, end) - triangle_row(triangle, n);
    if (length > 0) memset(row_of(triangle, n), 0, length * entry_size(triangle));
}

void triangle_take(const struct triangle *triangle, int n, int p, double *row)
{
    for (int j = 0; j < p; j++)
        row[j] = triangle_entry(triangle, p, j);
    row[p] = 0;
    for (int i = p + 1; i < n; i++)
        row[i] = triangle_entry(triangle, i, p);
}

void triangle_remove(struct triangle *triangle, int n, int p)
{
    const int last = n - 1;
    if (p == last) return;
    memcpy(row_of(triangle, p), row_of(triangle, last),
           (size_t)p * entry_size(triangle));
    for (int i = p + 1; i < last; i++)
        triangle_set(triangle, i, p, triangle_entry(triangle, last, i));
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

static void add_products(double *entry, int n, double factor, const double *row)
{
    for (int i = 1; i < n; i++) {
        const double share = factor * row[i];
        for (int j = 0; j < i; j++)
            *entry++ += share * row[j];
    }
}

void triangle_update(struct triangle *triangle, int n, int n_source,
                     const double *factor, const double *const *source)
{
    if (!triangle->is_large) {
        add_products(triangle->entry, n, *factor, *source);
        return;
    }
    triangle_kernel *const kernel[2][2] = {
        {triangle_update_narrow_double, triangle_update_wide_double},
        {triangle_update_narrow_float, triangle_update_wide_float}};
    kernel[triangle->is_rounded][has_wide_vectors()](triangle, n, n_source, factor,
                                                     source);
}

void triangle_free(struct triangle *triangle)
{
    free(triangle->entry);
    *triangle = (struct triangle){0};
}
