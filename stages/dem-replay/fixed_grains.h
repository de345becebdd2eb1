// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains are held fixed: they neither move nor rotate.
#pragma once

#include "basics/status.h"
#include "geometry/packing.h"
#include "parameters/parameters.h"

// The union of these. Numbers count from 0; lengths in m. A grain on the surface of the
// region is in it.
struct fixed_grains {
    unsigned walls;            // bit k: the grains that touch wall k of the box
    struct number_list grains; // by number
    double lower[3], upper[3]; // grains with their centres in here; NAN: none
};

// *IS_HELD (n_particle) becomes 1 for each fixed grain and 0 elsewhere; the caller
// frees it. STATUS_BAD_DATA, with the key in the reason, and nothing allocated: a wall
// where the box is periodic, a grain that does not exist, only one corner of a region,
// or an upper corner below the lower.
// Touching is to 1e-6 of the radius, or beyond the wall. Nothing given: no grain is
// held.
enum status find_fixed_grains(const struct packing *packing,
                              const struct fixed_grains *held, uint8_t **is_held,
                              struct reason *reason);
