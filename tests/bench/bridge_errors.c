// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of all bridge models against the exact solution, over radius ratio (1 to 0, a
// plane), contact angle, volume and separation:
//     bridge_errors
// prints lines
//     ratio angle_degrees volume share force rupture_ratio error...
// where share is the separation over that of exact rupture, force the exact one over 2
// pi R gamma, rupture_ratio [G 2] over exact rupture, and then come the relative errors
// of the models in the order of enum bridge_model.
#include "bridges/bridges.h"

#include <math.h>
#include <stdio.h>

static const double ratios[] = {1, 0.5, 0.1, 0};
static const double shares[] = {0,   0.01, 0.02, 0.05, 0.1, 0.2,  0.3, 0.4,
                                0.5, 0.6,  0.7,  0.8,  0.9, 0.95, 0.99};
enum {
    RATIOS = sizeof ratios / sizeof *ratios,
    SHARES = sizeof shares / sizeof *shares
};

static int print_curve(double ratio, int degrees, double volume)
{
    const double angle = degrees * M_PI / 180, larger = 0.5 * (1 + 1 / ratio);
    const struct bridge bridge = {{0.5 * (1 + ratio), ratio > 0 ? larger : INFINITY},
                                  {angle, angle},
                                  1 / (2 * M_PI),
                                  volume};
    struct bridge_state widest, state;
    struct reason reason;
    if (bridge_solve_rupture(&bridge, &widest, &reason)) return 1;
    for (int k = 0; k < SHARES; k++) {
        const double separation = shares[k] * widest.separation;
        if (bridge_solve(&bridge, separation, &state, &reason)) return 1;
        printf("%g %d %.4g %g %.6g %.6g", ratio, degrees, volume, shares[k],
               state.force, bridge_rupture_distance(&bridge) / widest.separation);
        for (enum bridge_model m = BRIDGE_WEIGERT; m < BRIDGE_MODELS; m++)
            printf(" %.4g",
                   bridge_model_force(&bridge, m, separation, NULL) / state.force - 1);
        putchar('\n');
    }
    return 0;
}

int main(void)
{
    for (int r = 0; r < RATIOS; r++)
        for (int degrees = 0; degrees <= 90; degrees += 10)
            for (int third = -24; third <= 0; third++)
                if (print_curve(ratios[r], degrees, pow(10, third / 3.0))) return 1;
    return 0;
}
