// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/drawn_radii.h"

enum status give_radii(struct network *network, const struct drawn_radii *radii,
                       struct reason *reason)
{
    if (radii->law == 0) return STATUS_OK;
    struct radius_distribution how = radii->how;
    how.law = (enum radius_law)(radii->law - 1);
    how.seed = (unsigned long)radii->seed;
    return draw_radii(network, &how, reason);
}
