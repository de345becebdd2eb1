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
// Both are 0 or more, so no reservoir ever gains.
//
// Where a cluster has lost a throat since, and another supplies its basin, its level
// falls until films bring what it evaporates. It hardly has to where they conduct well.
// Where they do not it comes to its least first, and the cluster goes on losing liquid.
// If nothing else fell, films would bring their conductance at the cluster times how
// far it falls. Levels around it fall too, so that RESPONSE of this counts. What has
// parted from the cluster gets the same share of what it evaporates.
#include "film_supply_internal.h"

#include "basics/memory.h"
#include "film_balance.h"
#include "film_basins.h"
#include "film_flow.h"
#include "film_inflow.h"
#include "film_network.h"

#include <math.h>
#include <stdlib.h>

// Flows are found to this part of the drying rate.
static const double TOLERANCE = 1e-6;

// From 0.03 to 0.3 times are about as exact; the more, the more often flows are found.
static const double RESPONSE = 0.1;

// At a level below this part of the highest the drop from there is more than the level.
static const double FAR_BELOW = 0.5;

// After so many solutions the factor is forgotten, with and without checkpoints: a
// state that is kept there needs none. At a usual step it would not last longer.
enum { SOLUTIONS_BETWEEN_CUTS = 4 };

// Rounds of levels and conductances under gravity: a few, unless the liquid of a throat
// weighs as much as its suction.
enum { MOST_WEIGHED = 1000 };

double film_saturation(const struct occupancy *occupancy)
{
    return compensated_value(occupancy->total_liquid) / occupancy->capacity;
}

bool film_supply_may_be_kept(const struct film_supply *films)
{
    return films->solutions % SOLUTIONS_BETWEEN_CUTS == 0;
}

// The throat that CLUSTER empties now or next.
static int next_throat(const struct emptying_times *times, int cluster)
{
    const int timer = times->timer[cluster];
    const int losing = timer >= 0 ? times->throat[timer] : -1;
    return losing >= 0 ? losing
                       : clusters_invasion_throat(&times->occupancy->clusters, cluster);
}

int film_turn_of(const struct emptying_times *times, int cluster)
{
    return times->occupancy->clusters.rank[next_throat(times, cluster)];
}

// The level of films beside CLUSTER.
double film_least_level(const struct emptying_times *times, int cluster)
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
            least[i] = film_least_level(times, place);
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

// What sites take from films whose levels are FAR_BELOW the highest. From another
// source the level at a site is lower by about the drop from the source at most.
static double find_at_risk(const struct film_flow *flow)
{
    double highest = 0, at_risk = 0;
    for (int i = 0; i < flow->matrix->n; i++)
        highest = fmax(highest, compensated_value(flow->level[i]));
    for (int i = 0; i < flow->matrix->n; i++)
        if (compensated_value(flow->level[i]) < FAR_BELOW * highest)
            at_risk += fmax(0, film_flow_inflow(flow, i));
    return at_risk;
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
        turn[i] = film_turn_of(times, flow->place[i]);
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
    films->saturation = film_saturation(times->occupancy);
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
    film_inflow_find(times, &flow);
    films->at_risk = find_at_risk(&flow);
    films->solutions += n > 0;
    free(taken);
    free(least);
    free(flow.held);
    free(flow.level);
    free(flow.surplus);
    film_network_free(&network);
}
