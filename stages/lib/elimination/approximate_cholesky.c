// SPDX-License-Identifier: GPL-3.0-or-later
// An approximate factor L D L' of the balances of a network, as preconditioner (Kyng
// and Sachdeva 2016; Gao, Kyng and Spielman 2023).
//
// Elimination of vertex i with edge weights w_1 <= w_2 <= ... to its neighbours would
// leave an edge w_j w_k / sum w between each two of them. Instead, neighbour k gets one
// edge, to a neighbour `other` drawn among k+1 ... with probability w_other / (sum of
// those), of weight f (1 - f) `whole`, where `whole` is the sum of the remaining
// weights and f the part of k in it: its mean is that of elimination. `share` of k is
// its entry of L, `scale` of i is 1 / D_i.
//
// Vertices of low degree that are not neighbours are eliminated together, in rounds;
// rows of equal length form blocks, so that apply runs without branches. Entries are
// floats: the factor is approximate anyway, it stays symmetric, and memory traffic
// decides the speed. The random stream is fixed, so every run does the same.
#include "approximate_cholesky.h"

#include "basics/memory.h"
#include "elimination_graph.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

// The factor, in the order of elimination. Each vertex passes a share of what it holds
// to each of its neighbours.
struct approximate_cholesky {
    int n, n_kept;
    int *vertex;  // (n) in the order of elimination
    float *scale; // (n) what D divides by
    int n_block;
    struct block *block;
    int *neighbour; // by their places in that order; from n on: kept places, ground
    float *share;
    float *work; // (n+n_kept+1)
    int block_capacity;
    size_t n_entry, capacity;
};

// Rows of one length, of vertices none of which neighbours another: no row waits for
// another, and the length needs no lookup.
struct block {
    int end; // row after the last
    int length;
};

// The vertices that a round eliminates.
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
    int vertex, length;
    float scale;
    size_t first;
};

enum { MAX_DEGREE = 200 };

// SplitMix64: from 0 to 1.
static double random_uniform(uint64_t *stream)
{
    uint64_t z = *stream += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

// ---- elimination --------------------------------------------------------------------

static bool is_lighter(const struct half_edge *a, const struct half_edge *b)
{
    if (a->weight < b->weight || a->weight > b->weight) return a->weight < b->weight;
    return a->to < b->to;
}

// Lightest first, by insertion: there is nearly always only a handful.
static void sort(struct half_edge *half, int length)
{
    for (int k = 1; k < length; k++) {
        const struct half_edge here = half[k];
        int place = k;
        for (; place > 0 && is_lighter(&here, &half[place - 1]); place--)
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

// Eliminates vertex I. Its edges stay where they are while others are added.
static void eliminate(struct elimination_graph *graph, int i, struct round *round)
{
    const int first = graph->vertex[i].first, length = graph->vertex[i].count;
    reserve(round, length);
    sort(&graph->half[first], length);
    int *neighbour = &round->neighbour[round->n_entry];
    float *share = &round->share[round->n_entry];
    double sum = 0, rest = 1, last = 0;
    for (int k = 0; k < length; k++)
        round->sum[k] = sum += (double)graph->half[first + k].weight;
    double whole = sum;
    for (int k = 0; k < length; k++) {
        const struct half_edge half = graph->half[first + k];
        neighbour[k] = graph->index[half.to];
        if (half.to < graph->n) graph->vertex[half.to].neighbour_eliminated = true;
        last = (double)half.weight * rest;
        if (k + 1 == length) {
            share[k] = (float)rest;
            elimination_graph_remove_edge(graph, half.to, i);
            break;
        }
        const double f = last / whole;
        const double r =
            round->sum[k] + random_uniform(&round->stream) * (sum - round->sum[k]);
        const int other = search(round->sum, k + 1, length, r);
        share[k] = (float)(f * rest);
        elimination_graph_replace_edge(graph, half.to, i, graph->half[first + other].to,
                                       (float)(f * (1 - f) * whole));
        rest *= 1 - f;
        whole *= (1 - f) * (1 - f);
    }
    graph->vertex[i].eliminated = true;
    GROW_ARRAY(round->row, round->n_row, round->row_capacity);
    round->row[round->n_row++] =
        (struct row){graph->index[i], length,
                     last > 0 ? (float)(rest * rest / last) : 0, round->n_entry};
    round->n_entry += (size_t)length;
    if (length > round->longest) round->longest = length;
}

// The least degree that more than a third of the vertices do not exceed.
static int degree_limit(const struct elimination_graph *graph)
{
    int count[MAX_DEGREE] = {0}, sum = 0;
    for (int i = 0; i < graph->n; i++)
        if (graph->vertex[i].count < MAX_DEGREE) count[graph->vertex[i].count]++;
    for (int degree = 0; degree < MAX_DEGREE; degree++)
        if ((sum += count[degree]) > graph->n / 3) return degree;
    return INT_MAX;
}

static void eliminate_independent(struct elimination_graph *graph, struct round *round)
{
    const int limit = degree_limit(graph);
    round->n_row = round->longest = 0;
    round->n_entry = 0;
    for (int i = 0; i < graph->n; i++)
        if (!graph->vertex[i].neighbour_eliminated && graph->vertex[i].count <= limit)
            eliminate(graph, i, round);
    elimination_graph_compact(graph);
}

// ---- the factor ---------------------------------------------------------------------

static void reserve_entries(struct approximate_cholesky *factor, size_t more)
{
    if (factor->n_entry + more <= factor->capacity) return;
    factor->capacity = factor->capacity + factor->capacity / 4 + more;
    factor->neighbour = reallocate(factor->neighbour, factor->capacity, sizeof(int));
    factor->share = reallocate(factor->share, factor->capacity, sizeof(float));
}

// Appends the rows of a round, short ones first. Returns the new number of rows.
static int append(struct approximate_cholesky *factor, int n, const struct round *round,
                  double max_weight)
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
    reserve_entries(factor, round->n_entry);
    for (int k = 0; k < round->n_row; k++) {
        const struct row *row = &round->row[order[k]];
        factor->vertex[n + k] = row->vertex;
        factor->scale[n + k] = (float)((double)row->scale / max_weight);
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

// Renumbers neighbours by the order of elimination: solving then runs through memory in
// order.
static void renumber(struct approximate_cholesky *factor)
{
    const int ground = factor->n + factor->n_kept;
    int *place = NEW_ARRAY(int, ground + 1);
    for (int step = 0; step < factor->n; step++)
        place[factor->vertex[step]] = step;
    for (int k = factor->n; k <= ground; k++)
        place[k] = k;
    for (size_t k = 0; k < factor->n_entry; k++)
        factor->neighbour[k] = place[factor->neighbour[k]];
    free(place);
}

static double max_conductance(const struct conductance_matrix *matrix)
{
    double max_weight = 0;
    for (int k = 0; k < matrix->offset[matrix->n]; k++)
        max_weight = fmax(max_weight, matrix->value[k]);
    return max_weight > 0 ? max_weight : 1;
}

struct approximate_cholesky *
approximate_cholesky_create_partly(const struct conductance_matrix *matrix, int n_kept,
                                   int *n_link, struct link **link)
{
    const int n = matrix->n;
    const double max_weight = max_conductance(matrix);
    struct elimination_graph graph = elimination_graph_of(matrix, n_kept, max_weight);
    struct approximate_cholesky *factor = NEW_ARRAY(struct approximate_cholesky, 1);
    *factor = (struct approximate_cholesky){.n = n,
                                            .n_kept = n_kept,
                                            .vertex = NEW_ARRAY(int, n),
                                            .scale = NEW_ARRAY(float, n),
                                            .work = NEW_ARRAY(float, n + n_kept + 1)};
    reserve_entries(factor, 5 * (size_t)n);
    struct round round = {0};
    reserve(&round, 1);
    for (int done = 0; graph.n > 0;) {
        eliminate_independent(&graph, &round);
        done = append(factor, done, &round, max_weight);
    }
    *n_link = graph.n_link;
    *link = graph.link;
    graph.link = NULL;
    for (int l = 0; l < *n_link; l++)
        (*link)[l].conductance *= max_weight;
    elimination_graph_free(&graph);
    free(round.row);
    free(round.neighbour);
    free(round.share);
    free(round.sum);
    renumber(factor);
    return factor;
}

struct approximate_cholesky *
approximate_cholesky_create(const struct conductance_matrix *matrix)
{
    int none;
    struct link *link;
    struct approximate_cholesky *factor =
        approximate_cholesky_create_partly(matrix, 0, &none, &link);
    free(link);
    return factor;
}

void approximate_cholesky_free(struct approximate_cholesky *factor)
{
    if (!factor) return;
    free(factor->vertex);
    free(factor->scale);
    free(factor->block);
    free(factor->neighbour);
    free(factor->share);
    free(factor->work);
    free(factor);
}

void approximate_cholesky_reduce(struct approximate_cholesky *factor, const double *b,
                                 double *kept)
{
    const int n = factor->n;
    float *restrict y = factor->work;
    const int *neighbour = factor->neighbour;
    const float *share = factor->share;
    for (int step = 0; step < n; step++)
        y[step] = (float)b[factor->vertex[step]];
    for (int k = n; k < n + factor->n_kept; k++)
        y[k] = (float)b[k];
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
    for (int k = 0; k < factor->n_kept; k++)
        kept[k] = (double)y[n + k];
}

void approximate_cholesky_extend(struct approximate_cholesky *factor,
                                 const double *kept, double *x)
{
    const int n = factor->n;
    float *restrict y = factor->work;
    const int *neighbour = factor->neighbour + factor->n_entry;
    const float *share = factor->share + factor->n_entry;
    for (int k = 0; k < factor->n_kept; k++)
        y[n + k] = (float)(x[n + k] = kept[k]);
    y[n + factor->n_kept] = 0;
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
        x[factor->vertex[step]] = (double)y[step];
}

void approximate_cholesky_apply(struct approximate_cholesky *factor, const double *b,
                                double *x)
{
    double none[1] = {0};
    approximate_cholesky_reduce(factor, b, none);
    approximate_cholesky_extend(factor, none, x);
}
