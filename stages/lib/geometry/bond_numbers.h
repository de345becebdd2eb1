// SPDX-License-Identifier: GPL-3.0-or-later
// Bond numbers: how much weight matters beside the suction of the liquid.
#pragma once

static const double GRAVITY_OF_THE_EARTH = 9.80665; // m/s2
static const double WEIGHT_MATTERS = 0.05; // from this Bond number on stages warn

// NAN where nothing pulls.
struct bond_numbers {
    double grain; // weight of the mean grain over the largest force on any grain
    double body;  // pressure of grains and liquid on their base, over the suction
};
