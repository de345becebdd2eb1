// SPDX-License-Identifier: GPL-3.0-or-later
// From what is known of the air flow to the thickness of the boundary layer:
//     Re = u L / nu,   Sc = nu / delta,
//     Sh = 0.664 Re^(1/2) Sc^(1/3)     along a plate [K 3.6], up to Re = 5e5
//     Sh = 2 + 0.6 Re^(1/2) Sc^(1/3)   around a sphere (Ranz and Marshall 1952), to 200
//     beta = Sh delta / L,   epsilon = delta / beta.
// The trap: K prints the inverse of Sc.
#include "mass_transfer.h"

#include <math.h>

static enum status check_range(double reynolds, double most, struct reason *reason)
{
    if (reynolds <= most) return STATUS_OK;
    return refuse(
        reason, STATUS_BAD_DATA,
        "boundary_layer.air_velocity: must keep Re = u L / nu at or below %g, "
        "where the correlation ends, got Re = %g",
        most, reynolds);
}

static enum status find_sherwood(enum transfer_law law, const struct air_flow *flow,
                                 double diffusivity, struct mass_transfer *transfer,
                                 struct reason *reason)
{
    transfer->sherwood = flow->sherwood;
    if (law == TRANSFER_SHERWOOD) return STATUS_OK;
    transfer->reynolds = flow->velocity * flow->length / flow->kinematic_viscosity;
    transfer->schmidt = flow->kinematic_viscosity / diffusivity;
    const double flows = sqrt(transfer->reynolds) * cbrt(transfer->schmidt);
    if (law == TRANSFER_PLATE) {
        transfer->sherwood = 0.664 * flows; // [K 3.6]
        return check_range(transfer->reynolds, 5e5, reason);
    }
    transfer->sherwood = 2 + 0.6 * flows;
    return check_range(transfer->reynolds, 200, reason);
}

enum status find_mass_transfer(enum transfer_law law, const struct air_flow *flow,
                               double diffusivity, struct mass_transfer *transfer,
                               struct reason *reason)
{
    *transfer = (struct mass_transfer){0};
    if (law == TRANSFER_COEFFICIENT) {
        transfer->coefficient = flow->coefficient;
    } else if (law == TRANSFER_THICKNESS) {
        transfer->coefficient = diffusivity / flow->thickness;
    } else {
        const enum status status =
            find_sherwood(law, flow, diffusivity, transfer, reason);
        if (status) return status;
        transfer->coefficient = transfer->sherwood * diffusivity / flow->length;
    }
    transfer->thickness = diffusivity / transfer->coefficient;
    if (isnormal(transfer->thickness) && isnormal(transfer->coefficient))
        return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "boundary_layer: must have a finite thickness above 0, got %g m",
                  transfer->thickness);
}
