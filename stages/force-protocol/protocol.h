// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary forces over time, from who holds liquid when [K 3.6, 5.2, 5.3].
#ifndef CRAQUELURE_PROTOCOL_H
#define CRAQUELURE_PROTOCOL_H

#include "patches.h"

// What the drying artifact says happened, as it lies there (schemas/drying.json).
struct drying_record {
    int n_step;
    double *time, *saturation; // (n_step)
    int64_t *offset;           // (n_step+1)
    int32_t *throat;           // (offset[n_step])
    double *throat_saturation; // (offset[n_step])
};

// Forces on a uniform grid of times from the start to the end of drying. In between,
// saturations are linear in time, and so are the forces: the interpolation adds no
// error.
struct protocol {
    int n_time;
    double *time, *saturation; // (n_time) s, 1
    struct vector *force;      // (n_time * n_particle) N
};

// F = sum over the grain's throats of S p_c R^2 n. PRESSURE is p_c in Pa, times any
// scale; liquid under suction pulls the grain towards it. n_time >= 2. The caller frees
// with protocol_free.
struct protocol make_protocol(const struct network *network,
                              const struct drying_record *drying,
                              const struct patch *patches, int n_patch, double pressure,
                              int n_time);
void protocol_free(struct protocol *protocol);

#endif
