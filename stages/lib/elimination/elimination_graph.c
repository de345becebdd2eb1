// SPDX-License-Identifier: GPL-3.0-or-later
#include "elimination_graph.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

enum { SPARE = 3 }; // throats that a pore may gain before its row moves

static int find(const struct half_throat *half, int count, int to)
{
    int k = 0;
    while (k < count && half[k].to != to)
        k++;
    return k;
}

// The row of pore I of the matrix, parallel throats as one.
static int copy_row(const struct matrix *matrix, int i, double widest,
                    struct half_throat *half)
{
    int count = 0;
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
        const int to = matrix->column[k] < matrix->n ? matrix->column[k] : matrix->n;
        const int place = find(half, count, to);
        if (place == count) half[count++] = (struct half_throat){0, to};
        half[place].width += (float)(matrix->value[k] / widest);
    }
    return count;
}

// For N pores with COUNT throats, and for what moves.
static void make_room(struct shrinking_graph *graph, int n, size_t count)
{
    const size_t least = count + SPARE * (size_t)n;
    graph->capacity = least + least / 4 + 64;
    graph->half = allocate_uncleared(graph->capacity, sizeof *graph->half);
}

struct shrinking_graph graph_of(const struct matrix *matrix, double widest)
{
    const int n = matrix->n;
    struct shrinking_graph graph = {.n = n,
                                    .pore = NEW_ARRAY(struct pore_throats, n),
                                    .name = NEW_ARRAY(int, n + 1)};
    make_room(&graph, n, (size_t)matrix->offset[n]);
    for (int i = 0; i < n; i++) {
        const int first = (int)graph.n_half;
        const int count = copy_row(matrix, i, widest, &graph.half[first]);
        graph.pore[i] =
            (struct pore_throats){first, count, count + SPARE, false, false};
        graph.n_half += (size_t)count + SPARE;
        graph.name[i] = i;
    }
    graph.name[n] = n;
    return graph;
}

void graph_free(struct shrinking_graph *graph)
{
    free(graph->pore);
    free(graph->name);
    free(graph->half);
    *graph = (struct shrinking_graph){0};
}

// The row of a pore to the end, with twice the room.
static void move_row(struct shrinking_graph *graph, struct pore_throats *pore)
{
    pore->room *= 2;
    if (graph->n_half + (size_t)pore->room > graph->capacity) {
        graph->capacity = 2 * graph->capacity + (size_t)pore->room;
        graph->half = reallocate(graph->half, graph->capacity, sizeof *graph->half);
    }
    memcpy(&graph->half[graph->n_half], &graph->half[pore->first],
           (size_t)pore->count * sizeof *graph->half);
    pore->first = (int)graph->n_half;
    graph->n_half += (size_t)pore->room;
}

static void add_width(struct shrinking_graph *graph, int at, int to, float width)
{
    if (at == graph->n) return;
    struct pore_throats *pore = &graph->pore[at];
    struct half_throat *half = &graph->half[pore->first];
    const int k = find(half, pore->count, to);
    if (k < pore->count) {
        half[k].width += width;
        return;
    }
    if (pore->count == pore->room) move_row(graph, pore);
    graph->half[pore->first + pore->count++] = (struct half_throat){width, to};
}

void graph_cut(struct shrinking_graph *graph, int at, int gone)
{
    if (at == graph->n) return;
    struct pore_throats *pore = &graph->pore[at];
    struct half_throat *half = &graph->half[pore->first];
    half[find(half, pore->count, gone)] = half[pore->count - 1];
    pore->count--;
}

void graph_replace(struct shrinking_graph *graph, int at, int gone, int other,
                   float width)
{
    graph_cut(graph, at, gone);
    add_width(graph, at, other, width);
    add_width(graph, other, at, width);
}

void graph_pack(struct shrinking_graph *graph)
{
    const struct shrinking_graph old = *graph;
    int *number = NEW_ARRAY(int, old.n + 1);
    size_t count = 0;
    graph->n = 0;
    for (int i = 0; i < old.n; i++) {
        number[i] = graph->n;
        graph->n += !old.pore[i].gone;
        count += old.pore[i].gone ? 0 : (size_t)old.pore[i].count;
    }
    number[old.n] = graph->n;
    make_room(graph, graph->n, count);
    graph->n_half = 0;
    for (int i = 0; i < old.n; i++) {
        const struct pore_throats from = old.pore[i];
        if (from.gone) continue;
        const int first = (int)graph->n_half;
        for (int k = 0; k < from.count; k++) {
            const struct half_throat half = old.half[from.first + k];
            graph->half[first + k] = (struct half_throat){half.width, number[half.to]};
        }
        graph->pore[number[i]] =
            (struct pore_throats){first, from.count, from.count + SPARE, false, false};
        graph->name[number[i]] = old.name[i];
        graph->n_half += (size_t)from.count + SPARE;
    }
    graph->name[graph->n] = old.name[old.n];
    free(old.half);
    free(number);
}
