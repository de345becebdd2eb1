// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that determines the forces of one run.
//
// Bundled because everything that makes forces needs all four: protocol.h (row by row),
// times.h (which rows), interpolation.h (how good they are). All must live as long as
// what is made from them.
#pragma once

#include "throat_loads.h"

// It owns nothing.
struct process {
    const struct network *network;
    const struct liquid_record *record;
    const struct suction_law *law;
    const struct throat_loads *loads;
};
