// SPDX-License-Identifier: GPL-3.0-or-later
// Saturations of slices at given times. The drying is replayed once, from step to step;
// within a step every throat is linear in time. The sum over throats is made from
// scratch at each time, so that a dry slice is exactly 0.
//
// The saturation of a slice at `time`, between the steps k and k + 1 of the drying, is
//     share      = (time - t_k) / (t_k+1 - t_k),
//     saturation = sum V_t (before_t + share (after_t - before_t)) / sum V_t
// over throats that take part, with half of each V_t in either slice of its middle.
#include "liquid.h"

#include "basics/memory.h"
#include "count.h"

#include <stdlib.h>
#include <string.h>

double time_of_saturation(const struct liquid *liquid, double level)
{
    const double *saturation = liquid->record.saturation, *time = liquid->record.time;
    int k = 0;
    while (k < liquid->record.n_step && saturation[k] > level)
        k++;
    if (k == 0) return time[0];
    if (k == liquid->record.n_step) return time[k - 1];
    const double share =
        (saturation[k - 1] - level) / (saturation[k - 1] - saturation[k]);
    return time[k - 1] + share * (time[k] - time[k - 1]);
}

// The liquid at one step of the drying and at the next.
struct interval {
    const struct liquid *liquid;
    int step;
    double *before, *after; // (n_throat) saturations
};

static struct interval begin(const struct liquid *liquid)
{
    const struct drying_record *record = &liquid->record;
    double *before = full_saturations(&liquid->network);
    apply_changes(record, 0, before);
    double *after = duplicate(before, (size_t)liquid->network.n_throat, sizeof *before);
    if (record->n_step > 1) apply_changes(record, 1, after);
    return (struct interval){liquid, 0, before, after};
}

static void advance(struct interval *interval)
{
    const struct drying_record *record = &interval->liquid->record;
    apply_changes(record, ++interval->step, interval->before);
    if (interval->step + 1 < record->n_step)
        apply_changes(record, interval->step + 1, interval->after);
}

// The slices of each throat's middle. (n_throat); the caller frees it.
static struct slices *throat_slices(const struct network *network, int n_slice)
{
    struct slices *slice = NEW_ARRAY(struct slices, network->n_throat);
    for (int t = 0; t < network->n_throat; t++) {
        const double z = network->node_position[network->throat_nodes[t][0]].z +
                         0.5 * along_throat(network, t).z;
        slice[t] = slices_at(&network->packing, z, n_slice);
    }
    return slice;
}

// Sums over all throats at each time: a dry slice is exactly 0.
static void sum_slices(const struct interval *interval, double share,
                       const struct slices *in, int n_slice, double *saturation)
{
    const struct network *network = &interval->liquid->network;
    double *full = NEW_ARRAY(double, n_slice);
    for (int s = 0; s < n_slice; s++)
        saturation[s] = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        const double before = interval->before[t], after = interval->after[t];
        const double volume = 0.5 * throat_volume(network, t);
        for (int half = 0; half < 2; half++) {
            full[in[t].slice[half]] += volume;
            saturation[in[t].slice[half]] +=
                volume * (before + share * (after - before));
        }
    }
    for (int s = 0; s < n_slice; s++)
        saturation[s] = full[s] > 0 ? saturation[s] / full[s] : NAN;
    free(full);
}

double *slice_saturations(const struct liquid *liquid, int n_slice, const double *time,
                          int n_time)
{
    const double *at = liquid->record.time;
    const int n_step = liquid->record.n_step;
    double *saturation = NEW_ARRAY(double, (size_t)n_time *(size_t)n_slice);
    struct slices *slice = throat_slices(&liquid->network, n_slice);
    struct interval interval = begin(liquid);
    for (int m = 0; m < n_time; m++) {
        double *row = saturation + (size_t)m * (size_t)n_slice;
        if (m > 0 && time[m] == time[m - 1]) { // cracks of one step of the forces
            memcpy(row, row - n_slice, (size_t)n_slice * sizeof *row);
            continue;
        }
        while (interval.step + 1 < n_step && at[interval.step + 1] <= time[m])
            advance(&interval);
        const int step = interval.step;
        const double length = step + 1 < n_step ? at[step + 1] - at[step] : 0;
        const double share = length > 0 ? (time[m] - at[step]) / length : 0;
        sum_slices(&interval, share, slice, n_slice, row);
    }
    free(interval.before);
    free(interval.after);
    free(slice);
    return saturation;
}

void liquid_free(struct liquid *liquid)
{
    network_free(&liquid->network);
    drying_record_free(&liquid->record);
    *liquid = (struct liquid){0};
}
