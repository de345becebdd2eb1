// SPDX-License-Identifier: GPL-3.0-or-later
// What changes while a scene runs: walls and groups that follow a table of time, servos
// that keep a pressure, a box that is strained.
#pragma once

#include "scene.h"

// Whether anything does; otherwise `control` needs no call. Constant velocities and
// servos with a constant force are set once, by dem_create.
bool is_controlled(const struct simulate_parameters *parameters,
                   const struct scene *scene);

// Cycles between two calls of `control`: what it sets holds for so long. It also fixes
// at which cycles a run may stop (run.c): a run that was kept and goes on must call at
// the same cycles to give the same bytes.
enum { CONTROL_EVERY = 16 };

// Mean of the factors of TABLE over SPAN behind TIME, s; 1 without a table.
double mean_factor(const struct time_table *table, double time, double span);

// Sets motions and servos for TIME, s, and strains the box for CONTROL_EVERY cycles.
// Call it when dem_cycle is a multiple of CONTROL_EVERY, before these cycles run. TIME
// is that of the beginning of the span, dem_time(DEM). STATUS_BAD_DATA: the box would
// be too narrow. scene_init has refused all else that DEM would refuse to strain.
enum status control(const struct simulate_parameters *parameters,
                    const struct scene *scene, double time, struct dem *dem,
                    struct reason *reason);
// The same without the strain.
void set_motions(const struct simulate_parameters *parameters,
                 const struct scene *scene, double time, struct dem *dem);

// The velocity, m/s, of what moves at PLACE with the strain of a box with the lower
// corner LOWER. The engine knows velocities without it.
struct vector strain_velocity(const struct simulate_parameters *parameters,
                              struct vector lower, struct vector place);

// Area, m2, that the servo of wall W acts on now; NAN where the wall is not along two
// axes and no area is given.
double servo_area(const struct scene *scene, const struct dem *dem, int w);

// The room between the planes that face each other along x, y and z, m3; the box where
// there are none. 0 where planes have passed each other. Round walls, rings and blocks
// do not bound it: of a drum it is the box.
double room(const struct scene *scene, const struct dem *dem);
