// SPDX-License-Identifier: GPL-3.0-or-later
#define BYTES 32
#define NAMED(name) name##_narrow
#include "joint_lanes_of.h"
