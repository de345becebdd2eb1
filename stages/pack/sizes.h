// SPDX-License-Identifier: GPL-3.0-or-later
// Size distributions of grains, drawn one radius at a time. Prepared once, then drawn
// from in O(1) or O(log pieces): continuous distributions are cut into pieces, each of
// which is drawn from by inversion.
#pragma once

#include "basics/status.h"
#include "parameters/parameters.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>

// By number, or with SHARE_OF_MASS by mass; continuous ones are cut off at smallest and
// largest.
enum size_distribution {
    SIZES_ONE,       // all equal
    SIZES_UNIFORM,   // even from smallest to largest
    SIZES_NORMAL,    // mean radius, deviation spread times radius
    SIZES_LOGNORMAL, // the same mean and deviation before it is cut off
    SIZES_POWER,     // density ~ r^-exponent
    SIZES_TWO_MODE,  // radius, or second_radius with second_share
    SIZES_SIEVE      // linear between the points of a sieve curve
};

// What the shares of a distribution are shares of: a sieve gives them by mass.
enum size_share { SHARE_OF_NUMBER, SHARE_OF_MASS };

// The user's parameters; NAN where not given.
struct size_parameters {
    int distribution; // enum size_distribution
    int by;           // enum size_share: a distribution by number or by mass
    double radius; // the one, the mean (normal, lognormal) or the first (two_mode), m
    double smallest, largest;           // m
    double spread;                      // standard deviation over mean, 1
    double exponent;                    // density ~ r^-exponent
    double second_radius, second_share; // m, 1
    struct number_list sieve_radii;     // m, rising
    struct number_list sieve_passing;   // cumulative share, from 0 to 1
};

enum { SIZE_PIECES = LIST_MOST };

// The same, ready to draw from. Shares of mass become shares of number: grains of one
// density, so the number density is the mass density over r^3. A value, without
// pointers: it may be copied.
struct sizes {
    int distribution;
    double smallest, largest; // every radius lies from here to there, m
    double radius,
        second_radius;      // of one and two_mode; RADIUS also scales lognormal, m
    double second_share;    // by number
    double mean, deviation; // normal: of r, m; lognormal: of ln(r / radius)
    double exponent;        // number density ~ r^-exponent within a piece
    bool thinned;           // normal by mass: exact by rejection within a piece
    int n_piece;
    double edge[SIZE_PIECES + 1];   // m
    double cumulative[SIZE_PIECES]; // weight of this piece and those before
};

// STATUS_BAD_DATA, naming the key, when they make no distribution. Where smallest and
// largest are not given, a lognormal is cut off at five deviations of ln r, a normal
// one at a tenth of the mean and five deviations above it.
enum status sizes_prepare(const struct size_parameters *parameters, struct sizes *sizes,
                          struct reason *reason);

// The same distribution, FACTOR times as large. Smallest and largest with it.
void sizes_scale(struct sizes *sizes, double factor);

// One radius, m. A normal distribution by mass takes a varying number of random numbers
// (rejection).
double sizes_draw(const struct sizes *sizes, gsl_rng *random);

// N radii, m, in the order drawn; the caller frees them.
double *sizes_draw_many(const struct sizes *sizes, int n, gsl_rng *random);
