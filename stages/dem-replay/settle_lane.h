// SPDX-License-Identifier: GPL-3.0-or-later
// Joints without friction that do not resist as the factored stiffness says, under one
// load: which of them touch, and by how much more each resists.
#ifndef CRAQUELURE_SETTLE_LANE_H
#define CRAQUELURE_SETTLE_LANE_H

#include "corrections.h"

// Of one row of the corrections: how much stiffer the bond is than factored, and the
// contact, which touches while the strain grows by CLOSED_TO at most; 0 but along.
struct lane_row {
    double strain; // to begin with
    double bond, contact, closed_to;
    bool touched; // in the factor
};

struct settler;
struct settler *settler_new(void); // the caller frees it with settler_free
void settler_free(struct settler *settler);
void settler_forget(struct settler *settler); // what it factored: the stiffness changes

// With the strains GIVEN (count, LANES apart, as all here) that the factor alone
// answers the load with: finds LOAD that the ROWS resist with besides, so that strains
// are what factor and they answer; TOUCHES is where to begin, and then which do. Unless
// they MAY CHANGE, GIVEN is a small load more, and LOAD by how much more those that
// touch resist. False: not found.
bool settle_lane(struct settler *settler, struct corrections *corrections,
                 const struct lane_row *row, bool may_change, const double *given,
                 bool *touches, double *load);

#endif
