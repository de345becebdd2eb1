// SPDX-License-Identifier: GPL-3.0-or-later
#define LANES 4
#define ROWS 4
#define UPDATE_NAME block_update_narrow
#include "block_kernel.h"
