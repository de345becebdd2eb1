// SPDX-License-Identifier: GPL-3.0-or-later
// The radial distribution function g(r): how many centres there are at a distance from
// a centre, relative to as many points anywhere.
#pragma once

#include "geometry/porosity.h"

// VALUE k is the mean of g over r = (k - 1/2) to (k + 1/2) times WIDTH, m; k = 0: from
// 0. Only pairs with both centres in WINDOW count, to every image where the box
// repeats; the shells count with the share of them that lies in the window, averaged
// over all places in it (exact: the isotropised set covariance of a box, as in the
// estimator of Ohser & Stoyan), so walls leave no trace beyond those in the packing
// itself. From at most 20,000 centres, evenly picked. COUNT * WIDTH must be at most
// radial_reach. False when there are fewer than two centres in the window. O(centres
// looked at times grains within COUNT * WIDTH). No random numbers: the same packing
// gives the same values.
bool radial_distribution(const struct packing *packing, const struct window *window,
                         double width, int count, double *value);

// Distance up to which it is known: the shortest side of the window that does not
// repeat (along y only when the packing is not flat), and at most ten mean spacings, to
// bound the work where grains overlap beyond reason; m.
double radial_reach(const struct packing *packing, const struct window *window);
