// SPDX-License-Identifier: GPL-3.0-or-later
// A step names only the throats that change: saturations of step k are those of step
// k - 1 with the changes of step k.
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
