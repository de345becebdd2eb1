// SPDX-License-Identifier: GPL-3.0-or-later
// Flow in the films that gas leaves in the corners of throats (corner_film.h), and the
// radius of their menisci at a cluster.
#pragma once

#include "dry/conditions.h"

// Scaled (conditions.h). Through an empty throat of length L between nodes where the
// films have menisci of radii r and s flows CONDUCTANCE / L (r^3 - s^3). Beside liquid
// that gas enters next through a throat of radius R, r = CURVATURE R.
//
// Under gravity what drives the flow is the potential. A level is the cube of the
// radius r_top that liquid of this potential, at rest, would have at the top of the
// box:
//     1 / r_top = 1 / r + WEIGHT depth,
// and r^3 itself without gravity. So no level is above those of the liquid that feeds
// it, and a film ends at 0.
struct film_law {
    double conductance; // 0: the corners hold no films
    double curvature;
    double step;   // fall of the saturation until flows are found again; 0: every event
    double weight; // rho g over surface tension; 0: no gravity
    double thickest; // r at most, also where liquid would stand under pressure
};

// CONDITIONS must have passed check_conditions; their rings are RINGS_FILMS. The angles
// of all corners are alike; where contact angle and half angle leave no film,
// CONDUCTANCE is 0.
struct film_law film_law_of(const struct network *network,
                            const struct drying_conditions *conditions,
                            const struct drying_scale *scale);

// The level of liquid with menisci of RADIUS at a DEPTH below the top of the box.
double film_level(const struct film_law *law, double radius, double depth);

// How many times as much as CONDUCTANCE / L (a - b) flows between places with levels a
// and b, from their mean LEVEL and DEPTH; 1 without gravity.
double film_flow_ratio(const struct film_law *law, double level, double depth);
