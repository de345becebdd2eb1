// SPDX-License-Identifier: GPL-3.0-or-later
// Gas enters a throat when the suction of its liquid is that of its own meniscus,
//     p_t = 2 sigma cos(theta) / r_t,
// under gravity, too, and whatever has happened elsewhere. So what a throat leaves in
// the rings around it,
//     of_throat = sum of part over its rings,   part = share V(p_t, separation)
// (contact_rings.c), is known before the run: the part of its liquid that flows or
// dries when it empties is volume - of_throat. The rest stands half at each of its two
// nodes,
//     at_node = sum of of_throat / 2 over the throats at the node.
#include "ring_stores.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// STORES->part at the suctions at which throats empty.
static enum status find_parts(const struct network *network,
                              const struct drying_conditions *conditions,
                              struct ring_stores *stores, struct reason *reason)
{
    const struct ring_liquid liquid = {.surface_tension = conditions->surface_tension,
                                       .contact_angle =
                                           conditions->contact_angle * (M_PI / 180)};
    const double meniscus = 2 * liquid.surface_tension * cos(liquid.contact_angle);
    double *suction = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            suction[t] = meniscus / network->throat_radius[t];
    stores->part = NEW_ARRAY(double, stores->rings.n_part);
    const enum status status = ring_volumes(network, &stores->rings, &liquid, suction,
                                            stores->part, &stores->limited, reason);
    free(suction);
    return status;
}

enum status ring_stores_init(const struct network *network,
                             const struct drying_conditions *conditions, double length,
                             struct ring_stores *stores, struct reason *reason)
{
    *stores = (struct ring_stores){0};
    enum status status = contact_rings_init(network, &stores->rings, reason);
    if (!status) status = find_parts(network, conditions, stores, reason);
    if (status) return status;
    const struct throat_sides *parts = &stores->rings.parts;
    stores->of_throat = NEW_ARRAY(double, network->n_throat);
    stores->at_node = NEW_ARRAY(double, network->n_node);
    for (int t = 0; t < network->n_throat; t++) {
        for (int64_t k = parts->offset[t]; k < parts->offset[t + 1]; k++)
            stores->of_throat[t] += stores->part[k] / (length * length * length);
        for (int end = 0; end < 2; end++)
            stores->at_node[network->throat_nodes[t][end]] += stores->of_throat[t] / 2;
    }
    return STATUS_OK;
}

void ring_stores_free(struct ring_stores *stores)
{
    contact_rings_free(&stores->rings);
    free(stores->part);
    free(stores->of_throat);
    free(stores->at_node);
    *stores = (struct ring_stores){0};
}
