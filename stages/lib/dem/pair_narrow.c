// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweeps for every processor: 4 pairs at once.
#define LANES 4
#define PAIR_SWEEPS pair_sweeps_narrow
#include "dem/pair_kernel.h"
