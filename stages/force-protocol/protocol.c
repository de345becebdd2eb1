// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on all grains at given times, and how well they represent the drying. The
// force on a grain is the sum over its patches of load times pull (throat_loads.h).
// Those of two times are held: all that is said of them needs no more.
#include "protocol.h"

#include "basics/memory.h"

#include <stdlib.h>

struct protocol protocol_begin(const struct process *process, const double *time,
                               int n_time)
{
    const int n = process->network->packing.n_particle;
    return (struct protocol){
        .process = process,
        .time = time,
        .n_time = n_time,
        .row = -1,
        .force = NEW_ARRAY(struct vector, n),
        .former = NEW_ARRAY(struct vector, n),
        .liquid = liquid_loads_begin(process->network, process->record, process->law),
        .interpolation = interpolation_begin(process, time, n_time)};
}

void protocol_free(struct protocol *protocol)
{
    free(protocol->force);
    free(protocol->former);
    liquid_loads_free(&protocol->liquid);
    interpolation_free(&protocol->interpolation);
    *protocol = (struct protocol){0};
}

bool protocol_next(struct protocol *protocol)
{
    if (protocol->row + 1 >= protocol->n_time) return false;
    const int row = ++protocol->row;
    struct vector *force = protocol->former; // its place, for those of this time
    protocol->former = protocol->force;
    protocol->force = force;
    liquid_loads_to(&protocol->liquid, protocol->time[row]);
    forces_now(protocol->process->loads, &protocol->liquid, force);
    const struct vector *former = row > 0 ? protocol->former : NULL;
    measure_forces(&protocol->measures, &protocol->process->network->packing, force,
                   former);
    if (former) interpolation_follow(&protocol->interpolation, former, force, row);
    return true;
}
