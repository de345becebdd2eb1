// SPDX-License-Identifier: GPL-3.0-or-later
// One patch of volumes of a table, from exact solutions; for the files that make
// tables.
#ifndef CRAQUELURE_BRIDGE_TABLE_MAKE_H
#define CRAQUELURE_BRIDGE_TABLE_MAKE_H

#include "bridges/equilibrium.h"
#include "bridges/table_layout.h"

// The patch PATCH of bridges between BODIES: how gaps become zeta, where in zeta they
// rupture (END; 0 everywhere: at zeta 0) and the forces. If TO_RUPTURE zeta is 0 where
// a bridge ruptures, also where its symmetry breaks before the turning point. Returns
// STATUS_OK or STATUS_NOT_CONVERGED.
enum status make_patch(const struct bodies *bodies, int patch, bool to_rupture,
                       struct volume_patch *at, double end[ORDER],
                       eight force[PLACES][2]);

#endif
