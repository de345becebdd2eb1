// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary pressure of each throat, and the potential at which gas enters it:
//     entry potential = weight height - tension / radius,
//     tension = 2 sigma cos(theta), weight = rho g, height of the throat's middle.
// The unit of pressure is that in which Poiseuille's law has no viscosity,
//     nu rate / length^3  (viscous), or 2 sigma / length  (else).
// The trap: potentials of two throats nearly equal in radius differ by little. So they
// are always differences to a reference throat, tension (r - s) / (r s), exactly 0 for
// equals.
#include "meniscus.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Height above the lower z side of the box, in scaled lengths.
static double height_of_node(const struct menisci *menisci, int node)
{
    const struct network *network = menisci->network;
    return (network->node_position[node].z - network->packing.lower.z) /
           menisci->length;
}

static double height_of_middle(const struct menisci *menisci, int throat)
{
    const int32_t *node = menisci->network->throat_nodes[throat];
    return (height_of_node(menisci, node[0]) + height_of_node(menisci, node[1])) / 2;
}

struct menisci menisci_init(const struct network *network,
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
    struct menisci menisci = {.network = network,
                              .length = length,
                              .tension = tension / length / pressure,
                              .weight = conditions->liquid_density *
                                        conditions->gravity * length / pressure,
                              .radius = NEW_ARRAY(double, network->n_throat),
                              .pressure = pressure};
    if (menisci.weight != 0) menisci.height = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++) {
        menisci.radius[t] = network->throat_radius[t] / length;
        if (menisci.height) menisci.height[t] = height_of_middle(&menisci, t);
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

double menisci_weight(const struct menisci *menisci, int throat, int node)
{
    if (!menisci->height) return 0;
    return menisci->weight * (menisci->height[throat] - height_of_node(menisci, node));
}

void menisci_entry_priority(const struct menisci *menisci, double *entry_priority)
{
    for (int t = 0; t < menisci->network->n_throat; t++)
        entry_priority[t] =
            (menisci->height ? menisci->weight * menisci->height[t] : 0) -
            menisci->tension / menisci->radius[t];
}

void menisci_free(struct menisci *menisci)
{
    free(menisci->radius);
    free(menisci->height);
    *menisci = (struct menisci){0};
}
