// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// The middle of a throat, in lengths of LENGTH above the floor of the box.
static double height_of(const struct network *network, int throat, double length)
{
    const int32_t *node = network->throat_nodes[throat];
    const double floor = network->packing.lower.z;
    const double first = network->node_position[node[0]].z - floor;
    const double second = network->node_position[node[1]].z - floor;
    return (first + second) / 2 / length;
}

struct menisci menisci_make(const struct network *network,
                            const struct drying_conditions *conditions,
                            const struct drying_scale *scale)
{
    const double length = scale->length;
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    const double pressure =
        conditions->liquid == LIQUID_VISCOUS
            ? conditions->viscosity * scale->rate / (length * length * length)
            : 2 * conditions->surface_tension / length;
    struct menisci menisci = {.n_throat = network->n_throat,
                              .tension = tension / length / pressure,
                              .weight = conditions->liquid_density *
                                        conditions->gravity * length / pressure,
                              .radius = NEW_ARRAY(double, network->n_throat),
                              .pressure = pressure};
    if (menisci.weight != 0) menisci.height = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++) {
        menisci.radius[t] = network->throat_radius[t] / length;
        if (menisci.height) menisci.height[t] = height_of(network, t, length);
    }
    return menisci;
}

double menisci_potential(const struct menisci *menisci, int throat, int reference)
{
    const double r = menisci->radius[throat], s = menisci->radius[reference];
    double potential = menisci->tension * ((r - s) / (r * s));
    if (menisci->height)
        potential +=
            menisci->weight * (menisci->height[throat] - menisci->height[reference]);
    return potential;
}

void menisci_free(struct menisci *menisci)
{
    free(menisci->radius);
    free(menisci->height);
    *menisci = (struct menisci){0};
}
