// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that nothing held at the end.
#pragma once

#include "replay_engine.h"

// Counts those that HAVE LEFT (n_particle) in the response of RUN: as detached if they
// had a bond. The first of these is FIRST, or the lowest where FIRST had no bond or is
// -1.
void count_detached(struct run *run, const bool *have_left, int first);
