// SPDX-License-Identifier: GPL-3.0-or-later
// How a network dried, step by step, as schemas/drying.json keeps it.
#pragma once

#include "network/network.h"

// Times never fall. A throat that no step names keeps its saturation.
struct drying_record {
    int n_step;
    double *time, *saturation; // (n_step) s; of the network
    int64_t *offset;           // (n_step+1) into the two below
    int32_t *throat;           // (offset[n_step]) whose saturation changes in a step
    double *throat_saturation; // (offset[n_step]) to what, linearly in time
};

// Frees what it owns and empties it.
void drying_record_free(struct drying_record *record);

// Saturation (n_throat) of each throat before the first step: 1, of those that cannot
// hold liquid 0. The caller frees it.
double *full_saturations(const struct network *network);

// Brings SATURATION (n_throat) from the end of the step before to the end of STEP.
// Steps must be taken one after the other from 0, on what full_saturations gives.
// O(changes of the step).
void apply_changes(const struct drying_record *record, int step, double *saturation);
