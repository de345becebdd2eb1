// SPDX-License-Identifier: GPL-3.0-or-later
#include "bridges/liquid.h"

#include "basics/memory.h"

#include <stdlib.h>

struct liquid liquid_create(const struct liquid *like, int n_grain)
{
    struct liquid liquid = *like;
    liquid.bridges = NEW_ARRAY(int, n_grain);
    return liquid;
}

void liquid_free(struct liquid *liquid)
{
    free(liquid->bridges);
    liquid->bridges = NULL;
}

// What grain I gives to each of its bridges; all of it to one that is about to form.
static double share_of(const struct liquid *liquid, int i)
{
    const int bridges = liquid->bridges[i];
    return liquid->volume / (bridges > 0 ? bridges : 1);
}

double liquid_volume(const struct liquid *liquid, int i, int j)
{
    if (liquid->sharing == LIQUID_FIXED) return liquid->volume;
    return share_of(liquid, i) + share_of(liquid, j);
}

static struct bridge bridge_between(const struct liquid *liquid, int i, int j,
                                    const double radius[2])
{
    return (struct bridge){{radius[0], radius[1]},
                           {liquid->contact_angle, liquid->contact_angle},
                           liquid->surface_tension,
                           liquid_volume(liquid, i, j)};
}

bool liquid_bridged(struct liquid *liquid, int i, int j, const double radius[2],
                    double separation, bool were)
{
    bool are = separation <= 0;
    if (were && !are) {
        const struct bridge bridge = bridge_between(liquid, i, j, radius);
        are = separation <= bridge_rupture_distance(&bridge);
    }
    liquid->bridges[i] += are - were;
    liquid->bridges[j] += are - were;
    return are;
}

double liquid_force(const struct liquid *liquid, int i, int j, const double radius[2],
                    double separation)
{
    if (separation <= 0 && !liquid->pulls_in_contact) return 0;
    const struct bridge bridge = bridge_between(liquid, i, j, radius);
    return bridge_model_force(&bridge, liquid->model, separation, NULL);
}
