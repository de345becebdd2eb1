// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of dry. The table reads into `given` (what several stages share) and
// into `conditions`; what depends on the network, or on another parameter, is filled in
// afterwards by complete_conditions. NAN: not given.
//
// Order of use: stage_begin with dry_table; complete_conditions once the network is
// read; give_radii and shutting of throats before anything is made from radii (main.c).
#pragma once

#include "dry/gas/mass_transfer.h"
#include "dry/run/drying.h"
#include "network/drawn_radii.h"
#include "parameters/conditions.h"
#include "parameters/parameters.h"

// The choices of boundary_layer.exchange, in their order.
enum { EXCHANGE_LATTICE, EXCHANGE_LUMPED };

// Members that are int hold the place of a choice in the table. SHUT and ENCLOSED are
// counted by main.
struct dry_parameters {
    struct conditions given; // liquid and air, as the user gave them
    struct drying_conditions conditions;
    struct number_list snapshots;
    double snapshot_interval;
    double *even_snapshots; // by snapshot_interval, in place of the list; NULL: none
    struct air_flow air;
    int liquid, transfer_law, exchange, feet, rings;
    int shut;     // throats without clearance
    int enclosed; // throats cut off from all others by these and those imposed empty
    int64_t layers;
    unsigned open_walls, imposed_empty;
    struct drawn_radii radii;
};

// Fills a struct dry_parameters but for .even_snapshots, .shut and .enclosed, and for
// what complete_conditions writes to .conditions.
extern const struct parameter dry_table[];

// Completes .conditions from the parameters that were not read directly into them and
// from NETWORK, which decides defaults. The caller frees .even_snapshots.
// STATUS_BAD_DATA as conditions_complete. .conditions points into .snapshots and
// .even_snapshots: the struct must not be moved.
enum status complete_conditions(struct dry_parameters *parameters,
                                const struct network *network, struct reason *reason);

// films.step and flow_step, or their defaults in a network of so many THROATS.
double film_step(const struct dry_parameters *parameters, double throats);
double flow_step(const struct dry_parameters *parameters, double throats);

// The same for vapour_step, with so many nodes on the open walls as well.
double vapour_step(const struct dry_parameters *parameters, double open_nodes,
                   double throats);
