// SPDX-License-Identifier: GPL-3.0-or-later
// What each body evaporates at given potentials of the bodies:
//     level[node] = gravity_potential + sum_a part_a potential[a]    at wet nodes,
//     flow[node] = air_conductance[node] (1 - level[node])
//                  + sum_j link_node,j (level[j] - level[node]),
//     evaporation[a] = sum over its wet nodes of part_a flow[node],
// and rate is the sum of the first terms. Links between wet nodes may conduct a
// million times more than the air does, so flows cancel: noise bounds the rounding
// that remains.
#include "kelvin_evaporation.h"

#include <math.h>
#include <string.h>

// Relative rounding of a flow, of conductance times potential; less is no flow.
static const double NOISE = 1e-15;

// Adds FLOW at the K-th wet node to TO (n bodies), in proportion to their shares.
static void share_flow(const struct kelvin_menisci *kelvin, int k, double flow,
                       double *to)
{
    for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++)
        to[kelvin->share[i].body] += kelvin->share[i].part * flow;
}

// The potential at each wet node: the mean over its menisci, and gravity.
static void find_levels(struct kelvin_menisci *kelvin,
                        const struct occupancy *occupancy)
{
    for (int k = 0; k < occupancy->n_wet; k++) {
        double mean = kelvin->gravity_potential[k];
        for (int i = kelvin->offset[k]; i < kelvin->offset[k + 1]; i++)
            mean += kelvin->share[i].part * kelvin->potential[kelvin->share[i].body];
        kelvin->level[occupancy->wet[k]] = mean;
    }
}

void kelvin_find_evaporation(struct kelvin_menisci *kelvin,
                             const struct occupancy *occupancy)
{
    const struct kron_fronts *mesh = &occupancy->vapour.mesh;
    struct compensated rate = {0};
    find_levels(kelvin, occupancy);
    for (int k = 0; k < occupancy->n_wet; k++) {
        const int node = occupancy->wet[k];
        kelvin->flow[node] = kron_fronts_air(mesh, node) * (1 - kelvin->level[node]);
        if (kron_fronts_air(mesh, node) > 0) compensated_add(&rate, kelvin->flow[node]);
    }
    kelvin->rate = compensated_value(rate);
    kron_fronts_add_flows(mesh, kelvin->level, kelvin->flow);
    memset(kelvin->evaporation, 0, (size_t)kelvin->n * sizeof *kelvin->evaporation);
    for (int k = 0; k < occupancy->n_wet; k++)
        share_flow(kelvin, k, kelvin->flow[occupancy->wet[k]], kelvin->evaporation);
}

void kelvin_find_conductance_bounds(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy)
{
    memset(kelvin->conductance_bound, 0,
           (size_t)kelvin->n * sizeof *kelvin->conductance_bound);
    for (int k = 0; k < occupancy->n_wet; k++)
        share_flow(kelvin, k, kelvin->node_conductance_bound[k],
                   kelvin->conductance_bound);
}

void kelvin_find_noise(struct kelvin_menisci *kelvin)
{
    kelvin->all_noise = 0;
    for (int a = 0; a < kelvin->n; a++) {
        kelvin->noise[a] =
            NOISE * kelvin->conductance_bound[a] * fabs(kelvin->potential[a]);
        kelvin->all_noise += kelvin->noise[a];
    }
}
