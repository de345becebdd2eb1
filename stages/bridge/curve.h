// SPDX-License-Identifier: GPL-3.0-or-later
// Force against separation of one bridge, as JSON.
#pragma once

#include "basics/status.h"
#include "bridges/bridges.h"

#include <jansson.h>

// COUNT separations (m), and the number of points of each meridian to report (0: none),
// which only the exact solution has.
struct curve_request {
    const double *separation;
    int count;
    int profile;
};

// Adds "separation", "force" and "flags", lists of COUNT, to REPORT, and for the exact
// solution also "suction", "neck_radius", "half_filling_angle", "contact_radius",
// "wetted_area", "free_area", "energy" and, with request->profile, "profile" (null for
// the other models); where there is no bridge these hold null and the force is 0.
// Returns STATUS_NOT_CONVERGED if one equilibrium was not found, STATUS_BAD_DATA if the
// bridge is none.
enum status put_curve(json_t *report, const struct bridge *bridge,
                      enum bridge_model model, const struct curve_request *request,
                      struct reason *reason);
