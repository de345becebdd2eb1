// SPDX-License-Identifier: GPL-3.0-or-later
// Places written with too few digits to tell which grains touch.
#pragma once

#include "geometry/packing_check.h"

// Adds a note where places are multiples of a round number above the gap that counts as
// touching (GAP, of the sum of the radii), and grains are apart by less than that
// number, but more than the gap. Not for lattices.
void judge_rounding(const struct packing *packing, const struct packing_facts *facts,
                    double gap, struct findings *findings);
