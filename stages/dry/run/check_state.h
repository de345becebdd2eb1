// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the parts of a restored state agree with each other. The stream checks that
// each number lies in its bounds (checkpoint/stream.h); the run also relies on
// relations between them: lists without repetition, counts, indices that point at each
// other.
#pragma once

#include "run.h"

// Whether RUN, just restored, is consistent. O(network + history).
bool run_fits(const struct run *run);
