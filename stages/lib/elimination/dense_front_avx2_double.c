// SPDX-License-Identifier: GPL-3.0-or-later
#define NUMBER double
#define BYTES 32
#define TILE_ROWS 4
#define VECTORS 2
#define PASS dense_front_pass_avx2_double
#define GATHER dense_front_gather_avx2_double
#include "dense_front_kernel.h"
