// SPDX-License-Identifier: GPL-3.0-or-later
// One rule each, for all stages that let gas into a network, in one wording. Schemas
// cannot have them, as they hold only for the throats that take part, or link a network
// to a parameter. A capillary pressure 2 sigma / r needs a radius above 0 and finite (a
// NAN fails, too: the test is for what is right). Gravity along z needs a top and a
// bottom: where the box repeats along z, a node would be above and below itself.
#include "network/checks.h"

#include <math.h>

enum status check_throat_radius(const struct network *network, int throat,
                                struct reason *reason)
{
    const double radius = network->throat_radius[throat];
    if (radius > 0 && isfinite(radius)) return STATUS_OK;
    return refuse(
        reason, STATUS_BAD_DATA,
        "/throats/radius: row %d: must be above 0 where the throat takes part, is %g",
        throat, radius);
}

enum status check_gravity(const struct network *network, double gravity,
                          struct reason *reason)
{
    if (gravity == 0 || !network->packing.periodic[2]) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "gravity: must be 0 in a box that is periodic along z, is %g",
                  gravity);
}
