// SPDX-License-Identifier: GPL-3.0-or-later
// Whether bonds join the grains to one body, and what supports it.
#pragma once

#include "geometry/packing_check.h"

struct bond_facts {
    int without;   // grains that have no bond
    int pieces;    // that bonds join, single grains included
    int largest;   // grains in the largest of them
    int at_bottom; // grains that touch the lower z wall
    int supported; // grains that bonds join to these, themselves included
    double gap;    // touching_gap that joins most grains; NAN: they are, or none does
};

// The facts of PACKING; auxiliary grains do not count. O(n) but for the search of gap.
// GAP is that at which one piece would have 95 % of the grains; searched up to 0.5.
struct bond_facts bond_facts(const struct packing *packing);

// Adds to FINDINGS what these FACTS of bonds mean; PACKED are the other facts.
// Nothing is said of fewer than two grains.
void judge_bonds(const struct packing *packing, const struct packing_facts *packed,
                 const struct bond_facts *facts, struct findings *findings);
// The same of the grains that dem-replay holds by default.
void judge_support(const struct packing *packing, const struct packing_facts *packed,
                   const struct bond_facts *facts, struct findings *findings);
