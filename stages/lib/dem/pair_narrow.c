// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweep for every processor: 4 pairs at once.
#define LANES 4
#define PAIR_SWEEP pair_sweep_narrow
#include "dem/pair_kernel.h"
