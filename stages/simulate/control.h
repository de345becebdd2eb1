// SPDX-License-Identifier: GPL-3.0-or-later
// What changes while a scene runs: walls and groups that follow a table of time, servos
// that keep a pressure, a box that is strained.
#ifndef CRAQUELURE_SIMULATE_CONTROL_H
#define CRAQUELURE_SIMULATE_CONTROL_H

#include "scene.h"

// Whether anything does; otherwise `control` needs no call.
bool is_controlled(const struct simulate_parameters *parameters,
                   const struct scene *scene);

// Cycles between two calls of `control`: what it sets holds for so long.
enum { CONTROL_EVERY = 16 };

// Sets motions and servos for TIME, s, and strains the box for CONTROL_EVERY cycles.
void control(const struct simulate_parameters *parameters, const struct scene *scene,
             double time, struct dem *dem);

// Area, m2, that the servo of wall W acts on now; NAN where the wall is not along two
// axes and no area is given.
double servo_area(const struct scene *scene, const struct dem *dem, int w);

// The room between the planes that face each other along x, y and z, m3; the box where
// there are none.
double room(const struct scene *scene, const struct dem *dem);

#endif
