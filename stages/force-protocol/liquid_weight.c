// SPDX-License-Identifier: GPL-3.0-or-later
// A throat of volume V and saturation S holds m = rho S V of liquid. Grain i, whose
// cell has the void V_i of it, carries (V_i / sum V) m g. The suction leaves the grains
// around each throat in balance, whatever it is and wherever it changes with height, so
// the sum over all grains is the weight of all the liquid: pressure only hands it on.
// For a body full of still liquid, suction S p_c on the faces of a cell of volume V_c
// rises by rho g with height and so lifts the grain in it by rho g V_c; with the weight
// of the liquid in the cell, rho g (V_c - V_grain), buoyancy rho g V_grain is left.
#include "liquid_weight.h"

#include "basics/memory.h"
#include "geometry/tetra_ball_volume.h"
#include "network/void_volume.h"

#include <math.h>
#include <stdlib.h>

// ---- shares -------------------------------------------------------------------------

static double void_of(const struct wedges *wedges, const struct wedge *wedge)
{
    const struct network *network = wedges->network;
    if (wedges->layer) return 0;
    // In the repetition of the box in which the wedge is, which is that of the face.
    const struct vector middle =
        wedge->face >= 0 ? face_middle(network, wedge->face) : wedge->foot;
    return fmax(0, tetrahedron_outside_ball(network->packing.radius[wedge->grain],
                                            subtract(middle, wedge->centre),
                                            subtract(wedge->from, wedge->centre),
                                            subtract(wedge->to, wedge->centre)));
}

static void share_throat(struct wedges *wedges, int throat, struct patches *patches)
{
    const int n = wedges_at(wedges, throat);
    double all = 0;
    int count = 0;
    for (int k = 0; k < n; k++) {
        const struct wedge *wedge = &wedges->wedge[k];
        if (is_auxiliary(&wedges->network->packing, wedge->grain)) continue;
        all += void_of(wedges, wedge);
        count++;
    }
    for (int k = 0; k < n; k++) {
        const struct wedge *wedge = &wedges->wedge[k];
        if (is_auxiliary(&wedges->network->packing, wedge->grain)) continue;
        const double share = all > 0 ? void_of(wedges, wedge) / all : 1.0 / count;
        patches_add(patches, throat, wedge->grain, (struct vector){.z = -share});
    }
}

struct patches find_liquid_shares(struct wedges *wedges)
{
    struct patches patches = {0};
    for (int t = 0; t < wedges->network->n_throat; t++)
        if (wedges->network->throat_kind[t] == THROAT_NETWORK)
            share_throat(wedges, t, &patches);
    patches_sort(&patches, wedges->network->packing.n_particle);
    return patches;
}

// ---- masses -------------------------------------------------------------------------

double liquid_density(const struct network *network, const struct drying_record *record,
                      double mass)
{
    double *saturation = full_saturations(network), volume = 0;
    apply_changes(record, 0, saturation);
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            volume += saturation[t] * throat_volume(network, t);
    free(saturation);
    return volume > 0 ? mass / volume : 0;
}

double *liquid_masses(const struct process *process, const struct protocol *protocol,
                      double gravity)
{
    const size_t n = (size_t)process->network->packing.n_particle;
    const struct patches *shares = &process->action->patches[LOAD_WEIGHT];
    double *mass = NEW_ARRAY(double, (size_t)protocol->n_time *n);
    struct filling filling =
        filling_begin(process->network, process->record, process->law);
    for (int m = 0; m < protocol->n_time; m++) {
        filling_to(&filling, protocol->time[m]);
        for (int k = 0; k < shares->n; k++) {
            double load[LOADS];
            filling_loads(&filling, shares->patch[k].throat, load);
            mass[(size_t)m * n + (size_t)shares->patch[k].particle] -=
                load[LOAD_WEIGHT] * shares->patch[k].pull.z / gravity;
        }
    }
    filling_free(&filling);
    return mass;
}
