// SPDX-License-Identifier: GPL-3.0-or-later
#define NUMBER float
#define BYTES 32
#define TILE_ROWS 4
#define VECTORS 2
#define PASS triangle_pass_narrow_float
#define GATHER triangle_gather_narrow_float
#include "dense_front_kernel.h"
