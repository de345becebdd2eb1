// SPDX-License-Identifier: GPL-3.0-or-later
// With the solution's levels u, the site from which i gets most is
//     argmax over j of conductance_ij (u_j - u_i),   u_j > u_i,
// and following these leads to a source. Sites to which nothing flows (films without an
// end that evaporates), or no more than the error of the solution, belong to the basin
// beside them. Clusters of a basin wait in a heap, by their gaps
//     gap = u - least,
// 0 at the source; it has the least gap at any time, and levels have fallen by that.
// All that are held have a gap of 0 at first: of these gas enters one before another.
// While a single source feeds all films and they have no resistance, this is exact.
#include "film_basins.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Sites less below their source than this part of its level are not told from it: that
// films bring a thousand times more is as if they had no resistance.
static const double LEAST_DROP = 1e-3;

struct waiting {
    double gap;
    int turn, cluster;
};

// A node that films reach, and what it evaporates.
struct end {
    double level, evaporation;
    int basin;
};

struct basin {
    double highest;    // level of the source, when found
    double admittance; // what sites get over how far they are below it, added up
    double fall;       // of levels
    int end, last_end; // ENDs, the lowest level first; before END levels are 0
    int n, capacity;
    struct waiting *heap; // (n) least gap on top; outdated ones stay
};

struct film_basins {
    int n, capacity, n_place, n_cluster;
    struct basin *basin; // (n)
    int *of;             // (n_place)
    int n_end, end_capacity;
    struct end *end;
    double failing; // what ends at level 0 evaporate
    double *gap;    // (n_cluster)
    int *turn;      // (n_cluster)
};

struct film_basins *film_basins_create(int n_place, int n_cluster)
{
    struct film_basins *basins = NEW_ARRAY(struct film_basins, 1);
    *basins = (struct film_basins){.n_place = n_place,
                                   .n_cluster = n_cluster,
                                   .of = NEW_ARRAY(int, n_place),
                                   .gap = NEW_ARRAY(double, n_cluster),
                                   .turn = NEW_ARRAY(int, n_cluster)};
    for (int p = 0; p < n_place; p++)
        basins->of[p] = -1;
    return basins;
}

static void clear(struct film_basins *basins)
{
    for (int b = 0; b < basins->n; b++)
        free(basins->basin[b].heap);
    basins->n = basins->n_end = 0;
    basins->failing = 0;
    for (int p = 0; p < basins->n_place; p++)
        basins->of[p] = -1;
}

void film_basins_free(struct film_basins *basins)
{
    if (!basins) return;
    clear(basins);
    free(basins->basin);
    free(basins->of);
    free(basins->gap);
    free(basins->turn);
    free(basins->end);
    free(basins);
}

// --- heaps -------------------------------------------------------------------------

static bool is_before(const struct waiting *a, const struct waiting *b)
{
    if (a->gap < b->gap || b->gap < a->gap) return a->gap < b->gap;
    return a->turn != b->turn ? a->turn < b->turn : a->cluster < b->cluster;
}

static void push(struct basin *basin, struct waiting new)
{
    GROW_ARRAY(basin->heap, basin->n, basin->capacity);
    int at = basin->n++;
    for (; at > 0 && is_before(&new, &basin->heap[(at - 1) / 2]); at = (at - 1) / 2)
        basin->heap[at] = basin->heap[(at - 1) / 2];
    basin->heap[at] = new;
}

static void pop(struct basin *basin)
{
    const struct waiting last = basin->heap[--basin->n];
    int at = 0;
    for (int next = 1; next < basin->n; at = next, next = 2 * at + 1) {
        if (next + 1 < basin->n &&
            is_before(&basin->heap[next + 1], &basin->heap[next]))
            next++;
        if (!is_before(&basin->heap[next], &last)) break;
        basin->heap[at] = basin->heap[next];
    }
    basin->heap[at] = last;
}

// --- finding -----------------------------------------------------------------------

// The site from which I gets most, more than NOISE; -1: from none.
static int upstream(const struct film_flow *flow, double noise, int i)
{
    const struct conductance_matrix *matrix = flow->matrix;
    double most = noise;
    int best = -1;
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
        const int j = matrix->column[k];
        const double inflow =
            matrix->value[k] * compensated_difference(flow->level[j], flow->level[i]);
        if (!(inflow > most)) continue;
        most = inflow;
        best = j;
    }
    return best;
}

// Levels rise along the way, so it ends. BASIN (n) is -2 where not yet known, and
// becomes -1 where the way ends without a source.
static void follow(const struct film_flow *flow, double noise, int from, int *up,
                   int *basin)
{
    int end = from;
    while (basin[end] == -2 && (up[end] = upstream(flow, noise, end)) >= 0)
        end = up[end];
    const int found = basin[end] == -2 ? -1 : basin[end];
    for (int i = from; i != end; i = up[i])
        basin[i] = found;
    basin[end] = found;
}

// The site with a basin that films join best to site I; -1: none.
static int best_joined(const struct conductance_matrix *matrix, const int *basin, int i)
{
    double most = 0;
    int best = -1;
    for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
        const int j = matrix->column[k];
        if (basin[j] < 0 || !(matrix->value[k] > most)) continue;
        most = matrix->value[k];
        best = j;
    }
    return best;
}

// Sites without a basin get the one beside them, from all sides at once, whatever their
// numbers.
static void adopt(const struct conductance_matrix *matrix, int *basin)
{
    int *queue = NEW_ARRAY(int, matrix->n), *found = NEW_ARRAY(int, matrix->n);
    bool *queued = NEW_ARRAY(bool, matrix->n);
    int n = 0;
    for (int i = 0; i < matrix->n; i++) {
        queued[i] = basin[i] >= 0;
        if (queued[i]) queue[n++] = i;
    }
    for (int first = 0, end = n; first < end; first = end, end = n) {
        for (int next = first; next < end; next++)
            for (int k = matrix->offset[queue[next]];
                 k < matrix->offset[queue[next] + 1]; k++) {
                const int j = matrix->column[k];
                if (!queued[j]) queue[n++] = j;
                queued[j] = true;
            }
        for (int next = end; next < n; next++)
            found[queue[next]] = basin[best_joined(matrix, basin, queue[next])];
        for (int next = end; next < n; next++)
            basin[queue[next]] = found[queue[next]];
    }
    free(queue);
    free(found);
    free(queued);
}

// A site that gets INFLOW, below 0 if it gives.
static void admit(struct basin *basin, double inflow, double level)
{
    if (!(inflow > 0)) return;
    const double drop = fmax(basin->highest - level, LEAST_DROP * basin->highest);
    basin->admittance += inflow / drop;
}

static void enter(struct film_basins *basins, const struct film_flow *flow, int i,
                  int turn, int b)
{
    const int place = flow->place[i];
    const double level = compensated_value(flow->level[i]);
    basins->of[place] = b;
    admit(&basins->basin[b], film_flow_inflow(flow, i), level);
    if (place < basins->n_cluster)
        film_basins_set(basins, place, b, level - flow->least[i], turn);
    else if (!flow->held[i] && flow->taken[i] > 0) {
        GROW_ARRAY(basins->end, basins->n_end, basins->end_capacity);
        basins->end[basins->n_end++] = (struct end){level, flow->taken[i], b};
    }
}

static int rising_ends(const void *a, const void *b)
{
    const struct end *x = a, *y = b;
    if (x->basin != y->basin) return x->basin < y->basin ? -1 : 1;
    if (x->level < y->level || x->level > y->level) return x->level < y->level ? -1 : 1;
    return (x->evaporation > y->evaporation) - (x->evaporation < y->evaporation);
}

static void sort_ends(struct film_basins *basins)
{
    if (basins->n_end > 1)
        qsort(basins->end, (size_t)basins->n_end, sizeof *basins->end, rising_ends);
    for (int k = basins->n_end - 1; k >= 0; k--)
        basins->basin[basins->end[k].basin].end = k;
    for (int k = 0; k < basins->n_end; k++)
        basins->basin[basins->end[k].basin].last_end = k + 1;
}

void film_basins_find(struct film_basins *basins, const struct film_flow *flow,
                      double noise, const int *turn, int n_source, const int *source)
{
    const int n = flow->matrix->n;
    int *up = NEW_ARRAY(int, n), *of = NEW_ARRAY(int, n);
    clear(basins);
    for (int i = 0; i < n; i++)
        of[i] = -2;
    for (int b = 0; b < n_source; b++) {
        GROW_ARRAY(basins->basin, b, basins->capacity);
        basins->basin[basins->n++] =
            (struct basin){.highest = compensated_value(flow->level[source[b]])};
        of[source[b]] = b;
    }
    for (int i = 0; i < n; i++)
        if (of[i] == -2) follow(flow, noise, i, up, of);
    adopt(flow->matrix, of);
    for (int i = 0; i < n; i++)
        if (of[i] >= 0) enter(basins, flow, i, turn[i], of[i]);
    sort_ends(basins);
    free(up);
    free(of);
}

// --- between solutions -------------------------------------------------------------

int film_basins_of(const struct film_basins *basins, int place)
{
    return basins->of[place];
}

void film_basins_add_node(struct film_basins *basins, int place, int basin)
{
    basins->of[place] = basin;
}

double film_basins_highest(const struct film_basins *basins, int basin)
{
    return basins->basin[basin].highest;
}

double film_basins_capacity(const struct film_basins *basins, int basin)
{
    const struct basin *here = &basins->basin[basin];
    return here->admittance * fmax(0, here->highest - here->fall);
}

void film_basins_set(struct film_basins *basins, int cluster, int basin, double gap,
                     int turn)
{
    basins->of[cluster] = basin;
    basins->gap[cluster] = gap;
    basins->turn[cluster] = turn;
    if (basin >= 0) push(&basins->basin[basin], (struct waiting){gap, turn, cluster});
}

static bool is_outdated(const struct film_basins *basins, int b,
                        const struct waiting *waiting)
{
    return basins->of[waiting->cluster] != b ||
           basins->turn[waiting->cluster] != waiting->turn ||
           basins->gap[waiting->cluster] < waiting->gap ||
           basins->gap[waiting->cluster] > waiting->gap;
}

static void fall_to(struct film_basins *basins, struct basin *basin, double fall)
{
    for (; basin->end < basin->last_end && basins->end[basin->end].level < fall;
         basin->end++)
        basins->failing += basins->end[basin->end].evaporation;
    basin->fall = fall;
}

int film_basins_supplier(struct film_basins *basins, int b)
{
    struct basin *basin = &basins->basin[b];
    while (basin->n > 0 && is_outdated(basins, b, &basin->heap[0]))
        pop(basin);
    if (basin->n == 0) return -1;
    fall_to(basins, basin, basin->heap[0].gap);
    return basin->heap[0].cluster;
}

double film_basins_fall(const struct film_basins *basins, int place)
{
    return basins->of[place] >= 0 ? basins->basin[basins->of[place]].fall : 0;
}

double film_basins_height(const struct film_basins *basins, int cluster)
{
    return basins->gap[cluster] - basins->basin[basins->of[cluster]].fall;
}

double film_basins_failing(const struct film_basins *basins)
{
    return basins->failing;
}

int film_basins_count(const struct film_basins *basins)
{
    return basins->n;
}

// --- state -------------------------------------------------------------------------

// Each basin has the range of its ends, so the basin of an end is not written.
static void ends_state(struct film_basins *basins, struct checkpoint_stream *stream)
{
    int64_t n = basins->n_end;
    stream_count(stream, &n);
    basins->end = stream_room(stream, basins->end, n, sizeof *basins->end);
    if (stream->restoring) basins->n_end = basins->end_capacity = (int)n;
    for (int k = 0; k < basins->n_end; k++) {
        stream_numbers(stream, &basins->end[k].level, 1);
        stream_numbers(stream, &basins->end[k].evaporation, 1);
    }
}

static void basin_state(struct basin *basin, int n_end, int n_cluster,
                        struct checkpoint_stream *stream)
{
    stream_numbers(stream, &basin->highest, 1);
    stream_numbers(stream, &basin->admittance, 1);
    stream_numbers(stream, &basin->fall, 1);
    stream_integer(stream, &basin->end, 0, n_end);
    stream_integer(stream, &basin->last_end, 0, n_end);
    int64_t n = basin->n;
    stream_count(stream, &n);
    basin->heap = stream_room(stream, basin->heap, n, sizeof *basin->heap);
    if (stream->restoring) basin->n = basin->capacity = (int)n;
    for (int k = 0; k < basin->n; k++) {
        stream_numbers(stream, &basin->heap[k].gap, 1);
        stream_integer(stream, &basin->heap[k].turn, 0, n_cluster - 1);
        stream_integer(stream, &basin->heap[k].cluster, 0, n_cluster - 1);
    }
}

void film_basins_state(struct film_basins *basins, struct checkpoint_stream *stream)
{
    int64_t n = basins->n;
    if (stream->restoring) clear(basins);
    stream_count(stream, &n);
    basins->basin = stream_room(stream, basins->basin, n, sizeof *basins->basin);
    if (stream->restoring) {
        memset(basins->basin, 0, (size_t)n * sizeof *basins->basin);
        basins->n = basins->capacity = (int)n;
    }
    ends_state(basins, stream);
    for (int b = 0; b < basins->n; b++)
        basin_state(&basins->basin[b], basins->n_end, basins->n_cluster, stream);
    stream_integers(stream, basins->of, basins->n_place, -1, basins->n - 1);
    stream_numbers(stream, basins->gap, basins->n_cluster);
    stream_integers(stream, basins->turn, basins->n_cluster, 0, basins->n_cluster - 1);
    stream_numbers(stream, &basins->failing, 1);
}
