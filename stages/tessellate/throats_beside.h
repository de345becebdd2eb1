// SPDX-License-Identifier: GPL-3.0-or-later
// Look-up of throats in a network whose throats are sorted by their nodes, as
// tessellate writes them.
#pragma once

#include "network/network.h"

// The first throat whose nodes do not come before these two.
int first_throat_between(const struct network *network, const int32_t ends[2]);

// Whether one of GRAINS (n_particle) is beside each throat (n_throat): whether the
// throat is an edge of a face of such a grain. The caller frees it. O(corners log
// n_throat).
bool *throats_beside(const struct network *network, const bool *grains);
