// SPDX-License-Identifier: GPL-3.0-or-later
// A network that holds less liquid at the start than it could.
#pragma once

#include "dry/liquid/occupancy.h"
#include "network/drying_record.h"

// Sets LEFT (n_throat; 0 where none takes part) to the saturation of each throat after
// gas has come in through the exposed nodes, always into the easiest throat it touches,
// until the network's saturation is SATURATION; the last throat is emptied in part.
// With TRAPPING liquid leaves only through the closed walls opposite the open ones, and
// what gas has cut off from them stays (network/invasion.h); without, it leaves all the
// same, as through films. OCCUPANCY is full.
//
// STATUS_BAD_DATA with trapping: no throat reaches such a wall; more stays.
enum status invaded_saturations(const struct occupancy *occupancy, double saturation,
                                bool trapping, double *left, struct reason *reason);

// The saturation of each throat (n_throat) in a recorded run when the network's was
// SATURATION: linear between two steps, as the run was. The caller frees the result.
double *recorded_saturations(const struct network *network,
                             const struct drying_record *record, double saturation);

// Likewise of the rings at each node (n_node), by CHANGES of the same steps.
double *recorded_rings(const struct network *network,
                       const struct drying_record *record,
                       const struct drying_record *changes, double saturation);

// Removes liquid from full OCCUPANCY until its throats have the saturations START
// (n_throat, each from 0 to 1), and the rings beside empty ones RINGS (n_node,
// likewise; kept; NULL: 1).
void start_from(struct occupancy *occupancy, const double *start, const double *rings);
