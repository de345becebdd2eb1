// SPDX-License-Identifier: GPL-3.0-or-later
// All forces of a protocol, for tests that look at them beside each other.
#pragma once

#include "basics/memory.h"
#include "force-protocol/protocol.h"

#include <string.h>

// The protocol when it has come to its end; ALL (n_time * n_particle) has the forces at
// every time. The caller frees both.
static inline struct protocol whole_protocol(const struct process *process,
                                             const double *time, int n_time,
                                             struct vector **all)
{
    const size_t n = (size_t)process->network->packing.n_particle;
    struct protocol protocol = protocol_begin(process, time, n_time);
    *all = NEW_ARRAY(struct vector, (size_t)n_time * n);
    while (protocol_next(&protocol))
        memcpy(*all + (size_t)protocol.row * n, protocol.force, n * sizeof **all);
    return protocol;
}
