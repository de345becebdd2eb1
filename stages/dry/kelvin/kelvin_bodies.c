// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of liquid beside gas, listed from the wet nodes: throats, or clusters where
// the liquid has no viscosity. At wet node k body a has the
//     part = section of its throats at k / section of all throats with liquid at k,
// which weighs both the mean potential of the node and the shares of what it
// evaporates: so the matrix of the bodies is symmetric. Gravity adds to the potential
// of node k,
//     gravity_potential[k] = sum_a part_a (potential(x_a + g M h / (R T))
//                                          - potential(x_a)),
// h the height of the node above the middle of the body's throat.
#include "kelvin_bodies.h"

// A throat that lacks less than this of its volume counts as full. Rounding makes steps
// in which menisci lose as little; to fill them again would be another such step.
static const double FULL_TOLERANCE = 1e-12;

bool kelvin_is_full(const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int place)
{
    return occupancy_saturation(occupancy, kelvin->throat[place]) > 1 - FULL_TOLERANCE;
}

// The place of BODY in the lists; adds it if it is new. A body that was equilibrated
// when last found starts so again, at the same potential.
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

// Adds SECTION to the share of BODY among SHARE[BEGIN..END-1], or as a new one at END.
// Returns the new end.
static int add_share(struct share *share, int begin, int end, int body, double section)
{
    int k = begin;
    while (k < end && share[k].body != body)
        k++;
    if (k == end) share[end] = (struct share){.body = body};
    share[k].part += section;
    return k == end ? end + 1 : end;
}

// Lists the shares of the K-th wet node from kelvin->offset[k] on. The conductance from
// it to everything else is at most the initial one plus that of the throats that have
// emptied at it since: elimination only puts more conductances in series.
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

// Orders the bodies by their throats, ascending.
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

// Potential at NODE above that at the middle of the body's throat, in liquid at rest.
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
