// SPDX-License-Identifier: GPL-3.0-or-later
// The obstacle problem of films (film_flow.h) with, at each site,
//     rings at a node:  least = 0,   taken = what the node evaporates,
//     a cluster:        least = (curvature R)^3, R the throat it empties now or next,
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
#include "film_supply.h"

#include "basics/memory.h"
#include "film_balance.h"
#include "film_flow.h"
#include "film_network.h"

#include <math.h>
#include <stdlib.h>

// Flows are found to this part of the drying rate.
static const double TOLERANCE = 1e-6;
// Between two solutions films draw at most so much more from the sources that are left.
static const double MOST_STRAY = 2;

// How far above its least a cluster floats. In hold_nearest: its site.
struct heir {
    double gap;
    int cluster;
};

struct film_supply *film_supply_create(const struct emptying_times *times)
{
    const struct network *network = times->occupancy->network;
    struct film_supply *films = NEW_ARRAY(struct film_supply, 1);
    *films =
        (struct film_supply){.own = NEW_ARRAY(double, times->n_place),
                             .drawn = NEW_ARRAY(double, times->n_place),
                             .source = NEW_ARRAY(int, network->n_throat),
                             .heir = NEW_ARRAY(int, network->n_throat),
                             .reached = NEW_ARRAY(bool, network->n_node),
                             .floats = NEW_ARRAY(bool, network->n_throat),
                             .level = NEW_ARRAY(struct compensated, times->n_place),
                             .is_known = NEW_ARRAY(bool, times->n_place),
                             .evaporates = NEW_ARRAY(double, times->n_place),
                             .factor = film_factor_create(),
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
    free(films->heir);
    free(films->reached);
    free(films->floats);
    free(films->level);
    free(films->is_known);
    free(films->evaporates);
    film_factor_free(films->factor);
    free(films);
}

static double saturation_now(const struct occupancy *occupancy)
{
    return compensated_value(occupancy->total_liquid) / occupancy->capacity;
}

bool film_supply_is_due(const struct emptying_times *times)
{
    const struct film_supply *films = times->films;
    const double step = times->occupancy->film_law->step;
    return films->is_due || !(step > 0) ||
           films->saturation - saturation_now(times->occupancy) >= step;
}

// --- finding -----------------------------------------------------------------------

// The cube of the radius of films beside CLUSTER.
static double least_level(const struct emptying_times *times, int cluster)
{
    struct occupancy *occupancy = times->occupancy;
    const int timer = times->timer[cluster];
    const int losing = timer >= 0 ? times->throat[timer] : -1;
    const int throat =
        losing >= 0 ? losing : clusters_invasion_throat(&occupancy->clusters, cluster);
    const double radius = occupancy->film_law->curvature *
                          occupancy->network->throat_radius[throat] / occupancy->length;
    return radius * radius * radius;
}

static int nearer(const void *a, const void *b)
{
    const struct heir *x = a, *y = b;
    if (x->gap != y->gap) return x->gap < y->gap ? -1 : 1;
    return (x->cluster > y->cluster) - (x->cluster < y->cluster);
}

// In each part of the network, holds the cluster of the largest least.
static void hold_highest(const struct film_network *network, int n_throat,
                         const double *least, bool *held)
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
    free(highest);
}

// As many clusters as in the last solution are held: those whose least is now highest
// above the level that they had, or least below it.
static void hold_nearest(const struct film_network *network, int n_throat,
                         struct film_flow *flow)
{
    struct heir *cluster = NEW_ARRAY(struct heir, network->n_site);
    int n = 0, n_held = 0;
    for (int i = 0; i < network->n_site; i++) {
        if (network->place[i] >= n_throat) continue;
        n_held += flow->held[i];
        cluster[n++] =
            (struct heir){compensated_value(flow->level[i]) - flow->least[i], i};
        flow->held[i] = false;
    }
    if (n > 1) qsort(cluster, (size_t)n, sizeof *cluster, nearer);
    for (int k = 0; k < n_held; k++)
        flow->held[cluster[k].cluster] = true;
    free(cluster);
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
        if (!unknown[i]) flow->level[i] = films->level[place];
    }
    guess_levels(network, unknown, flow->level);
    free(unknown);
    hold_nearest(network, n_throat, flow);
    hold_highest(network, n_throat, least, flow->held);
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

// Who supplies, in this order, when sources end before the next solution.
static void list_heirs(struct film_supply *films, const struct film_network *network,
                       int n_throat, const struct film_flow *flow)
{
    struct heir *heir = NEW_ARRAY(struct heir, network->n_site);
    films->n_heir = films->next_heir = 0;
    for (int i = 0; i < network->n_site; i++)
        if (network->place[i] < n_throat && !flow->held[i])
            heir[films->n_heir++] = (struct heir){
                compensated_value(flow->level[i]) - flow->least[i], network->place[i]};
    if (films->n_heir > 1) qsort(heir, (size_t)films->n_heir, sizeof *heir, nearer);
    for (int k = 0; k < films->n_heir; k++)
        films->heir[k] = heir[k].cluster;
    free(heir);
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
    films->n_source = 0;
    films->is_due = false;
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

void film_supply_find(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    const int n_throat = times->occupancy->network->n_throat;
    begin(times);
    struct film_network network = film_network_init(times->occupancy);
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
    if (n > 0)
        films->failed |=
            !film_flow_solve(&flow, TOLERANCE * vapour_rate(&times->occupancy->vapour));
    for (int p = 0; p < times->n_place; p++)
        films->is_known[p] = false;
    for (int i = 0; i < n; i++) {
        films->is_known[network.place[i]] = true;
        films->level[network.place[i]] = flow.level[i];
        note_site(films, network.place[i], n_throat, taken[i], flow.held[i],
                  flow.surplus[i]);
    }
    list_heirs(films, &network, n_throat, &flow);
    films->solutions += n > 0;
    free(taken);
    free(least);
    free(flow.held);
    free(flow.level);
    free(flow.surplus);
    film_network_free(&network);
}

// --- rates -------------------------------------------------------------------------

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
        drawn += films->drawn[films->source[l]];
    films->scale = drawn > 0 ? brought / drawn : 1;
    if (!(drawn > 0) && brought > 0)
        for (int p = 0; p < times->n_place; p++)
            films->own[p] = 1;
    films->is_due = brought > MOST_STRAY * drawn;
}

void film_supply_set_rates(struct emptying_times *times)
{
    struct film_supply *films = times->films;
    find_scale(times);
    for (int k = 0; k < times->n; k++) {
        const int owner = times->owner[k];
        if (owner < 0) continue;
        times->rate[k] =
            films->own[owner] * times->rate[k] + films->scale * films->drawn[owner];
    }
}

// --- between solutions -------------------------------------------------------------

void film_supply_bare_node(struct emptying_times *times, int node)
{
    times->films->own[times->occupancy->network->n_throat + node] = 0;
    times->films->reached[node] = true;
}

void film_supply_end_cluster(struct emptying_times *times, int cluster)
{
    struct film_supply *films = times->films;
    const double drawn = films->drawn[cluster];
    films->own[cluster] = 1;
    films->drawn[cluster] = 0;
    films->floats[cluster] = false;
    films->is_known[cluster] = false;
    while (drawn > 0 && films->next_heir < films->n_heir) {
        const int heir = films->heir[films->next_heir++];
        if (times->occupancy->clusters.size[heir] == 0 || films->drawn[heir] > 0)
            continue;
        films->own[heir] = 1;
        films->drawn[heir] = drawn;
        films->source[films->n_source++] = heir;
        return;
    }
}
