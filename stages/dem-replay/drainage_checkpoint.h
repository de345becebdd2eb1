// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a drainage as named arrays, beside that of the replay
// (replay_checkpoint.h).
//
// Both take the same arrays in the same order, with the names that stand at the top of
// drainage_checkpoint.c. What follows from the packing (pores, their first volumes) is
// not among them: restore needs a drainage that drainage_begin has made.
#pragma once

#include "replay.h"

// Adds DRAINAGE, its HISTORY and what it has filled in of LOAD, for N_PARTICLE grains.
void save_drainage(struct array_list *list, const struct drainage *drainage,
                   const struct drainage_history *history, const struct load *load,
                   int n_particle);

// Reads them back into a drainage of the same packing that has begun. STATUS_BAD_DATA:
// they are not in LIST, or out of range.
enum status restore_drainage(const struct array_list *list, struct drainage *drainage,
                             struct drainage_history *history, const struct load *load,
                             int n_particle, struct reason *reason);
