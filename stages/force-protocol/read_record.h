// SPDX-License-Identifier: GPL-3.0-or-later
// Reads what the forces need from a drying artifact.
#pragma once

#include "artifacts/artifact.h"
#include "liquid_loads.h"

// The record of INPUT, a drying of NETWORK, with the pressures of its snapshots if
// FIELD, and its rings if RINGS, in SI. Ends the program with status 65 if they or the
// history are missing. The caller frees it with free_record; INPUT may be closed
// before. All of the history is in memory then.
struct liquid_record read_record(const struct artifact *input,
                                 const struct network *network, bool field, bool rings);
void free_record(struct liquid_record *record);
