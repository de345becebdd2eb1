// SPDX-License-Identifier: GPL-3.0-or-later
#include "kelvin_bodies.h"

// A throat that lacks less than this of its volume is full. In a step that rounding
// makes, menisci lose as little, and to fill them would be a step of that kind again.
static const double FULL_TOLERANCE = 1e-12;

bool kelvin_is_full(const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int place)
{
    return occupancy_saturation(occupancy, kelvin->throat[place]) > 1 - FULL_TOLERANCE;
}

// Its place. What was equilibrated when last found is likely to be so again.
static int find_body(struct kelvin_menisci *kelvin, struct occupancy *occupancy,
                     int body)
{
    if (kelvin->place[body] >= 0) return kelvin->place[body];
    const int place = kelvin->n++;
    kelvin->place[body] = place;
    kelvin->body[place] = body;
    kelvin->throat[place] =
        kelvin->by_throat ? body : clusters_invasion_throat(&occupancy->clusters, body);
    kelvin->flows[place] =
        kelvin->by_throat && occupancy->clusters.gas_parts &&
        occupancy->clusters.size[occupancy->clusters.of_throat[body]] > 1;
    kelvin->exponent[place] =
        kelvin->law.exponent / occupancy->network->throat_radius[kelvin->throat[place]];
    kelvin->zero_flux[place] = kelvin->had_zero_flux[body] && !kelvin->flows[place] &&
                               kelvin_is_full(kelvin, occupancy, place);
    kelvin->potential[place] = kelvin->zero_flux[place]
                                   ? kelvin->zero_flux_potential[body]
                                   : kelvin->entry_potential[kelvin->throat[place]];
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

// The shares of the K-th wet node come at kelvin->offset[k]. No more conducts vapour
// from it than at first and in the throats that have emptied since: what is eliminated
// only puts more in series.
static void list_shares(struct kelvin_menisci *kelvin, struct occupancy *occupancy,
                        int k)
{
    const int node = occupancy->wet[k], begin = kelvin->offset[k];
    int end = begin;
    double sum = 0;
    kelvin->node_conductance_bound[k] = kelvin->initial_conductance[node];
    for (int i = occupancy->incidence.offset[node];
         i < occupancy->incidence.offset[node + 1]; i++) {
        const int throat = occupancy->incidence.throat[i];
        const int cluster = occupancy->clusters.of_throat[throat];
        if (cluster < 0) {
            kelvin->node_conductance_bound[k] += occupancy->vapour.conductance[throat];
            continue;
        }
        const int body = kelvin->by_throat ? throat : cluster;
        end = add_share(kelvin->share, begin, end, find_body(kelvin, occupancy, body),
                        kelvin->section[throat]);
        sum += kelvin->section[throat];
    }
    for (int i = begin; i < end; i++)
        kelvin->share[i].part = end == begin + 1 ? 1 : kelvin->share[i].part / sum;
    kelvin->offset[k + 1] = end;
}

// By throats, ascending.
static void rank_bodies(struct kelvin_menisci *kelvin, int n_throat)
{
    for (int a = 0; a < kelvin->n; a++)
        kelvin->at_throat[kelvin->throat[a]] = a + 1;
    int n = 0;
    for (int t = 0; t < n_throat; t++) {
        if (kelvin->at_throat[t] == 0) continue;
        kelvin->ranked[n++] = kelvin->at_throat[t] - 1;
        kelvin->at_throat[t] = 0;
    }
}

void kelvin_list_bodies(struct kelvin_menisci *kelvin, struct occupancy *occupancy)
{
    for (int a = 0; a < kelvin->n; a++)
        kelvin->place[kelvin->body[a]] = -1;
    kelvin->n = 0;
    for (int k = 0; k < occupancy->n_wet; k++)
        list_shares(kelvin, occupancy, k);
    rank_bodies(kelvin, occupancy->network->n_throat);
}

// What the potential at NODE is above that at the middle of the throat of a body, in
// liquid at rest.
static double potential_over_middle(const struct kelvin_menisci *kelvin,
                                    const struct network *network, int node, int place)
{
    const struct kelvin_law *law = &kelvin->law;
    const int32_t *end = network->throat_nodes[kelvin->throat[place]];
    const struct vector *at = network->node_position;
    const double height = at[node].z - (at[end[0]].z + at[end[1]].z) / 2;
    const double exponent = kelvin->exponent[place];
    return kelvin_potential(law, exponent + law->exponent_per_height * height) -
           kelvin_potential(law, exponent);
}

void kelvin_find_gravity_potentials(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy)
{
    for (int k = 0; k < occupancy->n_wet; k++) {
        kelvin->gravity_potential[k] = 0;
        for (int i = kelvin->offset[k];
             kelvin->law.exponent_per_height != 0 && i < kelvin->offset[k + 1]; i++)
            kelvin->gravity_potential[k] +=
                kelvin->share[i].part *
                potential_over_middle(kelvin, occupancy->network, occupancy->wet[k],
                                      kelvin->share[i].body);
    }
}
