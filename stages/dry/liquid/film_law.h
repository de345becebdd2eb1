// SPDX-License-Identifier: GPL-3.0-or-later
// Flow in the films that gas leaves in the corners of throats (corner_film.h), and the
// radius of their menisci at a cluster.
#ifndef CRAQUELURE_FILM_LAW_H
#define CRAQUELURE_FILM_LAW_H

#include "dry/conditions.h"

// Scaled (conditions.h). Through an empty throat of length L between nodes where the
// films have menisci of radii r and s flows CONDUCTANCE / L (r^3 - s^3). Beside liquid
// that gas enters next through a throat of radius R, r = CURVATURE R.
struct film_law {
    double conductance; // 0: the corners hold no films
    double curvature;
    double step; // fall of the saturation until flows are found again; 0: every event
};

// CONDITIONS must have passed check_conditions; their rings are RINGS_FILMS. The angles
// of all corners are alike; where contact angle and half angle leave no film,
// CONDUCTANCE is 0.
struct film_law film_law_of(const struct drying_conditions *conditions,
                            const struct drying_scale *scale);

#endif
