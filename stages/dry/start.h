// SPDX-License-Identifier: GPL-3.0-or-later
// A network that holds less liquid at the start than it could.
#ifndef CRAQUELURE_START_H
#define CRAQUELURE_START_H

#include "phases.h"

// What is left in each throat (n_throat; 0 where none takes part) when gas has come in
// through the nodes that are exposed, always into the throat it enters most easily of
// those it touches, until the liquid is SATURATION of all; the last throat only in
// part. Liquid that gas cuts off may leave all the same (a film leads it away). PHASES
// is full. The caller frees the result.
double *invaded_saturations(const struct phases *phases, double saturation);

// The state of a run when the liquid was SATURATION of all, between two steps linear in
// time as the run was. Starts at step 0 from a full NETWORK with what changed then.
// The caller frees the result.
struct drying_record {
    int n_step;
    const double *saturation;        // (n_step) of the network
    const int64_t *offset;           // (n_step+1) as in struct drying_history
    const int32_t *throat;           // (offset[n_step])
    const double *throat_saturation; // (offset[n_step])
};
double *recorded_saturations(const struct network *network,
                             const struct drying_record *record, double saturation);

// Takes from full PHASES what is not in START (n_throat, each from 0 to 1).
void start_from(struct phases *phases, const double *start);

#endif
