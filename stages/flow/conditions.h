// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary conditions of the flow, as the user gives them, and in the units of the
// computation: pressures stay in Pa, fluxes become unit^3 Pa for a viscosity of 1.
#pragma once

#include "pressures.h"

enum { ALONG_NONE = 3 };

// A wall with neither pressure nor flux is closed to the flow.
struct imposed {
    int along;   // axis in which the pressure falls, or ALONG_NONE
    double drop; // Pa over the box
    double pressure[WALL_COUNT], flux[WALL_COUNT]; // Pa, m3/s; NAN: not imposed
};

// CONDITIONS in the units of the computation, for a fluid of VISCOSITY (Pa s).
// STATUS_BAD_DATA: two conditions on one wall, or one on a periodic side. The reason
// names the key. A pressure stays in Pa, a flux Q becomes Q viscosity / unit^3.
enum status find_conditions(const struct grains *grains, const struct imposed *imposed,
                            double viscosity, struct conditions *conditions,
                            struct reason *reason);

// Only a pressure that falls by DROP (Pa) along AXIS: between its walls, or as a mean
// gradient in a periodic box.
struct conditions fall_along(const struct grains *grains, int axis, double drop);
