// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweeps for every processor: 4 pairs at once.
#define LANES 4
#define SWEEP_NAME(features) sweep_avx2_##features
#include "dem/pair_kernel.h"
