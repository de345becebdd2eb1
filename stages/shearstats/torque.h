// SPDX-License-Identifier: GPL-3.0-or-later
// The torque that turns a part of a cell: some walls and driven groups.
#pragma once

#include "basics/status.h"
#include "motion.h"

enum { MOST_IN_PART = 256 };

// Places of walls and groups in the arrays of a motion. More than MOST_IN_PART of
// either are refused.
struct part {
    int n_wall, n_group;
    int wall[MOST_IN_PART], group[MOST_IN_PART];
    struct vector group_point[MOST_IN_PART]; // that moments are about, m
};

// Finds WALLS and GROUPS, each a list of names or numbers between commas or NULL, in
// the scene of MOTION. STATUS_BAD_DATA with the name that is not there. Numbers count
// from 0: walls in the order of the scene, those of the box first. A name comes before
// a number. In a motion without a scene only numbers are found.
enum status find_part(const struct motion *motion, const char *walls,
                      const char *groups, struct part *part, struct reason *reason);

// The mean over the rows from FROM to TO, s (NAN: no bound), of the torque about the
// axis through POINT that turns PART; above 0 where the grains resist a turning of the
// sign of RATE. BLOCK_ERROR is the standard error from the means of BLOCKS blocks of
// rows, NAN for fewer than two. ROWS is how many there are; 0: the others are NAN.
struct torque {
    int rows;
    double mean, block_error; // N m
};
// AXIS is a unit vector; only the sign of RATE counts. Each row counts once: `simulate`
// spaces them evenly in time.
struct torque mean_torque(const struct motion *motion, const struct part *part,
                          struct vector point, struct vector axis, double rate,
                          double from, double to, int blocks);
