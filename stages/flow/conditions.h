// SPDX-License-Identifier: GPL-3.0-or-later
// What drives the flow, as the user says it.
#ifndef CRAQUELURE_FLOW_CONDITIONS_H
#define CRAQUELURE_FLOW_CONDITIONS_H

#include "pressures.h"

enum { ALONG_NONE = 3 };

struct imposed {
    int along;   // axis in which the pressure falls, or ALONG_NONE
    double drop; // Pa over the box
    double pressure[WALL_COUNT], flux[WALL_COUNT]; // Pa, m3/s; NAN: not imposed
};

// In the units of the computation, for a fluid of VISCOSITY. STATUS_BAD_DATA: two
// things are imposed on one wall, or one on a side that repeats.
enum status find_conditions(const struct grains *grains, const struct imposed *imposed,
                            double viscosity, struct conditions *conditions,
                            struct reason *reason);

// Nothing but a pressure that falls by DROP along AXIS.
struct conditions fall_along(const struct grains *grains, int axis, double drop);

#endif
