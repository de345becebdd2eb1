// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate_cholesky.h"

#include "basics/memory.h"
#include "elimination_graph.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

// L D L' in the order of elimination. A pore passes a share of what it holds to each of
// its neighbours. Numbers are rounded to floats: the factor is only near Cholesky's
// anyway, it stays symmetric, and bytes are time.
struct sampled_factor {
    int n;
    int *pore;    // (n) in the order of elimination
    float *scale; // (n) what D divides by
    int n_block;
    struct block *block;
    int *neighbour; // by their places in that order; n: where the pressure is given
    float *share;
    float *work; // (n+1)
    int block_capacity;
    size_t n_entry, capacity;
};

// Rows of one length, of pores none of which is another's neighbour: to go through them
// takes no guess of where a row ends, and none waits for another.
struct block {
    int end; // row after the last
    int length;
};

// What a round takes out.
struct round {
    int n_row, longest;
    struct row *row;
    int *neighbour;
    float *share;
    double *sum; // of the widths in a row
    int row_capacity, sum_capacity;
    size_t n_entry, capacity;
    uint64_t stream; // of the draws
};

struct row {
    int pore, length;
    float scale;
    size_t first;
};

enum { MOST_DEGREE = 200 };

// SplitMix64: from 0 to 1.
static double draw(uint64_t *stream)
{
    uint64_t z = *stream += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

// ---- elimination --------------------------------------------------------------------

static bool is_narrower(const struct half_throat *a, const struct half_throat *b)
{
    if (a->width < b->width || a->width > b->width) return a->width < b->width;
    return a->to < b->to;
}

// The narrowest first; nearly always a handful, so by insertion.
static void sort(struct half_throat *half, int length)
{
    for (int k = 1; k < length; k++) {
        const struct half_throat here = half[k];
        int place = k;
        for (; place > 0 && is_narrower(&here, &half[place - 1]); place--)
            half[place] = half[place - 1];
        half[place] = here;
    }
}

static void reserve(struct round *round, int length)
{
    if (round->n_entry + (size_t)length > round->capacity) {
        round->capacity = 2 * round->capacity + (size_t)length;
        round->neighbour = reallocate(round->neighbour, round->capacity, sizeof(int));
        round->share = reallocate(round->share, round->capacity, sizeof(float));
    }
    if (length > round->sum_capacity) {
        round->sum_capacity = 2 * length;
        round->sum =
            reallocate(round->sum, (size_t)round->sum_capacity, sizeof *round->sum);
    }
}

// The first place from FROM on where the sum is above R.
static int search(const double *sum, int from, int length, double r)
{
    while (from < length - 1 && !(sum[from] > r))
        from++;
    return from;
}

// Takes out pore I. Its throats stay where they are while others are added.
static void eliminate(struct shrinking_graph *graph, int i, struct round *round)
{
    const int first = graph->pore[i].first, length = graph->pore[i].count;
    reserve(round, length);
    sort(&graph->half[first], length);
    int *neighbour = &round->neighbour[round->n_entry];
    float *share = &round->share[round->n_entry];
    double sum = 0, rest = 1, last = 0;
    for (int k = 0; k < length; k++)
        round->sum[k] = sum += (double)graph->half[first + k].width;
    double whole = sum;
    for (int k = 0; k < length; k++) {
        const struct half_throat half = graph->half[first + k];
        neighbour[k] = graph->name[half.to];
        if (half.to < graph->n) graph->pore[half.to].beside = true;
        last = (double)half.width * rest;
        if (k + 1 == length) {
            share[k] = (float)rest;
            graph_cut(graph, half.to, i);
            break;
        }
        const double f = last / whole;
        const double r = round->sum[k] + draw(&round->stream) * (sum - round->sum[k]);
        const int other = search(round->sum, k + 1, length, r);
        share[k] = (float)(f * rest);
        graph_replace(graph, half.to, i, graph->half[first + other].to,
                      (float)(f * (1 - f) * whole));
        rest *= 1 - f;
        whole *= (1 - f) * (1 - f);
    }
    graph->pore[i].gone = true;
    GROW_ARRAY(round->row, round->n_row, round->row_capacity);
    round->row[round->n_row++] =
        (struct row){graph->name[i], length, last > 0 ? (float)(rest * rest / last) : 0,
                     round->n_entry};
    round->n_entry += (size_t)length;
    if (length > round->longest) round->longest = length;
}

// So many throats that a third of the pores has no more.
static int few_throats(const struct shrinking_graph *graph)
{
    int count[MOST_DEGREE] = {0}, sum = 0;
    for (int i = 0; i < graph->n; i++)
        if (graph->pore[i].count < MOST_DEGREE) count[graph->pore[i].count]++;
    for (int degree = 0; degree < MOST_DEGREE; degree++)
        if ((sum += count[degree]) > graph->n / 3) return degree;
    return INT_MAX;
}

static void take_out(struct shrinking_graph *graph, struct round *round)
{
    const int few = few_throats(graph);
    round->n_row = round->longest = 0;
    round->n_entry = 0;
    for (int i = 0; i < graph->n; i++)
        if (!graph->pore[i].beside && graph->pore[i].count <= few)
            eliminate(graph, i, round);
    graph_pack(graph);
}

// ---- the factor ---------------------------------------------------------------------

static void make_room(struct sampled_factor *factor, size_t more)
{
    if (factor->n_entry + more <= factor->capacity) return;
    factor->capacity = factor->capacity + factor->capacity / 4 + more;
    factor->neighbour = reallocate(factor->neighbour, factor->capacity, sizeof(int));
    factor->share = reallocate(factor->share, factor->capacity, sizeof(float));
}

// The rows of a round after those there are, the short ones first. Returns how many
// rows there are then.
static int append(struct sampled_factor *factor, int n, const struct round *round,
                  double widest)
{
    int *begin = NEW_ARRAY(int, round->longest + 2),
        *order = NEW_ARRAY(int, round->n_row);
    for (int k = 0; k < round->n_row; k++)
        begin[round->row[k].length + 1]++;
    for (int length = 0, end = n; length <= round->longest; length++) {
        const int count = begin[length + 1];
        begin[length + 1] = begin[length] + count;
        end += count;
        if (!count) continue;
        GROW_ARRAY(factor->block, factor->n_block, factor->block_capacity);
        factor->block[factor->n_block++] = (struct block){end, length};
    }
    for (int k = 0; k < round->n_row; k++)
        order[begin[round->row[k].length]++] = k;
    make_room(factor, round->n_entry);
    for (int k = 0; k < round->n_row; k++) {
        const struct row *row = &round->row[order[k]];
        factor->pore[n + k] = row->pore;
        factor->scale[n + k] = (float)((double)row->scale / widest);
        for (int m = 0; m < row->length; m++, factor->n_entry++) {
            factor->neighbour[factor->n_entry] =
                round->neighbour[row->first + (size_t)m];
            factor->share[factor->n_entry] = round->share[row->first + (size_t)m];
        }
    }
    free(begin);
    free(order);
    return n + round->n_row;
}

// Neighbours by when they are eliminated: solving then goes through memory in order.
static void renumber(struct sampled_factor *factor)
{
    int *place = NEW_ARRAY(int, factor->n + 1);
    for (int step = 0; step < factor->n; step++)
        place[factor->pore[step]] = step;
    place[factor->n] = factor->n;
    for (size_t k = 0; k < factor->n_entry; k++)
        factor->neighbour[k] = place[factor->neighbour[k]];
    free(place);
}

static double widest_throat(const struct matrix *matrix)
{
    double widest = 0;
    for (int k = 0; k < matrix->offset[matrix->n]; k++)
        widest = fmax(widest, matrix->value[k]);
    return widest > 0 ? widest : 1;
}

struct sampled_factor *sampled_factor_make(const struct matrix *matrix)
{
    const int n = matrix->n;
    const double widest = widest_throat(matrix);
    struct shrinking_graph graph = graph_of(matrix, widest);
    struct sampled_factor *factor = NEW_ARRAY(struct sampled_factor, 1);
    *factor = (struct sampled_factor){.n = n,
                                      .pore = NEW_ARRAY(int, n),
                                      .scale = NEW_ARRAY(float, n),
                                      .work = NEW_ARRAY(float, n + 1)};
    make_room(factor, 5 * (size_t)n);
    struct round round = {0};
    for (int done = 0; graph.n > 0;) {
        take_out(&graph, &round);
        done = append(factor, done, &round, widest);
    }
    graph_free(&graph);
    free(round.row);
    free(round.neighbour);
    free(round.share);
    free(round.sum);
    renumber(factor);
    return factor;
}

void sampled_factor_free(struct sampled_factor *factor)
{
    if (!factor) return;
    free(factor->pore);
    free(factor->scale);
    free(factor->block);
    free(factor->neighbour);
    free(factor->share);
    free(factor->work);
    free(factor);
}

void sampled_factor_apply(struct sampled_factor *factor, const double *b, double *x)
{
    const int n = factor->n;
    float *restrict y = factor->work;
    const int *neighbour = factor->neighbour;
    const float *share = factor->share;
    for (int step = 0; step < n; step++)
        y[step] = (float)b[factor->pore[step]];
    for (int block = 0, step = 0; block < factor->n_block; block++) {
        const int length = factor->block[block].length;
        for (; step < factor->block[block].end; step++) {
            const float here = y[step];
            for (int k = 0; k < length; k++)
                y[neighbour[k]] += share[k] * here;
            y[step] = here * factor->scale[step];
            neighbour += length;
            share += length;
        }
    }
    y[n] = 0;
    for (int block = factor->n_block - 1, step = n; block >= 0; block--) {
        const int length = factor->block[block].length;
        const int begin = block ? factor->block[block - 1].end : 0;
        while (step > begin) {
            neighbour -= length;
            share -= length;
            float here = y[--step];
            for (int k = 0; k < length; k++)
                here += share[k] * y[neighbour[k]];
            y[step] = here;
        }
    }
    for (int step = 0; step < n; step++)
        x[factor->pore[step]] = (double)y[step];
}
