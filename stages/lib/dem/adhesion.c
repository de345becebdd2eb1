// SPDX-License-Identifier: GPL-3.0-or-later
// Dry Hertz contacts that adhere (Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324,
// 301). With a the radius of the contact, U its overlap (below 0 where a neck is drawn
// out), R* and E* as in materials.c and the work of adhesion w, J/m2,
//     U = a^2/R* - sqrt(2 pi w a/E*)
//     F = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3).
// In the units that c = 2 pi w/(E* R*) gives, y = sqrt(a/R*)/c^(1/6) and
// q = U/(R* c^(2/3)), this holds for all contacts alike:
//     y^4 - y - q = 0,   F/(pi w R*) = 8/3 y^6 - 4 y^3.
// A contact forms at q = 0 and breaks where the two roots meet, at y_c^3 = 1/4 and
// q_c = -3/4 y_c. Before, at y^3 = 3/4, it pulls most, with 3/2 pi w R*.
//
// The pair sweep has the Hertz spring, 8/3 q^1.5. The rest acts as the pull of a liquid
// bridge does (liquid.c): formed by touch, kept until it breaks, work in the ledger of
// bridges.
#include "dem/engine.h"

#include <math.h>

#define BREAKS_AT 0.62996052494743658 // y_c

double adhesion_unit(double work, double modulus, double radius)
{
    const double c = 2 * M_PI * work / (modulus * 0.5 * radius);
    return 0.5 * cbrt(c * c);
}

double adhesion_rupture(double unit)
{
    return 0.75 * BREAKS_AT * unit;
}

double adhesion_overlap(double unit)
{
    return pow(1.5, 4.0 / 3) * unit;
}

// The larger root is y = y_c + d with d^4 + 4 y_c d^3 + 6 y_c^2 d^2 = q - q_c, of which
// nothing cancels next to q_c. Its left side is convex, and without any of its terms d
// is too large: so Newton's method falls to the root from above, from the better of two
// such bounds to rounding in five steps.
void adhesion_pulls(int count, const double *unit, const double *gap, double *pull)
{
    enum { STEPS = 6 };
    const double b = BREAKS_AT, tiny = 1e-150; // against 0/0 where it breaks
    for (int k = 0; k < count; k++) {
        const double q = -gap[k] / unit[k], above = q + 0.75 * b;
        const double root = sqrt(above > 0 ? above : 0);
        const double small = root / (sqrt(6.0) * b), large = sqrt(root);
        const double start = small < large ? small : large;
        double d = start > tiny ? start : tiny;
        for (int n = 0; n < STEPS; n++)
            d -= (((d + 4 * b) * d + 6 * b * b) * d * d - (above > 0 ? above : 0)) /
                 (((4 * d + 12 * b) * d + 12 * b * b) * d);
        const double y = b + d, cube = y * y * y, pressed = q > 0 ? q : 0;
        pull[k] =
            M_PI * (4.0 / 3 * pressed * sqrt(pressed) - (4.0 / 3 * cube - 2) * cube);
    }
}
