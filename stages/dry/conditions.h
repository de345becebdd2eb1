// SPDX-License-Identifier: GPL-3.0-or-later
// What can be dried, under which conditions, and the units it is computed in.
#ifndef CRAQUELURE_CONDITIONS_H
#define CRAQUELURE_CONDITIONS_H

#include "dry/run/drying.h"

// Scaled units: the mean throat length is 1, the density of the liquid is 1, and so is
// the fall of the vapour's potential from saturation to the drying air.
struct drying_scale {
    double length;         // m
    double mass;           // kg
    double rate;           // kg/s
    double time;           // s
    double boundary_layer; // its thickness in mean throat lengths
};

// STATUS_BAD_DATA with the key, the rule and the value if the conditions are
// impossible.
enum status check_conditions(const struct drying_conditions *conditions,
                             struct reason *reason);

// STATUS_BAD_DATA with the dataset, the row, the rule and the value if a throat that
// takes part has no length, no radius, or both its ends on one node, or if none takes
// part.
enum status check_throats(const struct network *network, struct reason *reason);

// Every event of more throats than this is not recorded: the changes, about half the
// throats to the power of 1.7 of them, would take more than 2 GB.
enum { MOST_RECORDED_THROATS = 100000 };

// Those that take part.
int count_throats(const struct network *network);

// STATUS_BAD_DATA if every event of a network so large would be recorded.
enum status check_steps(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason);

// STATUS_BAD_DATA if time would leave the range of numbers.
enum status check_scale(const struct drying_conditions *conditions,
                        const struct network *network, struct reason *reason);

// Both arguments must have passed their checks.
struct drying_scale drying_scale(const struct network *network,
                                 const struct drying_conditions *conditions);

// Radius of the throat, in m, in which a molecule of vapour is held up as much by the
// wall as by the gas: D_K = (2/3) r sqrt(8 R T / (pi M)) is the diffusivity. 0 without
// the Knudsen effect.
double knudsen_radius(const struct drying_conditions *conditions);

#endif
