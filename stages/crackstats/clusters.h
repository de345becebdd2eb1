// SPDX-License-Identifier: GPL-3.0-or-later
// Connected cracks: broken bonds that share a grain are one crack.
#pragma once

#include "run.h"
#include "sizes.h"

struct clusters {
    int count;
    int largest;   // broken bonds in it
    bool spans[3]; // along x, y, z: whether any one does
};

// Appends the size of each cluster, in broken bonds, to SIZES. A cluster spans along an
// axis when it has grains within a mean radius of both ends of the aggregate; along a
// periodic axis, when it leads around the box to its own image. Periodic images are
// followed bond by bond. The cracks of RUN are taken at its end, without those of the
// weight alone. Sizes come in the order of the roots. O((grains + cracks) log grains).
struct clusters find_clusters(const struct run *run, struct sizes *sizes);
