// SPDX-License-Identifier: GPL-3.0-or-later
// What a motion artifact holds of grains, contacts and moments, in a window of time.
// The positions of snapshots and the rows of sums have times of their own: a torque is
// a mean over many more rows than there are snapshots.
#pragma once

#include "artifacts/artifact.h"
#include "geometry/vector.h"

#include <stdint.h>

// It owns its arrays; free with motion_free. Rows of snapshots outside the window are
// there, but FIRST and LAST leave them out. FORCE is that on the second of PAIR, bridge
// included; the force on the first is its opposite. Rows of the contacts of snapshot s
// are contact_first[s] to contact_first[s + 1] - 1. Positions may lie outside of a box
// that repeats.
struct motion {
    int n_particle, n_snapshot, n_wall, n_group, n_time;
    double *radius, *mass; // (n_particle) m, kg
    uint8_t *driven;       // (n_particle) 1: part of the boundary
    uint8_t periodic[3];
    struct vector lower, upper; // of the box at the first snapshot, m
    int first, last;            // snapshots in the window: first, and one past the last
    double *snapshot_time;      // (n_snapshot) s
    struct vector *position, *velocity;   // (n_snapshot, n_particle) m, m/s
    int64_t *contact_first;               // (n_snapshot + 1) rows of the contacts
    int32_t (*pair)[2];                   // (n_contact) the second is -1-w for wall w
    struct vector *force, *point;         // (n_contact) N on the second; m
    double *overlap;                      // (n_contact) m, below 0 apart
    double *bridge_volume, *bridge_force; // (n_contact) m3, N; NULL: dry
    double *time;                         // (n_time) s, of the sums
    struct vector *wall_point;            // (n_wall) m, at the start
    struct vector *wall_force, *wall_moment, *wall_displacement;    // (n_time, n_wall)
    struct vector *group_force, *group_moment, *group_displacement; // (n_time, n_group)
    json_t *scene; // parameters of what made it, or NULL
};

// Snapshots from FROM to TO, s; NAN: no bound. Exits 65 when there is none, when rows
// of contacts and their numbers do not fit, or a box that repeats changes. The first
// snapshots may be equilibration: FROM leaves them out. All rows are read into memory.
struct motion read_motion(const struct artifact *input, double from, double to);
void motion_free(struct motion *motion);

// The nearest image of the vector from one point to another. By the box of the window,
// along axes that repeat only. It is right for vectors of less than half a box.
struct vector shortest_image(const struct motion *motion, struct vector between);

// The moment of the grains on wall W, or on driven group G, about the axis through
// POINT along the unit vector AXIS, at row T of the sums; N m. Moments in a motion are
// about the point of the wall or group as it lies then; ABOUT is that point of the
// group at the start, m.
double wall_torque(const struct motion *motion, int t, int w, struct vector point,
                   struct vector axis);
double group_torque(const struct motion *motion, int t, int g, struct vector about,
                    struct vector point, struct vector axis);
