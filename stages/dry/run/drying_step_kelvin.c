// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own: advances to the moment at which a throat
// has emptied or filled, or has changed by saturation_step. The losses are found at the
// end of a step, not at its beginning: the rate that is recorded with the step is
// theirs.
//
// In this order: losses found before are carried out until the first throat has emptied
// or filled; losses for the new menisci; the record; pressures that are due, of viscous
// liquid, which belong to the new losses. begin_run finds the first losses, and a
// checkpoint keeps them. Once all is dry there are none to find, and the rate is 0.
// Throats may also gain by condensation, so steps without one that has emptied are
// counted (note_idle).
#include "run.h"

// Viscous liquid couples flow and vapour in one solution; inviscid and immobile liquid
// needs the vapour alone.
enum status find_kelvin_losses(struct run *run, struct reason *reason)
{
    if (run->conditions->liquid != LIQUID_VISCOUS)
        return kelvin_menisci_find(&run->kelvin, &run->occupancy, &run->losses, reason);
    run->flow.wants_pressures = snapshot_is_due(run);
    return kelvin_viscous_find(&run->coupling, &run->occupancy, &run->losses, reason);
}

enum status drying_step_kelvin(struct run *run, struct reason *reason)
{
    struct occupancy *occupancy = &run->occupancy;
    if (run->losses.n == 0) return refuse_standstill(run, reason);
    const int n_before = occupancy->n_liquid;
    carry_out_losses(run);
    run->n_flow_step++;
    if (occupancy->n_liquid > 0) {
        const enum status status = find_kelvin_losses(run, reason);
        if (status) return status;
    }
    record_losses(run);
    if (occupancy->n_liquid > 0) keep_pressures(run);
    return note_idle(run, occupancy->n_liquid == n_before, reason);
}
