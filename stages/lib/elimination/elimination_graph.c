// SPDX-License-Identifier: GPL-3.0-or-later
// The graph of elimination_graph.h: each vertex has a row of edges with spare room. A
// row that is full moves to the end of the array with twice the room. Compacting drops
// eliminated vertices and gaps, so that neighbours lie near each other in memory again.
// weight = sum of parallel conductances / max_weight, in single precision.
#include "elimination_graph.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

enum { SPARE = 3 }; // edges that a vertex may gain before its row moves
enum { HUB = 64 };  // a vertex with more edges is a hub

static int find(const struct half_edge *half, int count, int to)
{
    int k = 0;
    while (k < count && half[k].to != to)
        k++;
    return k;
}

// Rows in the making. PLACE (n + n_kept + 1) of each neighbour in the row, once there.
struct rows {
    struct elimination_graph *graph;
    int *place;
};

static struct rows rows_init(struct elimination_graph *graph)
{
    struct rows rows = {graph, NEW_ARRAY(int, graph->n + graph->n_kept + 1)};
    graph->n_half = 0;
    return rows;
}

// Adds to the last row, in which FIRST is its first edge. Parallel edges are merged.
static void rows_add(const struct rows *rows, size_t first, int to, float weight)
{
    struct elimination_graph *graph = rows->graph;
    const size_t place = (size_t)rows->place[to];
    const bool is_there =
        place >= first && place < graph->n_half && graph->half[place].to == to;
    if (is_there) {
        graph->half[place].weight += weight;
        return;
    }
    rows->place[to] = (int)graph->n_half;
    graph->half[graph->n_half++] = (struct half_edge){weight, to};
}

static struct vertex rows_end(const struct rows *rows, size_t first)
{
    const int count = (int)(rows->graph->n_half - first);
    rows->graph->n_half += SPARE;
    return (struct vertex){(int)first, count, count + SPARE, false, false, count > HUB};
}

// Room for N vertices with COUNT edges, and for rows that move.
static void reserve_entries(struct elimination_graph *graph, int n, size_t count)
{
    const size_t least = count + SPARE * (size_t)n;
    graph->capacity = least + least / 4 + 64;
    graph->half = allocate_uncleared(graph->capacity, sizeof *graph->half);
}

struct elimination_graph elimination_graph_of(const struct conductance_matrix *matrix,
                                              int n_kept, double max_weight)
{
    const int n = matrix->n, ground = n + n_kept;
    struct elimination_graph graph = {.n = n,
                                      .n_kept = n_kept,
                                      .vertex = NEW_ARRAY(struct vertex, n),
                                      .index = NEW_ARRAY(int, ground + 1)};
    reserve_entries(&graph, n, (size_t)matrix->offset[n]);
    const struct rows rows = rows_init(&graph);
    for (int i = 0; i < n; i++) {
        const size_t first = graph.n_half;
        for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++)
            rows_add(&rows, first,
                     matrix->column[k] < ground ? matrix->column[k] : ground,
                     (float)(matrix->value[k] / max_weight));
        graph.vertex[i] = rows_end(&rows, first);
    }
    free(rows.place);
    for (int i = 0; i <= ground; i++)
        graph.index[i] = i;
    return graph;
}

void elimination_graph_free(struct elimination_graph *graph)
{
    free(graph->vertex);
    free(graph->index);
    free(graph->half);
    free(graph->link);
    *graph = (struct elimination_graph){0};
}

// Moves the row of a vertex to the end, with twice the room.
static void move_row(struct elimination_graph *graph, struct vertex *vertex)
{
    vertex->capacity *= 2;
    if (graph->n_half + (size_t)vertex->capacity > graph->capacity) {
        graph->capacity = 2 * graph->capacity + (size_t)vertex->capacity;
        graph->half = reallocate(graph->half, graph->capacity, sizeof *graph->half);
    }
    memcpy(&graph->half[graph->n_half], &graph->half[vertex->first],
           (size_t)vertex->count * sizeof *graph->half);
    vertex->first = (int)graph->n_half;
    graph->n_half += (size_t)vertex->capacity;
}

// Between given places, each pair once.
static void add_link(struct elimination_graph *graph, int at, int to, float weight)
{
    if (to <= at) return;
    GROW_ARRAY(graph->link, graph->n_link, graph->link_capacity);
    graph->link[graph->n_link++] =
        (struct link){{graph->index[at], graph->index[to]}, (double)weight};
}

static void add_weight(struct elimination_graph *graph, int at, int to, float weight)
{
    if (at >= graph->n) {
        add_link(graph, at, to, weight);
        return;
    }
    struct vertex *vertex = &graph->vertex[at];
    struct half_edge *half = &graph->half[vertex->first];
    const int k = vertex->is_hub ? vertex->count : find(half, vertex->count, to);
    if (k < vertex->count) {
        half[k].weight += weight;
        return;
    }
    if (vertex->count == vertex->capacity) move_row(graph, vertex);
    graph->half[vertex->first + vertex->count++] = (struct half_edge){weight, to};
}

void elimination_graph_remove_edge(struct elimination_graph *graph, int at,
                                   int eliminated)
{
    if (at >= graph->n) return;
    struct vertex *vertex = &graph->vertex[at];
    if (vertex->is_hub) return;
    struct half_edge *half = &graph->half[vertex->first];
    half[find(half, vertex->count, eliminated)] = half[vertex->count - 1];
    vertex->count--;
}

void elimination_graph_replace_edge(struct elimination_graph *graph, int at,
                                    int eliminated, int other, float weight)
{
    elimination_graph_remove_edge(graph, at, eliminated);
    add_weight(graph, at, other, weight);
    add_weight(graph, other, at, weight);
}

void elimination_graph_compact(struct elimination_graph *graph)
{
    const struct elimination_graph old = *graph;
    int *number = NEW_ARRAY(int, old.n + old.n_kept + 1);
    size_t count = 0;
    graph->n = 0;
    for (int i = 0; i < old.n; i++) {
        number[i] = old.vertex[i].eliminated ? -1 : graph->n++;
        count += old.vertex[i].eliminated ? 0 : (size_t)old.vertex[i].count;
    }
    for (int k = 0; k <= old.n_kept; k++)
        number[old.n + k] = graph->n + k;
    reserve_entries(graph, graph->n, count);
    const struct rows rows = rows_init(graph);
    for (int i = 0; i < old.n; i++) {
        const struct vertex from = old.vertex[i];
        if (from.eliminated) continue;
        const size_t first = graph->n_half;
        for (int k = 0; k < from.count; k++) {
            const struct half_edge half = old.half[from.first + k];
            if (number[half.to] >= 0)
                rows_add(&rows, first, number[half.to], half.weight);
        }
        graph->vertex[number[i]] = rows_end(&rows, first);
        graph->index[number[i]] = old.index[i];
    }
    for (int k = 0; k <= old.n_kept; k++)
        graph->index[graph->n + k] = old.index[old.n + k];
    free(rows.place);
    free(old.half);
    free(number);
}
