// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that may be stopped, and go on to the same bytes.
#ifndef CRAQUELURE_DRY_RESUME_H
#define CRAQUELURE_DRY_RESUME_H

#include "run.h"

// Asks KEEPER (NULL: nobody) whether to keep the state of RUN; it may not return. Where
// the liquid is viscous, at every so many steps, at which all runs forget what only
// makes them faster.
void keep_if_due(struct run *run, const struct keeper *keeper);

// RUN, made for the start of the same network and conditions, goes on from STREAM.
// STATUS_BAD_DATA: STREAM is not of such a run.
enum status go_on_from(struct run *run, const struct kept_state *kept,
                       struct reason *reason);

#endif
