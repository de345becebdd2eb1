// SPDX-License-Identifier: GPL-3.0-or-later
// The obstacle problem of films (film_flow.h) with, at each site,
//     rings at a node:  least = 0,   taken = what the node evaporates,
//     a cluster:        least = (curvature R)^3, R the throat it empties now or next
//                       (under gravity as film_law.h says),
//                       taken = what it evaporates itself.
// A node whose level is above 0 is reached: it stays wet, and its rings keep their
// liquid. At 0 the film ends, and the rings supply what it does not bring (the
// surplus), until they are dry and the node with them. A cluster above its least gets
// from films all that it evaporates, and its menisci stand still in flatter shape; the
// others lose the surplus. With F = surplus - taken
//     own = 1, drawn = F          where F >= 0,
//     own = surplus / taken, drawn = 0   where F < 0.
// Both are 0 or more, so no reservoir ever gains. Between two solutions
//     scale = sum of (1 - own) E / sum of drawn.
//
// Where a cluster has lost a throat since, and another supplies its basin, its level
// falls until films bring what it evaporates. It hardly has to where they conduct well.
// Where they do not it comes to its least first, and the cluster goes on losing liquid.
// If nothing else fell, films would bring their conductance at the cluster times how
// far it falls. Levels around it fall too, so that RESPONSE of this counts. What has
// parted from the cluster gets the same share of what it evaporates.
#include "film_supply.h"

#include "basics/memory.h"
#include "film_balance.h"
#include "film_basins.h"
#include "film_flow.h"
#include "film_network.h"
#include "geometry/space_filling_curve.h"

#include <math.h>
#include <stdlib.h>

// Flows are found to this part of the drying rate.
static const double TOLERANCE = 1e-6;
// They are found again before the step is over once so much of the drying rate is not
// brought, or from other sources than was found, but not sooner than after such a part
// of the step.
static const double MOST_FAILING = 0.05, SHORTEST = 0.1;
// From 0.03 to 0.3 times are about as exact; the more, the more often flows are found.
static const double RESPONSE = 0.1;

// After so many solutions the factor is forgotten, with and without checkpoints: a
// state that is kept there needs none. At a usual step it would not last longer.
enum { SOLUTIONS_BETWEEN_CUTS = 4 };

// Rounds of levels and conductances under gravity: a few, unless the liquid of a throat
// weighs as much as its suction.
enum { MOST_WEIGHED = 1000 };

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
    free(films);
}

static double saturation_now(const struct occupancy *occupancy)
{
    return compensated_value(occupancy->total_liquid) / occupancy->capacity;
}

static bool is_failing(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    return films->stray + film_basins_failing(films->basins) >
           MOST_FAILING * vapour_rate(&times->occupancy->vapour);
}

bool film_supply_is_due(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const double step = times->occupancy->film_law->step;
    const double fallen = films->saturation - saturation_now(times->occupancy);
    return films->is_due || !(step > 0) || fallen >= step ||
           (fallen >= SHORTEST * step && is_failing(times));
}

bool film_supply_may_be_kept(const struct film_supply *films)
{
    return films->solutions % SOLUTIONS_BETWEEN_CUTS == 0;
}

// --- finding -----------------------------------------------------------------------

// The throat that CLUSTER empties now or next.
static int next_throat(const struct emptying_times *times, int cluster)
{
    const int timer = times->timer[cluster];
    const int losing = timer >= 0 ? times->throat[timer] : -1;
    return losing >= 0 ? losing
                       : clusters_invasion_throat(&times->occupancy->clusters, cluster);
}

static int turn_of(const struct emptying_times *times, int cluster)
{
    return times->occupancy->clusters.rank[next_throat(times, cluster)];
}

// The level of films beside CLUSTER.
static double least_level(const struct emptying_times *times, int cluster)
{
    struct occupancy *occupancy = times->occupancy;
    const int throat = next_throat(times, cluster);
    const double radius = occupancy->film_law->curvature *
                          occupancy->network->throat_radius[throat] / occupancy->length;
    return film_level(occupancy->film_law, radius, film_depth(occupancy, throat));
}

// In each part of the network, holds the cluster of the largest least. No level is
// above it.
static void hold_highest(const struct film_network *network, int n_throat,
                         const double *least, bool *held, struct compensated *level)
{
    int *highest = NEW_ARRAY(int, network->n_site); // of a part, by its root
    for (int i = 0; i < network->n_site; i++)
        highest[i] = -1;
    for (int i = 0; i < network->n_site; i++) {
        int *best = &highest[network->root[i]];
        if (network->place[i] >= n_throat) continue;
        if (*best < 0 || least[i] > least[*best]) *best = i;
    }
    for (int i = 0; i < network->n_site; i++)
        if (highest[i] >= 0) held[highest[i]] = true;
    for (int i = 0; i < network->n_site; i++) {
        const double most = least[highest[network->root[i]]];
        if (compensated_value(level[i]) > most)
            level[i] = (struct compensated){.value = most};
    }
    free(highest);
}

// Sites that were not there in the last solution begin with the mean level of those
// around them, so that what is wrong is near them only. UNKNOWN (n) is changed. A site
// that nothing known reaches keeps 0.
static void guess_levels(const struct film_network *network, bool *unknown,
                         struct compensated *level)
{
    const struct conductance_matrix *matrix = &network->matrix;
    for (bool again = true; again;) {
        again = false;
        for (int i = 0; i < network->n_site; i++) {
            if (!unknown[i]) continue;
            double sum = 0, all = 0;
            for (int k = matrix->offset[i]; k < matrix->offset[i + 1]; k++) {
                const int j = matrix->column[k];
                if (unknown[j]) continue;
                sum += matrix->value[k] * compensated_value(level[j]);
                all += matrix->value[k];
            }
            if (!(all > 0)) continue;
            level[i] = (struct compensated){.value = sum / all};
            unknown[i] = false;
            again = true;
        }
    }
}

// A first guess from the last solution. The cluster of the largest least is always
// held: no level is above it, as liquid goes down from sources that are held.
static void pose(const struct emptying_times *times, const struct film_network *network,
                 double *taken, double *least, struct film_flow *flow)
{
    const struct film_supply *films = times->films;
    const int n_throat = times->occupancy->network->n_throat;
    bool *unknown = NEW_ARRAY(bool, network->n_site);
    for (int i = 0; i < network->n_site; i++) {
        const int place = network->place[i];
        taken[i] = films->evaporates[place];
        if (place < n_throat) {
            least[i] = least_level(times, place);
            flow->held[i] = !films->floats[place];
        } else {
            flow->held[i] = !films->reached[place - n_throat];
        }
        unknown[i] = !films->is_known[place];
        if (unknown[i]) continue;
        flow->level[i] = films->level[place];
        compensated_add(&flow->level[i], -film_basins_fall(films->basins, place));
    }
    guess_levels(network, unknown, flow->level);
    free(unknown);
    hold_highest(network, n_throat, least, flow->held, flow->level);
}

// What evaporates where nothing did before is brought as it comes.
static void note_response(struct film_supply *films, int cluster, double taken,
                          double surplus, double conductance)
{
    films->brought[cluster] = taken > 0 ? 1 - surplus / taken : 1;
    films->response[cluster] = taken > 0 ? RESPONSE * conductance / taken : 0;
}

static void note_site(struct film_supply *films, int place, int n_throat, double taken,
                      bool held, double surplus)
{
    const double flow = surplus - taken;
    films->own[place] = flow >= 0 ? 1 : taken > 0 ? surplus / taken : 1;
    if (place >= n_throat)
        films->reached[place - n_throat] = !held;
    else
        films->floats[place] = !held;
    if (place < n_throat && flow > 0) {
        films->drawn[place] = flow;
        films->source[films->n_source++] = place;
    }
}

// What may be left of the balances, in all.
static double tolerance_of(const struct emptying_times *times)
{
    return TOLERANCE * vapour_rate(&times->occupancy->vapour);
}

// Each source has a basin, numbered alike.
static void find_basins(const struct emptying_times *times,
                        const struct film_flow *flow, int n_throat)
{
    const struct film_supply *films = times->films;
    int *turn = NEW_ARRAY(int, flow->matrix->n);
    int *site = NEW_ARRAY(int, films->n_source), n = 0;
    for (int i = 0; i < flow->matrix->n; i++) {
        if (flow->place[i] >= n_throat) continue;
        turn[i] = turn_of(times, flow->place[i]);
        if (films->drawn[flow->place[i]] > 0) site[n++] = i;
    }
    film_basins_find(films->basins, flow, tolerance_of(times), turn, n, site);
    free(turn);
    free(site);
}

// What each reservoir evaporates, and nothing known of films.
static void begin(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    for (int p = 0; p < times->n_place; p++) {
        const int k = times->timer[p];
        films->evaporates[p] = k >= 0 ? times->rate[k] : 0;
        films->own[p] = 1;
        films->drawn[p] = 0;
    }
    for (int cluster = 0; cluster < times->occupancy->network->n_throat; cluster++)
        films->falls[cluster] = false;
    films->n_source = 0;
    films->is_due = false;
    films->stray = 0;
    films->saturation = saturation_now(times->occupancy);
}

static void forget_unreached(struct film_supply *films,
                             const struct film_network *network, int n_throat,
                             int n_node)
{
    bool *is_site = NEW_ARRAY(bool, n_node);
    for (int i = 0; i < network->n_site; i++)
        if (network->place[i] >= n_throat) is_site[network->place[i] - n_throat] = true;
    for (int i = 0; i < n_node; i++)
        films->reached[i] = films->reached[i] && is_site[i];
    free(is_site);
}

// Under gravity the conductances depend on the levels: from one to the other, until no
// flow changes any more.
static bool find_levels(const struct emptying_times *times,
                        struct film_network *network, struct film_flow *flow)
{
    const struct film_law *law = times->occupancy->film_law;
    const double tolerance = tolerance_of(times);
    if (!(law->weight > 0)) return film_flow_solve(flow, tolerance);
    film_network_weigh(network, law, flow->level);
    for (int round = 0; round < MOST_WEIGHED; round++) {
        if (!film_flow_solve(flow, tolerance)) return false;
        if (film_network_weigh(network, law, flow->level) <= tolerance) return true;
    }
    return false;
}

void film_supply_find(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    const int n_throat = times->occupancy->network->n_throat;
    if (film_supply_may_be_kept(films)) film_factor_forget(films->factor);
    begin(times);
    struct film_network network = film_network_init(times->occupancy, films->curve);
    forget_unreached(films, &network, n_throat, times->occupancy->network->n_node);
    const int n = network.n_site;
    double *taken = NEW_ARRAY(double, n), *least = NEW_ARRAY(double, n);
    struct film_flow flow = {.matrix = &network.matrix,
                             .place = network.place,
                             .factor = films->factor,
                             .taken = taken,
                             .least = least,
                             .held = NEW_ARRAY(bool, n),
                             .level = NEW_ARRAY(struct compensated, n),
                             .surplus = NEW_ARRAY(double, n)};
    pose(times, &network, taken, least, &flow);
    if (n > 0) films->failed |= !find_levels(times, &network, &flow);
    for (int p = 0; p < times->n_place; p++)
        films->is_known[p] = false;
    for (int i = 0; i < n; i++) {
        films->is_known[network.place[i]] = true;
        films->level[network.place[i]] = flow.level[i];
        note_site(films, network.place[i], n_throat, taken[i], flow.held[i],
                  flow.surplus[i]);
        if (network.place[i] < n_throat)
            note_response(films, network.place[i], taken[i], flow.surplus[i],
                          network.matrix.diagonal[i]);
    }
    find_basins(times, &flow, n_throat);
    films->solutions += n > 0;
    free(taken);
    free(least);
    free(flow.held);
    free(flow.level);
    free(flow.surplus);
    film_network_free(&network);
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
                        least_level(times, cluster),
                    turn_of(times, cluster));
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
                       int throat)
{
    for (int end = 0; end < 2; end++) {
        const int node = occupancy->network->throat_nodes[throat][end];
        if (occupancy->liquid_beside[node] > 0) continue;
        films->own[occupancy->network->n_throat + node] = 0;
        films->reached[node] = true;
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
    bare_nodes(films, times->occupancy, throat);
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
    stream_numbers(stream, &films->saturation, 1);
    stream_long(stream, &films->solutions);
    film_basins_state(films->basins, stream);
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
