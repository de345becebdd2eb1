// SPDX-License-Identifier: GPL-3.0-or-later
// The coarse-graining function along one axis: the triweight polynomial
//     phi(u) = 35/32 (1 - u^2)^3,   |u| < 1,   u = distance / half width.
// Its standard deviation is a third of its half width, so that it stands for a Gaussian
// of that width, cut off smoothly where others cut theirs. A polynomial with bounded
// support: a point reaches few cells, and its integral is exact and cheap. phi and its
// first two derivatives are 0 at the edge, so fields do not jump as grains enter a
// cell.
#pragma once

// The variance of phi is 1/9.
enum { KERNEL_REACH = 3 }; // half width over smoothing length (standard deviation)

// The integral of phi up to U: 0 below -1, 1 above 1. It rises from 0 to 1; without a
// unit.
static inline double kernel_share(double u)
{
    if (u <= -1) return 0;
    if (u >= 1) return 1;
    const double s = u * u;
    return 0.5 + 35.0 / 32 * u * (1 - s * (1 - s * (3.0 / 5 - s / 7)));
}
