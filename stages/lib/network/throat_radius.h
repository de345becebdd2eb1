// SPDX-License-Identifier: GPL-3.0-or-later
// Throat radii that are drawn instead of measured [K 2.2, 3.11].
#pragma once

#include "basics/status.h"
#include "network/network.h"

enum radius_law {
    RADIUS_NORMAL,    // [K 3.11]; draws that are not positive are drawn again
    RADIUS_LOGNORMAL, // of this mean and standard deviation of r, not of ln r
    RADIUS_UNIFORM,   // from mean - sqrt(3) deviations to mean + sqrt(3) deviations
    RADIUS_TWO_MODE   // two normal ones: macro- and micropores [K 2.2]
};

struct radius_distribution {
    enum radius_law law;
    double mean, deviation;               // m
    double second_mean, second_deviation; // m, of the second mode
    double second_share;                  // of the throats, 0 to 1
    // 0: radii next to each other have nothing in common. Otherwise m: radii are drawn
    // as before, then handed out in the order of a Gaussian random field of covariance
    // exp(-d^2 / (2 l^2)) at the middles of the throats, so that their distribution is
    // the same and only their places differ.
    double correlation_length;
    unsigned long seed;
};

// Gives every throat, in the order of the network, a radius drawn from DISTRIBUTION;
// the throats become cylinders. The same seed gives the same radii (GSL's mt19937 and
// its ziggurat). STATUS_BAD_DATA: a uniform distribution that would reach radii below
// 0. O(n_throat), with a correlation length 1000 n_throat.
enum status draw_radii(struct network *network,
                       const struct radius_distribution *distribution,
                       struct reason *reason);

// The share of normal radii of MEAN and DEVIATION that are not above 0 and are drawn
// again. Those two become the mean and standard deviation of what is left.
double cut_normal(double *mean, double *deviation);
