// SPDX-License-Identifier: GPL-3.0-or-later
#include "sheet.h"

#include "basics/memory.h"
#include "basics/wide_vectors.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// As many at once make up for fetching and storing a block.
enum { MANY_SOURCES = 32 };

struct sheet sheet_make(double threshold)
{
    return (struct sheet){.threshold = threshold};
}

static size_t n_blocks(int n_patch)
{
    return (size_t)n_patch * (size_t)(n_patch + 1) / 2;
}

void sheet_free(struct sheet *sheet)
{
    for (size_t k = 0; k < n_blocks(sheet->n_patch); k++)
        free(sheet->block[k]);
    free(sheet->key);
    free(sheet->count);
    free(sheet->unreported);
    free(sheet->site);
    free(sheet->block);
    free(sheet->n_done);
    for (int k = 0; k < MOST_SOURCES; k++) {
        free(sheet->source[k]);
        free(sheet->scaled[k]);
        free(sheet->sum[k]);
    }
    *sheet = (struct sheet){0};
}

static size_t block_index(int a, int b)
{
    const size_t high = (size_t)(a > b ? a : b), low = (size_t)(a > b ? b : a);
    return high * (high + 1) / 2 + low;
}

// --- sources -----------------------------------------------------------------------

// Source K has products for patches A and B.
static bool counts(const struct sheet *sheet, int k, int a, int b)
{
    return sheet->threshold == 0 ||
           sheet->sum[k][a] * sheet->sum[k][b] > sheet->least[k];
}

// Adds what sources have waited for the block of patches A and B.
static void bring_up_to_date(struct sheet *sheet, int a, int b)
{
    const int high = a > b ? a : b, low = a > b ? b : a;
    const size_t index = block_index(a, b);
    const double *left[MOST_SOURCES], *right[MOST_SOURCES];
    int n = 0;
    for (int k = sheet->n_done[index]; k < sheet->n_source; k++) {
        if (!counts(sheet, k, a, b)) continue;
        left[n] = sheet->scaled[k] + PATCH * high;
        right[n++] = sheet->source[k] + PATCH * low;
    }
    sheet->n_done[index] = sheet->n_source;
    if (n == 0 || sheet->count[a] == 0 || sheet->count[b] == 0) return;
    (has_wide_vectors() ? block_update_wide : block_update_narrow)(
        sheet->block[index], sheet->count[high], sheet->count[low], n, left, right);
}

static void use_up_sources(struct sheet *sheet)
{
    for (int a = 0; a < sheet->n_patch; a++)
        for (int b = 0; b <= a; b++) {
            bring_up_to_date(sheet, a, b);
            sheet->n_done[block_index(a, b)] = 0;
        }
    sheet->n_source = 0;
}

static void sum_parts(const struct sheet *sheet, const double *row, double *sum)
{
    for (int a = 0; a < sheet->n_patch; a++) {
        sum[a] = 0;
        for (int i = 0; i < sheet->count[a]; i++)
            sum[a] += row[PATCH * a + i];
    }
}

void sheet_add_products(struct sheet *sheet, const double *row, double factor,
                        double *left_out)
{
    if (sheet->n_source == MOST_SOURCES) use_up_sources(sheet);
    const int k = sheet->n_source++;
    const size_t capacity = (size_t)sheet->patch_capacity;
    if (!sheet->source[k]) {
        sheet->source[k] = NEW_ARRAY(double, PATCH *capacity);
        sheet->scaled[k] = NEW_ARRAY(double, PATCH *capacity);
        sheet->sum[k] = NEW_ARRAY(double, capacity);
    }
    for (int p = 0; p < sheet_places(sheet); p++) {
        sheet->source[k][p] = row[p];
        sheet->scaled[k][p] = factor * row[p];
    }
    if (sheet->threshold == 0) return;
    sum_parts(sheet, row, sheet->sum[k]);
    sheet->least[k] = sheet->threshold / (factor * factor);
    for (int a = 0; a < sheet->n_patch; a++) {
        left_out[a] = 0;
        for (int b = 0; b < sheet->n_patch; b++)
            if (!counts(sheet, k, a, b)) left_out[a] += factor * sheet->sum[k][b];
    }
}

// --- places ------------------------------------------------------------------------

static void widen(struct sheet *sheet)
{
    use_up_sources(sheet);
    for (int k = 0; k < MOST_SOURCES; k++) {
        free(sheet->source[k]);
        free(sheet->scaled[k]);
        free(sheet->sum[k]);
        sheet->source[k] = sheet->scaled[k] = sheet->sum[k] = NULL;
    }
    const int more = sheet->patch_capacity ? 2 * sheet->patch_capacity : 4;
    sheet->patch_capacity = more;
    sheet->key = reallocate(sheet->key, (size_t)more, sizeof *sheet->key);
    sheet->unreported =
        reallocate(sheet->unreported, (size_t)more, sizeof *sheet->unreported);
    sheet->count = reallocate(sheet->count, (size_t)more, sizeof *sheet->count);
    sheet->site =
        reallocate(sheet->site, (size_t)PATCH * (size_t)more, sizeof *sheet->site);
    sheet->block = reallocate(sheet->block, n_blocks(more), sizeof *sheet->block);
    sheet->n_done = reallocate(sheet->n_done, n_blocks(more), sizeof *sheet->n_done);
}

static int new_patch(struct sheet *sheet, int key)
{
    if (sheet->n_patch == sheet->patch_capacity) widen(sheet);
    const int patch = sheet->n_patch++;
    sheet->key[patch] = key;
    sheet->count[patch] = 0;
    sheet->unreported[patch] = 0;
    for (int b = 0; b <= patch; b++) {
        sheet->block[block_index(patch, b)] =
            allocate_aligned((size_t)PATCH * PATCH, sizeof(double));
        sheet->n_done[block_index(patch, b)] = sheet->n_source;
    }
    for (int k = 0; k < sheet->n_source; k++) {
        sheet->sum[k][patch] = 0;
        for (int i = 0; i < PATCH; i++)
            sheet->source[k][PATCH * patch + i] = sheet->scaled[k][PATCH * patch + i] =
                0;
    }
    return patch;
}

// The link between place P and the site I of patch B.
static double *entry(const struct sheet *sheet, int p, int b, int i)
{
    const int a = p / PATCH, row = p % PATCH;
    double *block = sheet->block[block_index(a, b)];
    return a >= b ? block + row * PATCH + i : block + i * PATCH + row;
}

// One of KEY with a place to spare, or an empty one that becomes it.
static int find_patch(struct sheet *sheet, int key)
{
    int empty = -1;
    for (int patch = 0; patch < sheet->n_patch; patch++) {
        if (sheet->count[patch] == 0) empty = patch;
        if (sheet->key[patch] == key && sheet->count[patch] < PATCH) return patch;
    }
    if (empty < 0) return new_patch(sheet, key);
    sheet->key[empty] = key;
    return empty;
}

int sheet_add(struct sheet *sheet, int site, int key)
{
    const int patch = find_patch(sheet, key);
    const int place = PATCH * patch + sheet->count[patch]++;
    sheet->site[place] = site;
    for (int b = 0; b < sheet->n_patch; b++)
        for (int i = 0; i < sheet->count[b]; i++)
            *entry(sheet, place, b, i) = 0;
    for (int i = 0; i < sheet->count[patch]; i++) // of its own block, the column too
        *entry(sheet, PATCH * patch + i, patch, place % PATCH) = 0;
    return place;
}

void sheet_link(struct sheet *sheet, int p, int q, double conductance)
{
    *entry(sheet, p, q / PATCH, q % PATCH) += conductance;
    if (p / PATCH == q / PATCH) *entry(sheet, q, p / PATCH, p % PATCH) += conductance;
}

// What sources that wait will add to the links of PLACE with patch B.
static void add_waiting(const struct sheet *sheet, int place, int b,
                        double *restrict row)
{
    for (int k = sheet->n_done[block_index(place / PATCH, b)]; k < sheet->n_source;
         k++) {
        if (!counts(sheet, k, place / PATCH, b)) continue;
        const double *restrict source = sheet->source[k] + PATCH * b;
        const double scaled = sheet->scaled[k][place];
        for (int i = 0; i < PATCH; i++)
            row[i] = fma(scaled, source[i], row[i]);
    }
}

void sheet_row(struct sheet *sheet, int place, double *row)
{
    const int a = place / PATCH;
    for (int b = 0; b < sheet->n_patch; b++) {
        double *part = row + PATCH * b;
        if (sheet->n_source - sheet->n_done[block_index(a, b)] >= MANY_SOURCES)
            bring_up_to_date(sheet, a, b);
        for (int i = 0; i < PATCH; i++)
            part[i] = i < sheet->count[b] ? *entry(sheet, place, b, i) : 0;
        add_waiting(sheet, place, b, part);
    }
    row[place] = 0;
}

int sheet_remove(struct sheet *sheet, int place, double *row)
{
    const int patch = place / PATCH, last = PATCH * patch + --sheet->count[patch];
    row[place] = row[last];
    row[last] = 0;
    for (int k = 0; k < sheet->n_source; k++) {
        sheet->source[k][place] = sheet->source[k][last];
        sheet->scaled[k][place] = sheet->scaled[k][last];
        sheet->source[k][last] = sheet->scaled[k][last] = 0;
    }
    if (place == last) return last;
    sheet->site[place] = sheet->site[last];
    for (int b = 0; b < sheet->n_patch; b++)
        for (int i = 0; i < sheet->count[b]; i++)
            *entry(sheet, place, b, i) = *entry(sheet, last, b, i);
    for (int i = 0; i < sheet->count[patch]; i++) // of its own block, the column too
        *entry(sheet, PATCH * patch + i, patch, place % PATCH) =
            *entry(sheet, place, patch, i);
    return last;
}
