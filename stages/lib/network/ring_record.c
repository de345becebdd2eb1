// SPDX-License-Identifier: GPL-3.0-or-later
// A ring consists of parts, one for each throat around its contact. A part counts once
// its throat, between nodes i and j, has emptied:
//     volume = sum of volume_k (s_i + s_j) / 2   over parts k with S_k = 0,
// s the saturation of the rings at a node. While the throat holds liquid, so do its
// parts, and count with it.
#include "network/ring_record.h"

#include "basics/memory.h"

#include <stdlib.h>

double *ring_parts(const struct ring_record *rings, const struct network *network)
{
    double *part = NEW_ARRAY(double, network->n_throat);
    for (int r = 0; r < rings->n; r++)
        for (int64_t k = rings->offset[r]; k < rings->offset[r + 1]; k++)
            part[rings->throat[k]] += rings->volume[k];
    return part;
}

void ring_record_free(struct ring_record *rings)
{
    drying_record_free(&rings->changes);
    free(rings->face);
    free(rings->separation);
    free(rings->offset);
    free(rings->throat);
    free(rings->volume);
    *rings = (struct ring_record){0};
}

double ring_volume(const struct ring_record *rings, const struct network *network,
                   int r, const double *saturation, const double *of_rings)
{
    double volume = 0;
    for (int64_t k = rings->offset[r]; k < rings->offset[r + 1]; k++) {
        const int throat = rings->throat[k];
        const int32_t *node = network->throat_nodes[throat];
        if (!(saturation[throat] > 0))
            volume += rings->volume[k] * (of_rings[node[0]] + of_rings[node[1]]) / 2;
    }
    return volume;
}
