// SPDX-License-Identifier: GPL-3.0-or-later
// The rings of liquid that throats left around contacts, and how they dried, as
// schemas/drying.json keeps them.
#pragma once

#include "network/drying_record.h"

// n = 0: none are known.
struct ring_record {
    int n;
    int32_t *face;                // (n)
    double *separation;           // (n) m
    int64_t *offset;              // (n+1) parts
    int32_t *throat;              // (offset[n])
    double *volume;               // (offset[n]) m3
    struct drying_record changes; // of nodes, in place of throats; without times
};

// (n_throat of NETWORK) What each throat leaves in its parts of rings, m3, while these
// are whole. The caller frees it.
double *ring_parts(const struct ring_record *rings, const struct network *network);

// Frees what it owns and empties it.
void ring_record_free(struct ring_record *rings);

// What ring R holds, m3, of the parts that emptied throats left in it: SATURATION
// (n_throat) of throats, OF_RINGS (n_node) of the rings at nodes, both at one step.
double ring_volume(const struct ring_record *rings, const struct network *network,
                   int r, const double *saturation, const double *of_rings);
