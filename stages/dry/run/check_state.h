// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the parts of a state that was read fit each other. The stream sees that a
// number lies in its bounds (checkpoint/stream.h); what one says of another must hold
// as well, for the run trusts it: who is in a list once, who counts whom, which two
// point at each other.
#ifndef CRAQUELURE_DRY_CHECK_STATE_H
#define CRAQUELURE_DRY_CHECK_STATE_H

#include "run.h"

bool run_fits(const struct run *run);

#endif
