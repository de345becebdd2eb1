// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of the rings that throats leave, beside the history of the throats.
#pragma once

#include "dry/liquid/ring_stores.h"
#include "drying.h"

// A ring consists of parts, which the throats around it leave. What is left of a part
// is the mean saturation of the two nodes of its throat, 1 before the first step: the
// rings at a node dry together, and not before all throats there have emptied.
struct ring_history {
    int n;
    int32_t *face;      // (n) rising
    double *separation; // (n) m
    int64_t *offset;    // (n+1) parts
    int32_t *throat;    // (offset[n])
    double *volume;     // (offset[n]) m3
    int limited;        // as in struct ring_stores

    // As change_offset, change_throat and change_saturation in struct drying_history.
    int64_t *change_offset;    // (n_step+1)
    int32_t *change_node;      // (change_offset[n_step])
    double *change_saturation; // (change_offset[n_step])
    double *saturation;        // (n_step) of the network, of what is in rings alone:
                               // left by throats that have emptied
};

// Takes the changes of rings (n_throat + node) out of those of HISTORY, into
// HISTORY->rings, together with the rings of STORES, whose unit is LENGTH (m). Of the
// run the changes of nodes have the numbers n_throat + node. Once, at the end.
void ring_history_take(struct drying_history *history, const struct network *network,
                       const struct ring_stores *stores, double length);
void ring_history_free(struct ring_history *rings);
