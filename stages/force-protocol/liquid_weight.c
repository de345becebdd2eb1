// SPDX-License-Identifier: GPL-3.0-or-later
// A throat of volume V and saturation S holds m = rho S V of liquid, and the rings that
// it has left count with it (liquid_loads_left). Grain i, whose
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

static double void_of(const struct sectors *sectors, const struct sector *sector)
{
    const struct network *network = sectors->network;
    if (sectors->layer) return 0;
    // In the repetition of the box in which the wedge is, which is that of the face.
    const struct vector middle =
        sector->face >= 0 ? face_middle(network, sector->face) : sector->foot;
    return fmax(0, tetrahedron_outside_ball(network->packing.radius[sector->grain],
                                            subtract(middle, sector->centre),
                                            subtract(sector->from, sector->centre),
                                            subtract(sector->to, sector->centre)));
}

static void share_throat(struct sectors *sectors, int throat, struct patches *patches)
{
    const int n = sectors_at(sectors, throat);
    double all = 0;
    int count = 0;
    for (int k = 0; k < n; k++) {
        const struct sector *sector = &sectors->sector[k];
        if (is_auxiliary(&sectors->network->packing, sector->grain)) continue;
        all += void_of(sectors, sector);
        count++;
    }
    for (int k = 0; k < n; k++) {
        const struct sector *sector = &sectors->sector[k];
        if (is_auxiliary(&sectors->network->packing, sector->grain)) continue;
        const double share = all > 0 ? void_of(sectors, sector) / all : 1.0 / count;
        patches_add(patches, throat, sector->grain, (struct vector){.z = -share});
    }
}

struct patches find_liquid_shares(struct sectors *sectors)
{
    struct patches patches = {0};
    for (int t = 0; t < sectors->network->n_throat; t++)
        if (sectors->network->throat_kind[t] == THROAT_NETWORK)
            share_throat(sectors, t, &patches);
    patches_sort(&patches, sectors->network->packing.n_particle);
    return patches;
}

// ---- masses -------------------------------------------------------------------------

double liquid_density(const struct network *network, const struct liquid_record *record,
                      double mass)
{
    struct liquid_loads liquid =
        liquid_loads_begin(network, record, &(struct suction_law){0});
    double volume = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            volume += liquid_loads_filling(&liquid, t) * throat_volume(network, t) +
                      liquid_loads_left(&liquid, t);
    liquid_loads_free(&liquid);
    return volume > 0 ? mass / volume : 0;
}

void liquid_masses(const struct liquid_loads *liquid, const struct patches *shares,
                   double gravity, double *mass)
{
    for (int i = 0; i < liquid->network->packing.n_particle; i++)
        mass[i] = 0;
    for (int k = 0; k < shares->n; k++) {
        double load[LOADS];
        liquid_loads_at(liquid, shares->patch[k].throat, load);
        mass[shares->patch[k].particle] -=
            load[LOAD_WEIGHT] * shares->patch[k].pull.z / gravity;
    }
}
