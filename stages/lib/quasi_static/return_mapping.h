// SPDX-License-Identifier: GPL-3.0-or-later
// The law of one contact solved exactly while all others keep their loads: open,
// sticking or slipping.
#pragma once

#include "contact_pair.h"

// The first three components (normal, two of shear) go on from FROM by x = given -
// compliance q(x), where q is by how much the load grows more, from LOAD on, than
// TANGENT says.
struct local_problem {
    double from[3], load[3], tangent[3];
    double given[3];
    double compliance[3][3]; // symmetric, positive
};

// Finds x: sticking, if that can be; else open; else slipping, in the direction nearest
// to that of the spring at the x that is there. False: there is none, but for rounding.
bool return_map(const struct contact_pair *pair, const struct local_problem *problem,
                double x[3]);

// Solves three equations MATRIX answer = RIGHT, in place. False: singular. RIGHT
// becomes the answer; MATRIX is overwritten.
bool solve_three(double matrix[3][3], double right[3]);
