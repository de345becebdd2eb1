// SPDX-License-Identifier: GPL-3.0-or-later
#define NAMED(name) name##_narrow
#include "joint_lanes_of.h"
