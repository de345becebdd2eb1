// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage takes: seconds of one core, memory and disk, foreseen from the sizes of
// what it works on and from constants that were measured on one machine (costs.c). Pure
// functions.
#pragma once

#include <stdbool.h>

// Sizes of a body. Of a cube of irregular grains with their own pore network all follow
// from the number of grains (body_of_grains); an artifact knows better.
struct body_size {
    double grains;
    double unmerged;  // throats of the diagram
    double throats;   // of the merged network
    double face;      // nodes of the open side, which the front grows with
    double changes;   // rows of /changes of the drying
    double loads;     // rows of the forces
    double snapshots; // of the replay
};

// SECONDS is to be expected. LEAST and MOST differ from it where the number of time
// steps or iterations is found only by running.
struct cost {
    double seconds, least, most; // of one core, user and system
    double mebibytes;            // at most at once
    double disk;                 // MiB of the artifact it writes
};

// CHANGES, LOADS and SNAPSHOTS stay 0.
struct body_size body_of_grains(double grains);

// The same with so many THROATS of the merged network, as lattices have fewer.
struct body_size body_with_throats(struct body_size body, double throats);

// Rows of /changes that a drying records: each step has the throats that lose liquid. A
// step is an event, or a fall of the saturation by INTERVAL; NAN: as dry chooses.
double recorded_changes(const struct body_size *body, double interval);

// Grains placed where they stay, or moved: under gravity, by compression from loose
// points, by overlaps that push them apart, or by relaxation without inertia.
enum moving {
    MOVING_NOT,
    MOVING_BY_GRAVITY,
    MOVING_BY_COMPRESSION,
    MOVING_BY_OVERLAPS,
    MOVING_BY_RELAXATION
};
struct cost cost_of_packing(double grains, enum moving moving);

struct cost cost_of_tessellation(double grains);
struct cost cost_of_merging(const struct body_size *body);

// With the rows of BODY recorded. KELVIN: menisci lower the vapour pressure. EXACT:
// without a tolerance. STEP above 0: vapour that is kept until errors may add up to
// this share of the rate.
struct cost cost_of_drying(const struct body_size *body, bool kelvin, bool exact,
                           double step);

// dry.vapour_step by default with so many nodes on the open walls, without films: above
// 0 where it takes less time than the vapour at each event, and there are more than
// 1000 such nodes. In deep bodies it takes longer, as all of the gas is found again.
double default_vapour_step(double open_nodes, double throats);

// What the flow of viscous liquid adds, found at each event, or KEPT for a while.
struct cost with_viscous_flow(struct cost drying, const struct body_size *body,
                              bool kept);

// What rings around contacts add to a drying, and with FILMS the flow in films, found
// again when the saturation has fallen by STEP; 0: at each event.
struct cost with_rings(struct cost drying, const struct body_size *body, bool films,
                       double step);

// What eliminating a boundary layer of so many LAYERS over the COLUMNS of the open side
// adds.
struct cost with_boundary_layer(struct cost drying, double columns, double layers);

struct cost cost_of_forces(const struct body_size *body);

// BODY->loads loads by CYCLES time steps each after RAMP; by up to MOST until they are
// at rest (MOST = CYCLES: exactly so many).
struct cost cost_of_cycles(const struct body_size *body, double ramp, double cycles,
                           double most);
// A packing that drains: LEAST time steps each, in which gas enters, and up to REST
// more.
struct cost cost_of_drainage(const struct body_size *body, double ramp, double least,
                             double rest);
struct cost cost_of_equilibria(const struct body_size *body, bool friction);

// SYSTEMS of pressures solved, one for each flow.
struct cost cost_of_flow(double grains, int systems);

// Discrete elements of any scene.
struct motion_size {
    double grains, steps;
    double snapshots, contacts; // recorded in a snapshot; 0: none
    bool turns, wet;            // friction, bonds or rolling; liquid bridges
};
struct cost cost_of_motion(const struct motion_size *motion);
