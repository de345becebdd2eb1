// SPDX-License-Identifier: GPL-3.0-or-later
// How thick the boundary layer is: epsilon = delta/beta [K 3.3.5], from what the user
// knows of the air flow. The layer stands for the gradient of vapour beside the body:
// through a thickness epsilon the flux is delta / epsilon times the difference of
// densities, as beta times it is.
#pragma once

#include "basics/status.h"

enum transfer_law {
    TRANSFER_COEFFICIENT, // beta is given
    TRANSFER_THICKNESS,   // epsilon is given
    TRANSFER_SHERWOOD,    // Sh is given
    TRANSFER_PLATE,       // laminar flow along a plate, mean over it:
                          // Sh = 0.664 Re^(1/2) Sc^(1/3) [K 3.6], to Re = 5e5
    TRANSFER_SPHERE       // around a sphere: Sh = 2 + 0.6 Re^(1/2) Sc^(1/3), Ranz and
                          // Marshall (1952), to Re = 200; 2 in air at rest
};

// Which of them count depends on the law.
struct air_flow {
    double coefficient;         // beta, m/s
    double thickness;           // epsilon, m
    double sherwood;            // Sh = beta L / delta
    double length;              // L, of the plate along the flow, or the diameter; m
    double velocity;            // u, m/s
    double kinematic_viscosity; // nu of the air, m2/s
};

struct mass_transfer {
    double coefficient; // beta, m/s
    double thickness;   // epsilon, m
    double reynolds;    // u L / nu; 0 where the law does not need it
    double schmidt;     // nu / delta (K prints its inverse); 0 likewise
    double sherwood;    // 0 likewise
};

// Reads only the members of FLOW that LAW needs. DIFFUSIVITY is delta of the vapour,
// m2/s. STATUS_BAD_DATA: Re beyond the range of the law, or a thickness or coefficient
// outside the range of normal numbers.
enum status find_mass_transfer(enum transfer_law law, const struct air_flow *flow,
                               double diffusivity, struct mass_transfer *transfer,
                               struct reason *reason);
