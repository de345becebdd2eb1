// SPDX-License-Identifier: GPL-3.0-or-later
// What forces need to know of a drying, out of its artifact.
#ifndef CRAQUELURE_READ_RECORD_H
#define CRAQUELURE_READ_RECORD_H

#include "artifacts/artifact.h"
#include "liquid_loads.h"

// What INPUT, a drying of NETWORK, says happened, with the pressures of its snapshots
// if FIELD; ends the program when there are none. The caller frees it.
struct liquid_record read_record(const struct artifact *input,
                                 const struct network *network, bool field);
void free_record(struct liquid_record *record);

#endif
