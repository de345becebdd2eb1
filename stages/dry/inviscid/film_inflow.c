// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of a basin are sorted into classes by their levels over that of the source. If
// the capacity is less than the sum of needs, it goes to the highest class first; in
// the class where it ends all nodes get the same part of their needs:
//     need = evaporation, where films reached the node or have just come to it,
//            min(evaporation, inflow) where they ended,
//     own  = 1 - part need / evaporation.
#include "film_inflow.h"

#include "basics/memory.h"
#include "film_basins.h"
#include "film_supply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Films ended in class 0. Nodes to which they have come since, and clusters, are in the
// last class.
enum { CLASSES = 32 };

struct film_inflow {
    int n_node;
    double *found; // (n_node) what films brought
    int *class;    // (n_node)
    int n_basin;   // at most so many, for work
    double *part;  // (n_basin * CLASSES) first what each class needs
};

struct film_inflow *film_inflow_create(int n_node)
{
    struct film_inflow *inflow = NEW_ARRAY(struct film_inflow, 1);
    *inflow = (struct film_inflow){.n_node = n_node,
                                   .found = NEW_ARRAY(double, n_node),
                                   .class = NEW_ARRAY(int, n_node)};
    return inflow;
}

void film_inflow_free(struct film_inflow *inflow)
{
    if (!inflow) return;
    free(inflow->found);
    free(inflow->class);
    free(inflow->part);
    free(inflow);
}

static int class_of(const struct film_flow *flow, int i, double highest)
{
    if (flow->held[i]) return 0;
    const double part = compensated_value(flow->level[i]) / highest;
    return 1 + (int)((CLASSES - 3) * fmin(1, fmax(0, part)));
}

void film_inflow_find(const struct emptying_times *times, const struct film_flow *flow)
{
    struct film_inflow *inflow = times->films->inflow;
    const struct film_basins *basins = times->films->basins;
    const int n_throat = times->occupancy->network->n_throat;
    for (int i = 0; i < inflow->n_node; i++) {
        inflow->found[i] = 0;
        inflow->class[i] = CLASSES - 1;
    }
    for (int i = 0; i < flow->matrix->n; i++) {
        const int node = flow->place[i] - n_throat;
        const int basin = film_basins_of(basins, flow->place[i]);
        if (node < 0 || basin < 0) continue;
        inflow->found[node] = film_flow_inflow(flow, i);
        inflow->class[node] = class_of(flow, i, film_basins_highest(basins, basin));
    }
}

static void make_room(struct film_inflow *inflow, int n_basin)
{
    if (n_basin <= inflow->n_basin) return;
    inflow->n_basin = 2 * n_basin;
    const size_t n = (size_t)inflow->n_basin;
    inflow->part = reallocate(inflow->part, n * CLASSES, sizeof *inflow->part);
}

// The basin of the owner of timer K; -1: none.
static int basin_of(const struct emptying_times *times, int k)
{
    const int owner = times->owner[k];
    return owner < 0 ? -1 : film_basins_of(times->films->basins, owner);
}

static int class_at(const struct emptying_times *times, int place)
{
    const int node = place - times->occupancy->network->n_throat;
    return node < 0 ? CLASSES - 1 : times->films->inflow->class[node];
}

// What PLACE takes from films if they bring all that they can, of EVAPORATION.
static double need_of(const struct emptying_times *times, int place, double evaporation)
{
    const int node = place - times->occupancy->network->n_throat;
    if (node < 0) return (1 - times->films->own[place]) * evaporation;
    return class_at(times, place) > 0
               ? evaporation
               : fmin(evaporation, times->films->inflow->found[node]);
}

// PART (CLASSES) is what each class needs, and becomes the part of it that it gets.
static void share_capacity(double capacity, double *part)
{
    for (int c = CLASSES - 1; c >= 0; c--) {
        const double need = part[c];
        part[c] = need > capacity ? capacity / need : 1;
        capacity = fmax(0, capacity - need);
    }
}

// PART of each class of each basin.
static void find_parts(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const int n_basin = film_basins_count(films->basins);
    double *part = films->inflow->part;
    memset(part, 0, (size_t)n_basin * CLASSES * sizeof *part);
    for (int k = 0; k < times->n; k++) {
        const int b = basin_of(times, k), place = times->owner[k];
        if (b >= 0)
            part[b * CLASSES + class_at(times, place)] +=
                need_of(times, place, times->rate[k]);
    }
    for (int b = 0; b < n_basin; b++)
        share_capacity(film_basins_capacity(films->basins, b), part + b * CLASSES);
}

double film_inflow_limit(const struct emptying_times *times)
{
    struct film_supply *films = times->films;
    make_room(films->inflow, film_basins_count(films->basins));
    find_parts(times);
    double lack = 0;
    for (int k = 0; k < times->n; k++) {
        const int b = basin_of(times, k), place = times->owner[k];
        if (b < 0 || place < times->occupancy->network->n_throat) continue;
        if (!(times->rate[k] > 0)) continue;
        const int class = class_at(times, place);
        const double part = films->inflow->part[b * CLASSES + class];
        const double need = need_of(times, place, times->rate[k]);
        films->own[place] = 1 - part * need / times->rate[k];
        if (class == CLASSES - 1) lack += (1 - part) * need;
    }
    return lack;
}

void film_inflow_state(struct film_inflow *inflow, struct checkpoint_stream *stream)
{
    stream_numbers(stream, inflow->found, inflow->n_node);
    stream_integers(stream, inflow->class, inflow->n_node, 0, CLASSES - 1);
}
