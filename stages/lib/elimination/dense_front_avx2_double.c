// SPDX-License-Identifier: GPL-3.0-or-later
#define NUMBER double
#define BYTES 32
#define TILE_ROWS 4
#define VECTORS 2
#define PASS triangle_pass_narrow_double
#define GATHER triangle_gather_narrow_double
#include "dense_front_kernel.h"
