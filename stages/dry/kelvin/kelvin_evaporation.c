// SPDX-License-Identifier: GPL-3.0-or-later
#include "kelvin_evaporation.h"

#include <math.h>
#include <string.h>

// What flows between sites at different potentials is known to this part of conductance
// times potential; less is nothing.
static const double NOISE = 1e-15;

// Adds to TO (n) what the bodies at the K-th wet node have of FLOW.
static void share_flow(const struct curved *curved, int k, double flow, double *to)
{
    for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
        to[curved->share[i].body] += curved->share[i].part * flow;
}

// The mean over the menisci of each wet node.
static void find_levels(struct curved *curved, const struct phases *phases)
{
    for (int k = 0; k < phases->n_wet; k++) {
        double mean = curved->raised[k];
        for (int i = curved->offset[k]; i < curved->offset[k + 1]; i++)
            mean += curved->share[i].part * curved->potential[curved->share[i].body];
        curved->level[phases->wet[k]] = mean;
    }
}

void curved_find_gains(struct curved *curved, const struct phases *phases)
{
    const struct star_mesh *mesh = &phases->vapour.mesh;
    struct compensated rate = {0};
    find_levels(curved, phases);
    for (int k = 0; k < phases->n_wet; k++) {
        const int node = phases->wet[k];
        curved->flow[node] = mesh->air[node] * (1 - curved->level[node]);
        if (mesh->air[node] > 0) compensated_add(&rate, curved->flow[node]);
    }
    curved->rate = compensated_value(rate);
    star_mesh_add_flows(mesh, curved->level, curved->flow);
    memset(curved->gain, 0, (size_t)curved->n * sizeof *curved->gain);
    for (int k = 0; k < phases->n_wet; k++)
        share_flow(curved, k, curved->flow[phases->wet[k]], curved->gain);
}

void curved_find_reaches(struct curved *curved, const struct phases *phases)
{
    memset(curved->reach, 0, (size_t)curved->n * sizeof *curved->reach);
    for (int k = 0; k < phases->n_wet; k++)
        share_flow(curved, k, curved->conducted[k], curved->reach);
}

void curved_find_noise(struct curved *curved)
{
    curved->all_noise = 0;
    for (int a = 0; a < curved->n; a++) {
        curved->noise[a] = NOISE * curved->reach[a] * fabs(curved->potential[a]);
        curved->all_noise += curved->noise[a];
    }
}
