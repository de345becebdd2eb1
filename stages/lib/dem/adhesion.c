// SPDX-License-Identifier: GPL-3.0-or-later
// Dry Hertz contacts that adhere (Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324,
// 301). With a the radius of the contact, U its overlap (below 0 where a neck is drawn
// out), R* and E* as in materials.c and the work of adhesion w, J/m2,
//     U = a^2/R* - sqrt(2 pi w a/E*)
//     F = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3).
// With s = sqrt(a/R*), g = U/R*, NUMBER = w/(E* R*) and c = sqrt(2 pi NUMBER) this is
//     s^4 - c s - g = 0,   F/(E* R*^2) = 4/3 s^6 - 2 c s^3.
// A contact forms at U = 0 and breaks where the two roots s meet, at s^3 = c/4. Before,
// at s^3 = 3/4 c, it pulls most: F = -3/2 pi w R*.
//
// The pair sweep has the Hertz spring 4/3 g^1.5. The rest acts as the pull of a liquid
// bridge does (liquid.c): formed by touch, kept until it breaks, work in the ledger of
// bridges.
#include "dem/engine.h"

#include <math.h>

double adhesion_number(double work, double stiffness, double law_radius, double radius)
{
    const double modulus = 0.75 * stiffness / sqrt(law_radius);
    return work / (modulus * 0.5 * radius);
}

static double coefficient(double number)
{
    return sqrt(2 * M_PI * number);
}

double adhesion_rupture(double number)
{
    const double c = coefficient(number);
    return 0.5 * 0.75 * c * cbrt(0.25 * c);
}

double adhesion_overlap(double number)
{
    return 0.5 * pow(1.5 * coefficient(number), 4.0 / 3);
}

// The largest root s by Newton's method. It begins above the root, where the function
// is convex: s falls until rounding stops it, in some 50 steps next to the double root,
// in 5 elsewhere.
static double contact_size(double c, double g)
{
    enum { MOST_STEPS = 100 };
    const double unloaded = cbrt(c), least = unloaded * 0.62996052494743658; // 4^(-1/3)
    double s = sqrt(sqrt(fmax(g, 0))) + unloaded;
    for (int k = 0; k < MOST_STEPS; k++) {
        const double cube = s * s * s;
        const double next = s - (s * (cube - c) - g) / (4 * cube - c);
        if (!(next < s)) return s;
        if (next <= least) return least;
        s = next;
    }
    return s;
}

void adhesion_pulls(int count, const double *number, const double *gap, double *pull)
{
    for (int k = 0; k < count; k++) {
        const double c = coefficient(number[k]), g = -2 * gap[k];
        const double s = contact_size(c, g), cube = s * s * s;
        const double spring = g > 0 ? 4.0 / 3 * g * sqrt(g) : 0;
        pull[k] = (spring - (4.0 / 3 * cube - 2 * c) * cube) / (2 * number[k]);
    }
}
