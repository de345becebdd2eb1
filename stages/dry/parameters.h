// SPDX-License-Identifier: GPL-3.0-or-later
// What the user may say to dry.
#ifndef CRAQUELURE_DRY_PARAMETERS_H
#define CRAQUELURE_DRY_PARAMETERS_H

#include "dry/gas/mass_transfer.h"
#include "dry/run/drying.h"
#include "network/drawn_radii.h"
#include "parameters/conditions.h"
#include "parameters/parameters.h"

enum { EXCHANGE_LATTICE, EXCHANGE_LUMPED };

struct dry_parameters {
    struct conditions given; // what the conditions get liquid and air from
    struct drying_conditions conditions;
    struct number_list snapshots;
    double snapshot_interval;
    double *even_snapshots; // in place of the list; NULL: none
    struct air_flow air;
    int liquid, transfer_law, exchange, feet;
    int shut;     // throats without clearance
    int enclosed; // throats that those, and others imposed empty, have shut in
    int64_t layers;
    unsigned open_walls, imposed_empty;
    struct drawn_radii radii;
};

extern const struct parameter dry_table[];

// Gives the conditions what was not read right into them, and what NETWORK decides. The
// caller frees .even_snapshots. STATUS_BAD_DATA as conditions_complete.
enum status complete_conditions(struct dry_parameters *parameters,
                                const struct network *network, struct reason *reason);

#endif
