// SPDX-License-Identifier: GPL-3.0-or-later
// A network that holds less liquid at the start than it could.
#ifndef CRAQUELURE_INITIAL_SATURATION_H
#define CRAQUELURE_INITIAL_SATURATION_H

#include "dry/liquid/occupancy.h"
#include "network/drying_record.h"

// LEFT (n_throat; 0 where none takes part): what is left in each throat when gas has
// come in through the nodes that are exposed, always into the throat it enters first of
// those it touches, until the liquid is SATURATION of all; the last throat only in
// part. With TRAPPING liquid leaves only through the closed walls opposite the open
// ones, and what gas has cut off from them stays (network/invasion.h); else it leaves
// all the same (a film leads it away). OCCUPANCY is full.
//
// STATUS_BAD_DATA with trapping: no throat reaches such a wall; more stays.
enum status invaded_saturations(const struct occupancy *occupancy, double saturation,
                                bool trapping, double *left, struct reason *reason);

// The state of a run when the liquid was SATURATION of all, between two steps linear in
// time as the run was. The caller frees the result.
double *recorded_saturations(const struct network *network,
                             const struct drying_record *record, double saturation);

// Takes from full OCCUPANCY what is not in START (n_throat, each from 0 to 1).
void start_from(struct occupancy *occupancy, const double *start);

#endif
