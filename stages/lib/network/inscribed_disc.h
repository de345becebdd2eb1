// SPDX-License-Identifier: GPL-3.0-or-later
// The disc that three discs in a plane leave room for (Apollonius).
#pragma once

// Radius of the smallest disc that touches the three discs of RADIUS around CENTRE from
// outside, m; 0 if there is none, as between discs that cover the gap or stand in line.
double inscribed_disc(const double centre[3][2], const double radius[3]);
