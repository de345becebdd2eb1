// SPDX-License-Identifier: GPL-3.0-or-later
// A step names only the throats that change: saturations of step k are those of step
// k - 1 with the changes of step k, and between the two times each throat is linear in
// time. So to have those of a step, begin with full_saturations and apply steps 0, 1,
// ... in order, each once: there is no way back but from the start.
//
// Before step 0 throats of kind THROAT_NETWORK are full (1); those of the boundary
// layer and those imposed empty hold nothing (0). O(n_throat), then O(changes) a step.
#include "network/drying_record.h"

#include "basics/memory.h"

#include <stdlib.h>

void drying_record_free(struct drying_record *record)
{
    free(record->time);
    free(record->saturation);
    free(record->offset);
    free(record->throat);
    free(record->throat_saturation);
    *record = (struct drying_record){0};
}

double *full_saturations(const struct network *network)
{
    double *saturation = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        saturation[t] = network->throat_kind[t] == THROAT_NETWORK;
    return saturation;
}

void apply_changes(const struct drying_record *record, int step, double *saturation)
{
    for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++)
        saturation[record->throat[k]] = record->throat_saturation[k];
}
