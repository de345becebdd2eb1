// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid that gas leaves in a corner between two walls, and its flow along the corner.
// The meniscus is an arc of radius r, which meets both walls at the contact angle. The
// corner is HALF_ANGLE on either side of its bisector. Angles are in radians.
#pragma once

#include <stdbool.h>

// Whether the corner holds liquid: contact angle + half angle < pi/2 (Concus and Finn
// 1969). HALF_ANGLE is above 0.
bool corner_holds_film(double half_angle, double contact_angle);

// Area of the liquid over r^2. The corner must hold a film, here and below.
double corner_area(double half_angle, double contact_angle);

// The resistance beta to flow along the corner (Ransohoff and Radke 1988): under the
// pressure gradient G the mean velocity is G r^2 / (beta mu). No slip at the walls, no
// shear at the meniscus. To 1e-5. Solves a Poisson equation on two grids: to be found
// once, not in a loop.
double corner_resistance(double half_angle, double contact_angle);

// The flow through a corner of length L between menisci of radii r and s is this times
// surface tension / (viscosity L) times (r^3 - s^3): area / (3 beta). 0 where the
// corner holds no film.
double corner_conductance(double half_angle, double contact_angle);
