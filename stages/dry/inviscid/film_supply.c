// SPDX-License-Identifier: GPL-3.0-or-later
// When flows in films are found (film_supply_find.c), and what reservoirs lose between
// two solutions:
//     scale = sum of (1 - own) E / sum of drawn.
#include "film_supply_internal.h"

#include "basics/memory.h"
#include "film_balance.h"
#include "film_basins.h"
#include "film_inflow.h"
#include "geometry/space_filling_curve.h"

#include <math.h>
#include <stdlib.h>

// Flows are found again before the step is over once films may fail to bring so much of
// the drying rate, but not sooner than after such a part of the step.
static const double MOST_FAILING = 0.05, SHORTEST = 0.1;

struct film_supply *film_supply_create(const struct emptying_times *times)
{
    const struct network *network = times->occupancy->network;
    struct film_supply *films = NEW_ARRAY(struct film_supply, 1);
    *films = (struct film_supply){
        .own = NEW_ARRAY(double, times->n_place),
        .drawn = NEW_ARRAY(double, times->n_place),
        .source = NEW_ARRAY(int, network->n_throat),
        .reached = NEW_ARRAY(bool, network->n_node),
        .floats = NEW_ARRAY(bool, network->n_throat),
        .falls = NEW_ARRAY(bool, network->n_throat),
        .brought = NEW_ARRAY(double, network->n_throat),
        .response = NEW_ARRAY(double, network->n_throat),
        .level = NEW_ARRAY(struct compensated, times->n_place),
        .is_known = NEW_ARRAY(bool, times->n_place),
        .evaporates = NEW_ARRAY(double, times->n_place),
        .curve = order_along_curve(network->n_node, network->node_position),
        .factor = film_factor_create(),
        .basins = film_basins_create(times->n_place, network->n_throat),
        .inflow = film_inflow_create(network->n_node),
        .scale = 1,
        .is_due = true};
    for (int p = 0; p < times->n_place; p++)
        films->own[p] = 1;
    return films;
}

void film_supply_free(struct film_supply *films)
{
    if (!films) return;
    free(films->own);
    free(films->drawn);
    free(films->source);
    free(films->reached);
    free(films->floats);
    free(films->falls);
    free(films->brought);
    free(films->response);
    free(films->level);
    free(films->is_known);
    free(films->evaporates);
    free(films->curve);
    film_factor_free(films->factor);
    film_basins_free(films->basins);
    film_inflow_free(films->inflow);
    free(films);
}

// What comes from other sources than was found fails at most where it is at risk.
static bool is_failing(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const double failing = fmin(films->stray, films->at_risk) + films->lack +
                           film_basins_failing(films->basins);
    return failing > MOST_FAILING * vapour_rate(&times->occupancy->vapour);
}

bool film_supply_is_due(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const double step = times->occupancy->film_law->step;
    const double fallen = films->saturation - film_saturation(times->occupancy);
    return films->is_due || !(step > 0) || fallen >= step ||
           (fallen >= SHORTEST * step && is_failing(times));
}

// --- rates -------------------------------------------------------------------------

// What clusters lose that have lost a throat since the solution.
static void update_falling(const struct emptying_times *times)
{
    struct film_supply *films = times->films;
    for (int k = 0; k < times->n; k++) {
        const int c = times->owner[k];
        if (c < 0 || c >= times->occupancy->network->n_throat || !films->falls[c])
            continue;
        const double height = fmax(0, film_basins_height(films->basins, c));
        const double brought = films->brought[c] + films->response[c] * height;
        films->own[c] = fmin(1, fmax(0, 1 - brought));
    }
}

// Sums are of positive numbers, but for the rounding of own.
static void find_scale(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    const int n_throat = times->occupancy->network->n_throat;
    double brought = 0, drawn = 0;
    films->evaporation = 0;
    for (int k = 0; k < times->n; k++) {
        const int owner = times->owner[k];
        if (owner < 0) continue;
        const double part = (1 - films->own[owner]) * times->rate[k];
        brought += part;
        if (owner >= n_throat) films->evaporation += part;
    }
    for (int l = 0; l < films->n_source; l++)
        if (films->source[l] >= 0) drawn += films->drawn[films->source[l]];
    films->scale = drawn > 0 ? brought / drawn : 1;
    if (!(drawn > 0) && brought > 0)
        for (int p = 0; p < times->n_place; p++)
            films->own[p] = 1;
    films->stray = brought - drawn;
    films->is_due = !(drawn > 0) && brought > 0;
}

void film_supply_set_rates(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    update_falling(times);
    films->lack = film_inflow_limit(times);
    find_scale(times);
    for (int k = 0; k < times->n; k++) {
        const int owner = times->owner[k];
        if (owner < 0) continue;
        times->rate[k] =
            films->own[owner] * times->rate[k] + films->scale * films->drawn[owner];
    }
}

// --- between solutions -------------------------------------------------------------

// What is not a source, and not in films.
static void set_apart(struct film_supply *films, int cluster)
{
    films->own[cluster] = 1;
    films->drawn[cluster] = 0;
    films->floats[cluster] = films->falls[cluster] = false;
    films->is_known[cluster] = false;
    film_basins_set(films->basins, cluster, -1, 0, 0);
}

// CLUSTER is, or has parted from, PARENT, and has the level that it had.
static void let_float(struct emptying_times *times, int cluster, int parent, int basin)
{
    struct film_supply *films = times->films;
    films->own[cluster] = 0;
    films->drawn[cluster] = 0;
    films->floats[cluster] = films->falls[cluster] = true;
    films->brought[cluster] = films->brought[parent];
    films->response[cluster] = films->response[parent];
    films->is_known[cluster] = true;
    films->level[cluster] = films->level[parent];
    film_basins_set(films->basins, cluster, basin,
                    compensated_value(films->level[cluster]) -
                        film_least_level(times, cluster),
                    film_turn_of(times, cluster));
}

// What the basin supplies goes to the cluster whose turn it is.
static void choose_source(struct film_supply *films, int basin, double drawn)
{
    const int before = films->source[basin];
    const int source = film_basins_supplier(films->basins, basin);
    films->source[basin] = source;
    if (before >= 0 && before != source && films->drawn[before] > 0) {
        films->own[before] = films->drawn[before] = 0;
        films->floats[before] = films->falls[before] = true;
    }
    if (source < 0) return;
    films->own[source] = 1;
    films->drawn[source] = drawn;
    films->floats[source] = films->falls[source] = false;
}

// Films may come to rings that no throat feeds any more.
static void bare_nodes(struct film_supply *films, const struct occupancy *occupancy,
                       int throat, int basin)
{
    for (int end = 0; end < 2; end++) {
        const int node = occupancy->network->throat_nodes[throat][end];
        if (occupancy->liquid_beside[node] > 0) continue;
        films->own[occupancy->network->n_throat + node] = 0;
        films->reached[node] = true;
        film_basins_add_node(films->basins, occupancy->network->n_throat + node, basin);
    }
}

static void part(struct emptying_times *times, int cluster, int parent, int basin)
{
    if (basin >= 0 && times->occupancy->clusters.size[cluster] > 0)
        let_float(times, cluster, parent, basin);
    else
        set_apart(times->films, cluster);
}

void film_supply_empty_throat(struct emptying_times *times, int throat, int cluster)
{
    struct film_supply *films = times->films;
    const struct clusters *clusters = &times->occupancy->clusters;
    const int basin = film_basins_of(films->basins, cluster);
    const int source = basin >= 0 ? films->source[basin] : -1;
    const double drawn = source >= 0 ? films->drawn[source] : 0;
    bare_nodes(films, times->occupancy, throat, basin);
    films->is_due |= films->n_source == 0; // the first film, perhaps
    for (int l = 0, last = -1; l < clusters->n_moved; l++) {
        const int moved = clusters->of_throat[clusters->moved[l]];
        if (moved != last) part(times, moved, cluster, basin);
        last = moved;
    }
    if (basin < 0 && clusters->size[cluster] > 0) return;
    part(times, cluster, cluster, basin);
    if (basin >= 0) choose_source(films, basin, drawn);
}

// --- state -------------------------------------------------------------------------

// What nodes evaporate is found again before it is used.
void film_supply_state(struct emptying_times *times, struct checkpoint_stream *stream)
{
    struct film_supply *films = times->films;
    const struct network *network = times->occupancy->network;
    stream_numbers(stream, films->own, times->n_place);
    stream_numbers(stream, films->drawn, times->n_place);
    stream_numbers(stream, &films->scale, 1);
    stream_numbers(stream, &films->evaporation, 1);
    stream_integer(stream, &films->n_source, 0, network->n_throat);
    stream_integers(stream, films->source, films->n_source, -1, network->n_throat - 1);
    stream_flags(stream, films->reached, network->n_node);
    stream_flags(stream, films->floats, network->n_throat);
    stream_flags(stream, films->falls, network->n_throat);
    stream_numbers(stream, films->brought, network->n_throat);
    stream_numbers(stream, films->response, network->n_throat);
    stream_sums(stream, films->level, times->n_place);
    stream_flags(stream, films->is_known, times->n_place);
    stream_flags(stream, &films->is_due, 1);
    stream_numbers(stream, &films->stray, 1);
    stream_numbers(stream, &films->at_risk, 1);
    stream_numbers(stream, &films->lack, 1);
    stream_numbers(stream, &films->saturation, 1);
    stream_long(stream, &films->solutions);
    film_basins_state(films->basins, stream);
    film_inflow_state(films->inflow, stream);
    if (!stream->restoring) return;
    film_factor_forget(films->factor);
    films->failed = false;
}

static bool has_liquid(const struct clusters *clusters, int cluster)
{
    return cluster < clusters->n_id && clusters->size[cluster] > 0;
}

bool film_supply_fits(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const struct clusters *clusters = &times->occupancy->clusters;
    const int n_throat = times->occupancy->network->n_throat;
    bool fits = film_basins_count(films->basins) == films->n_source;
    for (int l = 0; l < films->n_source; l++)
        fits &= films->source[l] < 0 || has_liquid(clusters, films->source[l]);
    for (int c = 0; c < n_throat; c++)
        fits &= film_basins_of(films->basins, c) < 0 ? !films->falls[c]
                                                     : has_liquid(clusters, c);
    return fits;
}
