// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampled_factor.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

// L D L' in the order of elimination. A pore passes a share of what it holds to each of
// its neighbours. Shares are rounded to floats: the factor is only near Cholesky's
// anyway, it stays symmetric, and bytes are time.
struct sampled_factor {
    int n;
    int *pore;      // (n) in the order of elimination
    double *scale;  // (n) what D divides by
    int *offset;    // (n+1) into what follows
    int *neighbour; // by their places in that order; n: where the pressure is given
    float *share;
    double *work; // (n+1)
};

// Half a throat, in the list of the pore that it leaves. Its twin is the next entry or
// the one before.
struct half {
    double width; // 0: gone
    int to;
    int next; // in the list; -1: last
};

struct elimination {
    int n;
    struct half *half;
    int *first;  // (n+1) of each list
    int *degree; // (n) halves in the list that are not gone, or a few more
    int *before, *after, *bucket; // pores of the same degree, in a list; -1: ends
    int lowest;
    uint64_t state;
    int *column; // of the pore under way: halves
    double *sum;
    int capacity;
};

enum { MOST_DEGREE = 200 };

// SplitMix64: from 0 to 1.
static double draw(struct elimination *e)
{
    uint64_t z = e->state += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

// ---- pores by degree ----------------------------------------------------------------

static int bucket_of(const struct elimination *e, int i)
{
    return e->degree[i] < MOST_DEGREE ? e->degree[i] : MOST_DEGREE;
}

static void enter(struct elimination *e, int i)
{
    const int b = bucket_of(e, i);
    e->before[i] = -1;
    e->after[i] = e->bucket[b];
    if (e->bucket[b] >= 0) e->before[e->bucket[b]] = i;
    e->bucket[b] = i;
    if (b < e->lowest) e->lowest = b;
}

static void leave(struct elimination *e, int i)
{
    if (e->before[i] >= 0)
        e->after[e->before[i]] = e->after[i];
    else
        e->bucket[bucket_of(e, i)] = e->after[i];
    if (e->after[i] >= 0) e->before[e->after[i]] = e->before[i];
}

static void change_degree(struct elimination *e, int i, int by)
{
    if (i == e->n || by == 0) return;
    leave(e, i);
    e->degree[i] += by;
    enter(e, i);
}

static int take_lowest(struct elimination *e)
{
    while (e->bucket[e->lowest] < 0)
        e->lowest++;
    const int i = e->bucket[e->lowest];
    leave(e, i);
    return i;
}

// ---- set-up -------------------------------------------------------------------------

static void add_half(struct elimination *e, int *count, int from, int to, double width)
{
    e->half[*count] = (struct half){width, to, e->first[from]};
    e->first[from] = (*count)++;
    if (from < e->n) e->degree[from]++;
}

static void add_throat(struct elimination *e, int *count, int a, int b, double width)
{
    add_half(e, count, a, b, width);
    add_half(e, count, b, a, width);
}

static struct elimination begin(const struct matrix *matrix)
{
    const int n = matrix->n;
    struct elimination e = {.n = n, .lowest = MOST_DEGREE, .capacity = 64};
    e.half = NEW_ARRAY(struct half, (size_t)matrix->offset[n] + 2 * (size_t)n);
    e.first = NEW_ARRAY(int, n + 1);
    e.degree = NEW_ARRAY(int, n);
    e.before = NEW_ARRAY(int, n);
    e.after = NEW_ARRAY(int, n);
    e.bucket = NEW_ARRAY(int, MOST_DEGREE + 1);
    e.column = NEW_ARRAY(int, e.capacity);
    e.sum = NEW_ARRAY(double, e.capacity);
    for (int i = 0; i <= n; i++)
        e.first[i] = -1;
    for (int b = 0; b <= MOST_DEGREE; b++)
        e.bucket[b] = -1;
    int count = 0;
    for (int i = 0; i < n; i++) {
        double to_ground = 0;
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
            const int j = matrix->column[k];
            if (j >= n) to_ground += matrix->value[k];
            if (j < i) add_throat(&e, &count, i, j, matrix->value[k]);
        }
        if (to_ground > 0) add_throat(&e, &count, i, n, to_ground);
    }
    for (int i = n - 1; i >= 0; i--)
        enter(&e, i);
    return e;
}

static void end(struct elimination *e)
{
    free(e->half);
    free(e->first);
    free(e->degree);
    free(e->before);
    free(e->after);
    free(e->bucket);
    free(e->column);
    free(e->sum);
}

// ---- elimination --------------------------------------------------------------------

typedef bool comes_first(const struct half *half, int a, int b);

static bool is_narrower(const struct half *half, int a, int b)
{
    const struct half *x = &half[a], *y = &half[b];
    if (x->width < y->width || x->width > y->width) return x->width < y->width;
    return x->to != y->to ? x->to < y->to : a < b;
}

static bool goes_before(const struct half *half, int a, int b)
{
    return half[a].to != half[b].to ? half[a].to < half[b].to : a < b;
}

// The column's first LENGTH; nearly always a handful, so by insertion.
static inline void sort(struct elimination *e, int length, comes_first *first)
{
    for (int k = 1; k < length; k++) {
        const int half = e->column[k];
        int place = k;
        for (; place > 0 && first(e->half, half, e->column[place - 1]); place--)
            e->column[place] = e->column[place - 1];
        e->column[place] = half;
    }
}

// The throats that pore I still has, parallel ones as one, the narrowest first.
static int gather(struct elimination *e, int i)
{
    int length = 0;
    for (int h = e->first[i]; h >= 0; h = e->half[h].next) {
        if (!(e->half[h].width > 0)) continue;
        if (length == e->capacity) {
            e->capacity *= 2;
            e->column = reallocate(e->column, (size_t)e->capacity, sizeof *e->column);
            e->sum = reallocate(e->sum, (size_t)e->capacity, sizeof *e->sum);
        }
        e->column[length++] = h;
    }
    sort(e, length, goes_before);
    int kept = 0;
    for (int k = 0; k < length; k++) {
        const int h = e->column[k];
        if (kept && e->half[e->column[kept - 1]].to == e->half[h].to) {
            e->half[e->column[kept - 1]].width += e->half[h].width;
            e->half[h ^ 1].width = 0;
            change_degree(e, e->half[h].to, -1);
        } else {
            e->column[kept++] = h;
        }
    }
    sort(e, kept, is_narrower);
    return kept;
}

// The first place from FROM on where the sum is above R.
static int search(const double *sum, int from, int length, double r)
{
    int low = from, high = length - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (sum[middle] > r)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

// Takes out a pore; returns the inverse of its entry of D. New throats take the place
// of the old.
static double eliminate(struct elimination *e, int length, int *neighbour, float *share)
{
    double sum = 0, rest = 1;
    for (int k = 0; k < length; k++)
        e->sum[k] = sum += e->half[e->column[k]].width;
    double whole = sum;
    for (int k = 0; k + 1 < length; k++) {
        const int h = e->column[k], j = e->half[h].to;
        const double f = e->half[h].width * rest / whole;
        const double r = e->sum[k] + draw(e) * (e->sum[length - 1] - e->sum[k]);
        const int other = e->half[e->column[search(e->sum, k + 1, length, r)]].to;
        neighbour[k] = j;
        share[k] = (float)(f * rest);
        e->half[h ^ 1].to = other; // from j
        e->half[h ^ 1].width = f * (1 - f) * whole;
        e->half[h] = (struct half){f * (1 - f) * whole, j, e->first[other]};
        e->first[other] = h;
        change_degree(e, other, 1);
        rest *= 1 - f;
        whole *= (1 - f) * (1 - f);
    }
    if (length == 0) return 0;
    const int last = e->column[length - 1];
    neighbour[length - 1] = e->half[last].to;
    share[length - 1] = (float)rest;
    e->half[last ^ 1].width = 0;
    change_degree(e, e->half[last].to, -1);
    const double pivot = e->half[last].width * rest;
    return pivot > 0 ? rest * rest / pivot : 0;
}

// Neighbours by when they are eliminated: solving then goes through memory in order.
static void renumber(struct sampled_factor *factor)
{
    int *place = NEW_ARRAY(int, factor->n + 1);
    for (int step = 0; step < factor->n; step++)
        place[factor->pore[step]] = step;
    place[factor->n] = factor->n;
    for (int k = 0; k < factor->offset[factor->n]; k++)
        factor->neighbour[k] = place[factor->neighbour[k]];
    free(place);
}

struct sampled_factor *sampled_factor_make(const struct matrix *matrix)
{
    const int n = matrix->n;
    struct elimination e = begin(matrix);
    struct sampled_factor *factor = NEW_ARRAY(struct sampled_factor, 1);
    *factor = (struct sampled_factor){.n = n,
                                      .pore = NEW_ARRAY(int, n),
                                      .scale = NEW_ARRAY(double, n),
                                      .offset = NEW_ARRAY(int, n + 1),
                                      .work = NEW_ARRAY(double, n + 1)};
    size_t capacity = 5 * (size_t)n + 64;
    factor->neighbour = NEW_ARRAY(int, capacity);
    factor->share = NEW_ARRAY(float, capacity);
    for (int step = 0; step < n; step++) {
        const int i = take_lowest(&e), length = gather(&e, i);
        const int at = factor->offset[step];
        if ((size_t)at + (size_t)length > capacity) {
            capacity = 2 * capacity + (size_t)length;
            factor->neighbour = reallocate(factor->neighbour, capacity, sizeof(int));
            factor->share = reallocate(factor->share, capacity, sizeof(float));
        }
        factor->pore[step] = i;
        factor->scale[step] =
            eliminate(&e, length, &factor->neighbour[at], &factor->share[at]);
        factor->offset[step + 1] = at + length;
    }
    end(&e);
    renumber(factor);
    return factor;
}

void sampled_factor_free(struct sampled_factor *factor)
{
    if (!factor) return;
    free(factor->pore);
    free(factor->scale);
    free(factor->offset);
    free(factor->neighbour);
    free(factor->share);
    free(factor->work);
    free(factor);
}

void sampled_factor_apply(struct sampled_factor *factor, const double *b, double *x)
{
    const int n = factor->n;
    double *restrict y = factor->work;
    const int *neighbour = factor->neighbour;
    const float *share = factor->share;
    for (int step = 0; step < n; step++)
        y[step] = b[factor->pore[step]];
    for (int step = 0; step < n; step++) {
        const double here = y[step];
        for (int k = factor->offset[step]; k < factor->offset[step + 1]; k++)
            y[neighbour[k]] += (double)share[k] * here;
        y[step] = here * factor->scale[step];
    }
    y[n] = 0;
    for (int step = n - 1; step >= 0; step--) {
        double here = y[step];
        for (int k = factor->offset[step]; k < factor->offset[step + 1]; k++)
            here += (double)share[k] * y[neighbour[k]];
        y[step] = here;
    }
    for (int step = 0; step < n; step++)
        x[factor->pore[step]] = y[step];
}
