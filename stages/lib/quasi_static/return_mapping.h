// SPDX-License-Identifier: GPL-3.0-or-later
// One joint among others that push as they do: open, stuck or slipping.
#ifndef CRAQUELURE_RETURN_MAPPING_H
#define CRAQUELURE_RETURN_MAPPING_H

#include "contact_pair.h"

// The first three strains of a joint go on from FROM by x = given - compliance q(x),
// where q is by how much its load grows more than TANGENT says, from LOAD on.
struct surroundings {
    double from[3], load[3], tangent[3];
    double given[3];
    double compliance[3][3]; // symmetric, positive
};

// Finds x: stuck, if that can be; else open; else slipping, the way nearest to that of
// the spring at the x that is there. False: there is none, but for rounding.
bool settle_joint(const struct joint *joint, const struct surroundings *surroundings,
                  double x[3]);

// Solves three equations MATRIX answer = RIGHT, in place. False: singular.
bool solve_three(double matrix[3][3], double right[3]);

#endif
