// SPDX-License-Identifier: GPL-3.0-or-later
#include "kelvin_bodies.h"

// A throat that lacks less than this of its volume is full. In a step that rounding
// makes, menisci lose as little, and to fill them would be a step of that kind again.
static const double SCRATCH = 1e-12;

bool curved_is_full(const struct curved *curved, const struct phases *phases, int place)
{
    return phases_saturation(phases, curved->throat[place]) > 1 - SCRATCH;
}

// Its place. What floated when last found is likely to float again.
static int find_body(struct curved *curved, struct phases *phases, int body)
{
    if (curved->place[body] >= 0) return curved->place[body];
    const int place = curved->n++;
    curved->place[body] = place;
    curved->body[place] = body;
    curved->throat[place] =
        curved->by_throat ? body : clusters_invasion_throat(&phases->clusters, body);
    curved->flows[place] = curved->by_throat && phases->clusters.gas_parts &&
                           phases->clusters.size[phases->clusters.of_throat[body]] > 1;
    curved->exponent[place] =
        curved->law.exponent / phases->network->throat_radius[curved->throat[place]];
    curved->floats[place] = curved->floated[body] && !curved->flows[place] &&
                            curved_is_full(curved, phases, place);
    curved->potential[place] = curved->floats[place]
                                   ? curved->floated_at[body]
                                   : curved->own[curved->throat[place]];
    return place;
}

// To the shares from BEGIN on, of which END have been written.
static int add_share(struct share *share, int begin, int end, int body, double section)
{
    int k = begin;
    while (k < end && share[k].body != body)
        k++;
    if (k == end) share[end] = (struct share){.body = body};
    share[k].part += section;
    return k == end ? end + 1 : end;
}

// The shares of the K-th wet node come at curved->offset[k]. No more conducts vapour
// from it than at first and in the throats that have emptied since: what is eliminated
// only puts more in series.
static void list_shares(struct curved *curved, struct phases *phases, int k)
{
    const int node = phases->wet[k], begin = curved->offset[k];
    int end = begin;
    double sum = 0;
    curved->conducted[k] = curved->outside[node];
    for (int i = phases->incidence.offset[node]; i < phases->incidence.offset[node + 1];
         i++) {
        const int throat = phases->incidence.throat[i];
        const int cluster = phases->clusters.of_throat[throat];
        if (cluster < 0) {
            curved->conducted[k] += phases->vapour.conductance[throat];
            continue;
        }
        const int body = curved->by_throat ? throat : cluster;
        end = add_share(curved->share, begin, end, find_body(curved, phases, body),
                        curved->section[throat]);
        sum += curved->section[throat];
    }
    for (int i = begin; i < end; i++)
        curved->share[i].part = end == begin + 1 ? 1 : curved->share[i].part / sum;
    curved->offset[k + 1] = end;
}

// By throats, ascending.
static void rank_bodies(struct curved *curved, int n_throat)
{
    for (int a = 0; a < curved->n; a++)
        curved->at_throat[curved->throat[a]] = a + 1;
    int n = 0;
    for (int t = 0; t < n_throat; t++) {
        if (curved->at_throat[t] == 0) continue;
        curved->ranked[n++] = curved->at_throat[t] - 1;
        curved->at_throat[t] = 0;
    }
}

void curved_list_bodies(struct curved *curved, struct phases *phases)
{
    for (int a = 0; a < curved->n; a++)
        curved->place[curved->body[a]] = -1;
    curved->n = 0;
    for (int k = 0; k < phases->n_wet; k++)
        list_shares(curved, phases, k);
    rank_bodies(curved, phases->network->n_throat);
}

// What the potential at NODE is above that at the middle of the throat of a body, in
// liquid at rest.
static double potential_over_middle(const struct curved *curved,
                                    const struct network *network, int node, int place)
{
    const struct kelvin_law *law = &curved->law;
    const int32_t *end = network->throat_nodes[curved->throat[place]];
    const struct vector *at = network->node_position;
    const double height = at[node].z - (at[end[0]].z + at[end[1]].z) / 2;
    const double exponent = curved->exponent[place];
    return kelvin_potential(law, exponent + law->steepness * height) -
           kelvin_potential(law, exponent);
}

void curved_raise_nodes(struct curved *curved, const struct phases *phases)
{
    for (int k = 0; k < phases->n_wet; k++) {
        curved->raised[k] = 0;
        for (int i = curved->offset[k];
             curved->law.steepness != 0 && i < curved->offset[k + 1]; i++)
            curved->raised[k] +=
                curved->share[i].part * potential_over_middle(curved, phases->network,
                                                              phases->wet[k],
                                                              curved->share[i].body);
    }
}
