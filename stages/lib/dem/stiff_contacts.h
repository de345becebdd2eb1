// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff grains are beside bonds. Stiffer contacts only shorten the time step:
// bodies of 300 and 1000 settled grains broke as many bonds, within their scatter, with
// ratios from 10 to 100, and with 760 most loads did not come to rest
// (docs/your-grains.md).
#pragma once

#include <math.h>

static const double GRAIN_OVER_BOND = 50;        // that is enough
static const double STIFF_GRAIN_OVER_BOND = 100; // from which on stages say so

// N/m, of a bond with the stiffness PER AREA, N/m3, between grains of RADIUS whose neck
// has the share FRACTION of it.
static inline double stiffness_of_bond(double per_area, double fraction, double radius)
{
    const double neck = fraction * radius;
    return per_area * M_PI * neck * neck;
}
