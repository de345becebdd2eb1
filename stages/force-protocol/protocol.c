// SPDX-License-Identifier: GPL-3.0-or-later
#include "protocol.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// The liquid between two steps of the drying.
struct interval {
    const struct drying_record *drying;
    int step;               // from this step to the next
    double *before, *after; // (n_throat) saturations at both
};

static void apply_changes(const struct drying_record *drying, int step,
                          double *saturation)
{
    for (int64_t k = drying->offset[step]; k < drying->offset[step + 1]; k++)
        saturation[drying->throat[k]] = drying->throat_saturation[k];
}

static void advance(struct interval *interval)
{
    apply_changes(interval->drying, interval->step + 1, interval->before);
    interval->step++;
    if (interval->step + 1 < interval->drying->n_step)
        apply_changes(interval->drying, interval->step + 1, interval->after);
}

static void add_forces(const struct network *network, const struct patch *patches,
                       int n_patch, double pressure, const struct interval *interval,
                       double share, struct vector *force)
{
    for (int k = 0; k < n_patch; k++) {
        const double before = interval->before[patches[k].throat];
        const double after = interval->after[patches[k].throat];
        const double saturation = before + share * (after - before);
        const double radius = network->packing.radius[patches[k].particle];
        struct vector *on = &force[patches[k].particle];
        *on =
            add(*on, scale(saturation * pressure * radius * radius, patches[k].normal));
    }
}

static struct interval begin(const struct network *network,
                             const struct drying_record *drying)
{
    struct interval interval = {.drying = drying,
                                .before = NEW_ARRAY(double, network->n_throat),
                                .after = NEW_ARRAY(double, network->n_throat)};
    for (int t = 0; t < network->n_throat; t++)
        interval.before[t] = network->throat_kind[t] == THROAT_NETWORK;
    apply_changes(drying, 0, interval.before);
    memcpy(interval.after, interval.before, (size_t)network->n_throat * sizeof(double));
    if (drying->n_step > 1) apply_changes(drying, 1, interval.after);
    return interval;
}

// How far TIME lies between the steps of the interval, 0 to 1.
static double share_of(const struct interval *interval, double time)
{
    const struct drying_record *drying = interval->drying;
    const int next = interval->step + 1;
    if (next >= drying->n_step) return 0;
    const double length = drying->time[next] - drying->time[interval->step];
    return length > 0 ? (time - drying->time[interval->step]) / length : 1;
}

struct protocol make_protocol(const struct network *network,
                              const struct drying_record *drying,
                              const struct patch *patches, int n_patch, double pressure,
                              int n_time)
{
    const size_t n_particle = (size_t)network->packing.n_particle;
    struct protocol protocol = {
        .n_time = n_time,
        .time = NEW_ARRAY(double, n_time),
        .saturation = NEW_ARRAY(double, n_time),
        .force = NEW_ARRAY(struct vector, (size_t)n_time * n_particle)};
    const double end = drying->time[drying->n_step - 1];
    struct interval interval = begin(network, drying);
    for (int m = 0; m < n_time; m++) {
        const double time = m + 1 < n_time ? end * m / (n_time - 1) : end;
        while (interval.step + 1 < drying->n_step &&
               drying->time[interval.step + 1] <= time)
            advance(&interval);
        const double share = share_of(&interval, time);
        const double before = drying->saturation[interval.step];
        const double after = interval.step + 1 < drying->n_step
                                 ? drying->saturation[interval.step + 1]
                                 : before;
        protocol.time[m] = time;
        protocol.saturation[m] = before + share * (after - before);
        add_forces(network, patches, n_patch, pressure, &interval, share,
                   protocol.force + (size_t)m * n_particle);
    }
    free(interval.before);
    free(interval.after);
    return protocol;
}

void protocol_free(struct protocol *protocol)
{
    free(protocol->time);
    free(protocol->saturation);
    free(protocol->force);
    *protocol = (struct protocol){0};
}
