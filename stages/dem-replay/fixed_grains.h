// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains are held: they neither move nor turn.
#ifndef CRAQUELURE_FIXED_GRAINS_H
#define CRAQUELURE_FIXED_GRAINS_H

#include "basics/status.h"
#include "geometry/packing.h"
#include "parameters/parameters.h"

// All of these together.
struct fixed_grains {
    unsigned walls;            // bit k: the grains that touch wall k of the box
    struct number_list grains; // by number
    double lower[3], upper[3]; // grains with their centres in here; NAN: none
};

// 1 for each grain that is held, (n_particle), that the caller frees. STATUS_BAD_DATA:
// a grain that does not exist, or half a region.
enum status find_fixed_grains(const struct packing *packing,
                              const struct fixed_grains *held, uint8_t **is_held,
                              struct reason *reason);

#endif
