// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of simulate: what the grains are made of, what bounds and drives them,
// for how long, and what is recorded. Members are in the units of the table in
// parameters.c, the user's: SI, but angles of contact in degrees. NAN or NULL stands
// for null, "not given". Rows of named tables are in the order of their names.
//
// stage_begin fills the struct; the caller frees the four named_rows with
// named_rows_free.
#pragma once

#include "dem/dem.h"
#include "parameters/conditions.h"
#include "parameters/parameters.h"

#include <stdbool.h>
#include <stdint.h>

// A row of "materials". NAN: not given. Which members must be given depends on the law
// (check_parameters). Units: kg/m3, Pa for young_modulus, N/m of a grain for both
// stiffnesses; the others are numbers.
struct material_parameters {
    double density, friction, restitution;
    double young_modulus, poisson_ratio;
    double normal_stiffness, shear_stiffness, damping_ratio;
    double rolling_friction, rolling_damping;
};

// A row of "pairs": what two materials do to each other. NAN: the smaller of the two.
// It holds in both orders. Damping of the linear law is not among them: there each
// material has its damping ratio, and a contact the mean of two.
struct pair_parameters {
    const char *first, *second;
    double friction, restitution, rolling_friction;
};

// Factor on a motion at these times (s), linear between them; none: always 1. Times
// rise strictly, and both lists are equally long (check_parameters).
struct time_table {
    struct number_list times, factors;
};

// A row of "walls". NAN: not given. m, m/s, rad/s, N, Pa, m2. NORMAL is a plane's side
// of the grains and an axis of the round shapes. Velocity, spin and servo are those at
// the factor 1 of MOTION.
struct wall_parameters {
    int shape; // enum dem_wall_shape
    double point[3], normal[3], half_edge[3];
    double radius, inner_radius;
    bool outside;
    const char *material; // NULL: rigid
    double friction;
    double velocity[3], spin[3];
    double servo_force, servo_pressure, servo_area, servo_largest_speed;
    struct time_table motion;
};

// A row of "groups". NAN: not given. LOWER to UPPER is a box, RING a hollow cylinder
// about an axis; members lie in both. VELOCITY, SPIN and POINT count only if DRIVEN,
// the initial ones only if not.
struct group_parameters {
    double lower[3], upper[3];
    double ring_inner, ring_outer, ring_centre[3], ring_axis[3];
    struct number_list grains;
    const char *material; // NULL: that of the scene
    bool driven;
    double velocity[3], spin[3], point[3];
    double initial_velocity[3], initial_spin[3];
    struct time_table motion;
};

// The choices in the order of their texts in the table: the index is stored.
enum contact_law { LAW_HERTZ, LAW_LINEAR, LAW_TIMED };
enum bond_choice { BOND_NONE, BOND_PARALLEL, BOND_CONTACT };
enum written { WRITE_MOTION, WRITE_PACKING };

struct simulate_parameters {
    double duration; // s
    int law;         // enum contact_law
    double contact_time;
    const char *material; // of grains that no group gives another
    struct named_rows materials, pairs, walls, groups;
    unsigned box_walls; // bits: -x, +x, -y, +y, -z, +z
    const char *box_material;
    double box_friction;
    double strain_rate[3];
    double gravity[3];
    bool prestress, tensile_damping, density_scaling;
    int friction_limit; // 0: by the spring, 1: by spring and dashpot
    double local_damping;
    int bond_kind; // enum bond_choice
    struct dem_bond_material bond;
    double bond_contact_strength; // N
    struct dem_liquid liquid;     // of no volume: dry
    double adhesion;              // J/m2
    int bridge_model;
    double surface_tension, contact_angle; // N/m, degrees; NAN: water, 0
    int64_t forces_row; // of a forces artifact; below 0: from its end
    double forces_factor;
    double time_step, time_step_share, expected_overlap, largest_overlap;
    bool allow_unstable;
    double record_every, snapshots_every, snapshots_from; // s
    bool record_contacts, record_energy;
    double stop_ratio; // unbalanced ratio at which the run ends; NAN: never
    double stop_after; // s
    int write;         // enum written
};

extern const struct parameter simulate_table[];
// Of each row of "materials", "pairs" and "walls".
extern const struct parameter simulate_materials[], simulate_pairs[], simulate_walls[];

// Checks what no single row can say. Exits 65. What depends on two parameters at once:
// lists of one length, times that rise, servos, the elastic constants that the law
// needs. What depends on the packing or on names is scene_init's. On the first fault it
// writes one line with the key to stderr.
void check_parameters(const struct simulate_parameters *parameters);
