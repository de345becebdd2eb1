// SPDX-License-Identifier: GPL-3.0-or-later
// Floors as rough as the grains, as cut from a thicker packing.
#pragma once

#include "bonds.h"

// Adds a note where hardly a grain touches the lower z wall, so that the box gains void
// there: its porosity, and that of a box which ends at the outermost centres.
void judge_ends(const struct packing *packing, const struct packing_facts *facts,
                const struct bond_facts *bonds, struct findings *findings);
