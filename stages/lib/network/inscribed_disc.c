// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns: the centre X of the disc, from that of the first, and its radius r, with
//     |X|^2 = (r + r_0)^2,  |X - a_i|^2 = (r + r_i)^2,  i = 1, 2.
// The differences are linear in X and r,
//     a_i . X = (a_i^2 - r_i^2 + r_0^2) / 2 - r (r_i - r_0),  so  X = P + Q r,
// and the first equation is quadratic in r,
//     (Q^2 - 1) r^2 + 2 (P.Q - r_0) r + P^2 - r_0^2 = 0.
// Its least positive root is written without a difference of near-equal numbers where
// the discs leave room.
#include "network/inscribed_disc.h"

#include <math.h>

double inscribed_disc(const double centre[3][2], const double radius[3])
{
    const double ax = centre[1][0] - centre[0][0], ay = centre[1][1] - centre[0][1];
    const double bx = centre[2][0] - centre[0][0], by = centre[2][1] - centre[0][1];
    const double twice = ax * by - ay * bx; // the area of the triangle, signed
    const double r0 = radius[0], da = radius[1] - r0, db = radius[2] - r0;
    const double a = (ax * ax + ay * ay - da * (radius[1] + r0)) / 2;
    const double b = (bx * bx + by * by - db * (radius[2] + r0)) / 2;
    const double px = (a * by - b * ay) / twice, py = (b * ax - a * bx) / twice;
    const double qx = (db * ay - da * by) / twice, qy = (da * bx - db * ax) / twice;
    const double square = qx * qx + qy * qy - 1, half = px * qx + py * qy - r0;
    const double constant = px * px + py * py - r0 * r0;
    const double inner = half * half - square * constant;
    const double r = inner >= 0 ? constant / (sqrt(inner) - half) : 0;
    return r > 0 && r < HUGE_VAL ? r : 0; // not a number: centres in line
}
