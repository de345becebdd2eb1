// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid that throats leave as rings around contacts (network/contact_rings.h), and
// the nodes from which it dries.
#pragma once

#include "dry/conditions.h"
#include "network/contact_rings.h"

// It owns its arrays. Volumes are scaled by the cube of the unit of length, but PART.
struct ring_stores {
    struct contact_rings rings;
    double *part;      // (rings.n_part) m3
    double *of_throat; // (n_throat) the sum of its parts
    double *at_node;   // (n_node) halves of the parts of all throats at the node
    int limited;       // throats that hold less in rings than these ask for
};

// For NETWORK under CONDITIONS; LENGTH (m) is the unit. The caller frees it with
// ring_stores_free, also after a failure. Statuses as contact_rings_init and
// ring_volumes. Possible before the run because gas enters a throat at the suction of
// its own meniscus, whatever happens elsewhere.
enum status ring_stores_init(const struct network *network,
                             const struct drying_conditions *conditions, double length,
                             struct ring_stores *stores, struct reason *reason);
void ring_stores_free(struct ring_stores *stores);
