// SPDX-License-Identifier: GPL-3.0-or-later
// What films do at each step that is recorded. Depth of a node: the least distance to
// an open wall of the box,
//     depth = min over open walls of |x - wall|,   0 for nodes outside,
// and over the wet nodes that films reach
//     depth   = mean of their depths,   deepest = the largest,   0 without such nodes
//     evaporation = that of films, in scaled units, times RATE, kg/s.
// Depths of nodes are found at the first step with films, since every step asks for
// them.
#include "film_history.h"

#include "basics/memory.h"
#include "dry/inviscid/film_supply.h"

#include <math.h>
#include <stdlib.h>

struct film_history *film_history_create(void)
{
    return NEW_ARRAY(struct film_history, 1);
}

void film_history_free(struct film_history *films)
{
    if (!films) return;
    free(films->evaporation);
    free(films->depth);
    free(films->deepest);
    free(films->depth_of_node);
    free(films);
}

static double depth_of(const struct network *network, int node, unsigned open_walls)
{
    double depth = INFINITY;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        if (!(open_walls >> wall & 1)) continue;
        const struct vector side =
            wall % 2 ? network->packing.upper : network->packing.lower;
        const double x = component(network->node_position[node], wall / 2);
        const double inwards = x - component(side, wall / 2);
        depth = fmin(depth, wall % 2 ? -inwards : inwards);
    }
    return fmax(depth, 0);
}

// Once, as every step asks for those of all nodes that films reach.
static void find_depths(struct film_history *films, const struct network *network,
                        unsigned open_walls)
{
    films->depth_of_node = NEW_ARRAY(double, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        films->depth_of_node[i] = depth_of(network, i, open_walls);
}

// The arrays share one capacity: the first two grow by a copy of it.
static void make_room(struct film_history *films)
{
    int first = films->capacity, second = films->capacity;
    GROW_ARRAY(films->evaporation, films->n, first);
    GROW_ARRAY(films->depth, films->n, second);
    GROW_ARRAY(films->deepest, films->n, films->capacity);
}

void film_history_add(struct film_history *films, const struct emptying_times *times,
                      unsigned open_walls, double rate)
{
    const struct occupancy *occupancy = times->occupancy;
    if (times->films && !films->depth_of_node)
        find_depths(films, occupancy->network, open_walls);
    int reached = 0;
    double sum = 0, deepest = 0;
    for (int k = 0; times->films && k < occupancy->n_wet; k++) {
        if (!times->films->reached[occupancy->wet[k]]) continue;
        const double depth = films->depth_of_node[occupancy->wet[k]];
        reached++;
        sum += depth;
        deepest = depth > deepest ? depth : deepest;
    }
    make_room(films);
    films->evaporation[films->n] = times->films ? times->films->evaporation * rate : 0;
    films->depth[films->n] = reached > 0 ? sum / reached : 0;
    films->deepest[films->n++] = deepest;
}

void film_history_state(struct film_history *films, struct checkpoint_stream *stream)
{
    int64_t n = films->n;
    stream_count(stream, &n);
    films->evaporation = stream_room(stream, films->evaporation, n, sizeof(double));
    films->depth = stream_room(stream, films->depth, n, sizeof(double));
    films->deepest = stream_room(stream, films->deepest, n, sizeof(double));
    if (stream->restoring) films->n = films->capacity = (int)n;
    stream_numbers(stream, films->evaporation, n);
    stream_numbers(stream, films->depth, n);
    stream_numbers(stream, films->deepest, n);
    stream_numbers(stream, &films->evaporated, 1);
}
