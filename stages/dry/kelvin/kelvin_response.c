// SPDX-License-Identifier: GPL-3.0-or-later
// How much more a meniscus evaporates when its pressure rises: the derivative that
// couples flow and vapour. With single the conductance from its nodes to everything
// else, lumped that to everything but its own cluster, and slope = d potential / d
// pressure,
//     alone = slope single,   part = alone / (alone + conductance),
//     response = slope (lumped + part (single - lumped)):
// where the throat conducts well (part near 0) the cluster's pressures change together
// and only exchange with others counts; where it conducts badly the meniscus changes
// alone. Only an estimate: it sets how fast the fixed point converges, not where.
#include "kelvin_response.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Relative to the conductance of the throat: with less, the fixed point converges in a
// few rounds without a response.
static const double MIN_RESPONSE = 1e-2;

int throat_of(const struct kelvin_viscous *coupling, int k)
{
    return coupling->kelvin->throat[coupling->body[k]];
}

static int cluster_of(const struct kelvin_menisci *kelvin,
                      const struct occupancy *occupancy, const struct share *share)
{
    return occupancy->clusters.of_throat[kelvin->throat[share->body]];
}

// The part of the K-th wet node that belongs to the cluster of SHARE.
static double part_of_cluster(const struct kelvin_menisci *kelvin,
                              const struct occupancy *occupancy, int k,
                              const struct share *share)
{
    double part = 0;
    for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++)
        if (cluster_of(kelvin, occupancy, &kelvin->share[i]) ==
            cluster_of(kelvin, occupancy, share))
            part += kelvin->share[i].part;
    return part;
}

// The cluster that has all of the K-th wet node; -1 - k if several share it.
static int group_of(const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int k)
{
    const struct share *share = &kelvin->share[kelvin->offset[k]];
    return part_of_cluster(kelvin, occupancy, k, share) > 1 - 1e-9
               ? cluster_of(kelvin, occupancy, share)
               : -1 - k;
}

struct links {
    int *group;   // (n_site)
    int *other;   // (n_site) room
    double *link; // (n_site) room, 0 between calls
};

// Conductance from the K-th wet node to the air and to other nodes: to all of them
// (ALL), and without those of its own group (APART).
static void find_degrees(const struct occupancy *occupancy, struct links *links, int k,
                         double *all, double *apart)
{
    const struct kron_fronts *mesh = &occupancy->vapour.mesh;
    const int node = occupancy->wet[k];
    const int n = kron_fronts_list_links(mesh, node, links->other, links->link);
    *all = *apart = kron_fronts_air(mesh, node);
    for (int i = 0; i < n; i++) {
        const int other = links->other[i];
        *all += links->link[other];
        if (links->group[other] != links->group[node]) *apart += links->link[other];
        links->link[other] = 0;
    }
}

static void add_response_bounds(struct kelvin_viscous *coupling,
                                const struct occupancy *occupancy, struct links *links,
                                const int *place)
{
    const struct kelvin_menisci *kelvin = coupling->kelvin;
    for (int k = 0; k < occupancy->n_wet; k++) {
        double all, apart;
        find_degrees(occupancy, links, k, &all, &apart);
        for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++) {
            const struct share *share = &kelvin->share[i];
            const int which = place[share->body] - 1;
            if (which < 0) continue;
            coupling->single[which] += share->part * all;
            coupling->lumped[which] +=
                share->part * part_of_cluster(kelvin, occupancy, k, share) * apart;
        }
    }
}

void find_response_bounds(struct kelvin_viscous *coupling,
                          const struct occupancy *occupancy)
{
    const struct kelvin_menisci *kelvin = coupling->kelvin;
    const int n_site = occupancy->vapour.n_site;
    struct links links = {.group = NEW_ARRAY(int, n_site),
                          .other = NEW_ARRAY(int, n_site),
                          .link = NEW_ARRAY(double, n_site)};
    int *place = NEW_ARRAY(int, kelvin->n);
    for (int k = 0; k < coupling->n; k++) {
        place[coupling->body[k]] = k + 1;
        coupling->lumped[k] = coupling->single[k] = 0;
    }
    for (int k = 0; k < occupancy->n_wet; k++)
        links.group[occupancy->wet[k]] = group_of(kelvin, occupancy, k);
    add_response_bounds(coupling, occupancy, &links, place);
    free(links.group);
    free(links.other);
    free(links.link);
    free(place);
}

// d evaporation / d pressure of the K-th meniscus if only its own pressure changes.
static double rise_alone(const struct kelvin_viscous *coupling, int k, double *slope)
{
    const struct kelvin_menisci *kelvin = coupling->kelvin;
    *slope = coupling->unit *
             kelvin_slope(&kelvin->law, kelvin->exponent[coupling->body[k]]);
    return *slope * coupling->single[k];
}

// Which clusters need a response: no meniscus of them moves, or one evaporates so much
// more with its pressure that the flow changes. (n_id); the caller frees it.
static bool *find_responsive(const struct kelvin_viscous *coupling,
                             const struct occupancy *occupancy)
{
    const struct liquid_flow *flow = coupling->flow;
    bool *moves = NEW_ARRAY(bool, occupancy->clusters.n_id);
    bool *responsive = NEW_ARRAY(bool, occupancy->clusters.n_id);
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k);
        const int cluster = occupancy->clusters.of_throat[throat];
        double slope;
        moves[cluster] |= flow->moving[throat];
        responsive[cluster] |=
            rise_alone(coupling, k, &slope) > MIN_RESPONSE * flow->conductance[throat];
    }
    for (int c = 0; c < occupancy->clusters.n_id; c++)
        responsive[c] |= !moves[c];
    free(moves);
    return responsive;
}

void set_responses(struct kelvin_viscous *coupling, const struct occupancy *occupancy)
{
    struct liquid_flow *flow = coupling->flow;
    bool *responsive = find_responsive(coupling, occupancy);
    for (int k = 0; k < coupling->n; k++) {
        const int throat = throat_of(coupling, k);
        double slope;
        const double alone = rise_alone(coupling, k, &slope);
        const double more = fmax(coupling->single[k] - coupling->lumped[k], 0);
        const double part = alone / (alone + flow->conductance[throat]);
        flow->response[throat] = responsive[occupancy->clusters.of_throat[throat]]
                                     ? slope * (coupling->lumped[k] + part * more)
                                     : 0;
    }
    free(responsive);
}
