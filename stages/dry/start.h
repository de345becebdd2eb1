// SPDX-License-Identifier: GPL-3.0-or-later
// A network that holds less liquid at the start than it could.
#ifndef CRAQUELURE_START_H
#define CRAQUELURE_START_H

#include "phases.h"

// LEFT (n_throat; 0 where none takes part): what is left in each throat when gas has
// come in through the nodes that are exposed, always into the throat it enters first of
// those it touches, until the liquid is SATURATION of all; the last throat only in
// part. With TRAPPING liquid leaves only through the closed walls opposite the open
// ones, and what gas has cut off from them stays (network/invasion.h); else it leaves
// all the same (a film leads it away). PHASES is full.
//
// STATUS_BAD_DATA with trapping: no throat reaches such a wall; more stays.
enum status invaded_saturations(const struct phases *phases, double saturation,
                                bool trapping, double *left, struct reason *reason);

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
