// SPDX-License-Identifier: GPL-3.0-or-later
// What the user may say to dry.
#ifndef CRAQUELURE_DRY_PARAMETERS_H
#define CRAQUELURE_DRY_PARAMETERS_H

#include "drying.h"
#include "mass_transfer.h"
#include "network/throat_radius.h"
#include "parameters/parameters.h"

enum { RADII_OF_NETWORK }; // the choices that follow are those of enum radius_law
enum { EXCHANGE_LATTICE, EXCHANGE_LUMPED };

struct dry_parameters {
    struct drying_conditions conditions;
    struct number_list snapshots;
    struct air_flow air;
    int liquid, distribution, transfer_law, exchange, feet;
    int enclosed; // throats that others imposed empty have shut in
    int64_t layers, seed;
    unsigned open_walls, imposed_empty;
    struct radius_distribution radii;
};

extern const struct parameter dry_table[];

// Gives the conditions what was not read right into them, and what NETWORK decides.
void complete_conditions(struct dry_parameters *parameters,
                         const struct network *network);

#endif
