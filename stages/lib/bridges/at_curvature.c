// SPDX-License-Identifier: GPL-3.0-or-later
// The bridge at a gap and a mean curvature H (half the suction over surface tension).
//
// First guess: a torus whose arc of radius r1 spans both bodies at the contact radius
// y,
//     r1 = (gap + sagittas) / (cos turned_1 + cos turned_2),
//     1/r1 - 1/(y - r1 (1 - sin turned)) = 2 H,
// with turned = half-filling + contact angle. At a gap above 0 two radii solve it; the
// larger one is the bridge that other liquid can hold: the other gains volume where
// suction grows. Newton's method makes it exact (newton.h, with H in place of the
// volume). Where that fails, next to the highest curvature that a bridge at this gap
// stands, it is approached from lower ones, which bridges of larger volumes have.
//
// Held means d volume / d H < 0, from the Jacobian J of the four equations:
//     J dx/dH = (0, 0, length, 0),  d volume / d H = sum of d volume / d x_n dx_n/dH.
#include "bridges/equilibrium.h"
#include "bridges/newton.h"

#include <math.h>

// What is asked.
struct search {
    const struct bodies *bodies;
    double gap;
};

static double smaller_radius(const struct bodies *bodies)
{
    return 1 / fmax(bodies->curvature[0], bodies->curvature[1]);
}

// The torus with contact lines of the radius Y on both bodies, and its 1/r1 - 1/neck:
// HUGE_VAL within overlapping bodies, -1 where there is no torus.
static struct arc torus_at(const struct search *search, double y, double *twice)
{
    const struct bodies *bodies = search->bodies;
    struct arc arc;
    double open = search->gap, cosines = 0, sines = 0, turned = 0;
    for (int k = 0; k < 2; k++) {
        const double c = bodies->curvature[k];
        arc.reach[k] = c * y > 1e-8 ? asin(c * y) / c : y;
        const struct contact_line line = contact_line(bodies, k, arc.reach[k]);
        const double at = line.angle + bodies->contact_angle[k];
        open += line.sagitta;
        cosines += cos(at);
        sines += sin(at) / 2;
        turned += at;
    }
    const double r1 = open / cosines, neck = y - r1 * (1 - sines);
    arc.turn = 0.5 * (M_PI - turned);
    arc.length = 2 * arc.turn * r1;
    const bool is_torus = cosines > 0 && arc.turn > 0 && neck > 0;
    *twice = open <= 0 ? HUGE_VAL : is_torus ? 1 / r1 - 1 / neck : -1;
    return arc;
}

// The larger of the contact radii that give the CURVATURE, to 1e-4; 0 where none does:
// then *MOST gets the largest curvature of any. Beyond a gap that is wide beside the
// contact lines it falls for good.
static double contact_radius(const struct search *search, double curvature,
                             double *most)
{
    const double widest = 0.999 * smaller_radius(search->bodies), step = 1.2;
    const double gap = fmax(search->gap, 0);
    const double least = fmax(1e-9 * widest, 0.1 * cbrt(gap * gap));
    double above = widest, below = 0, twice;
    *most = -1;
    for (double y = widest; y > least && !(below > 0); y /= step) {
        torus_at(search, y, &twice);
        *most = fmax(*most, twice / 2);
        *(twice > 2 * curvature ? &below : &above) = y;
    }
    if (!(below > 0)) return 0;
    for (int k = 0; k < 11; k++) {
        const double y = 0.5 * (above + below);
        torus_at(search, y, &twice);
        *(twice > 2 * curvature ? &below : &above) = y;
    }
    return above;
}

static struct problem problem_of(const struct search *search, const double *curvature)
{
    return (struct problem){.bodies = search->bodies,
                            .volume = 1,
                            .curvature = curvature,
                            .gap = search->gap,
                            .symmetric = bodies_are_equal(search->bodies)};
}

static bool is_held(const struct search *search, double curvature,
                    const struct unknowns *unknowns)
{
    const struct problem problem = problem_of(search, &curvature);
    const struct arc arc = arc_of(unknowns);
    const struct span span = span_of(search->bodies, &arc);
    struct system is = system_at(&problem, unknowns);
    double rate[ARC_NUMBERS] = {0, 0, arc.length, 0}, volume_rate = 0;
    if (eliminate(is.slope, rate) == 0) return false;
    for (int n = 0; n < ARC_NUMBERS; n++)
        volume_rate += span.volume_slope[n] * rate[n];
    return volume_rate < 0;
}

// From UNKNOWNS, a guess. Arcs with a bulge between thin necks turn by more, and pass
// every other test.
static bool settle(const struct search *search, double curvature,
                   struct unknowns *unknowns, int *steps)
{
    const struct problem problem = problem_of(search, &curvature);
    const struct unknowns guess = *unknowns;
    return converge(&problem, unknowns, steps) &&
           fabs(unknowns->at[ARC_TURN]) < 0.95 * M_PI &&
           fabs(unknowns->at[ARC_FIRST] - guess.at[ARC_FIRST]) < 1.2 &&
           is_held(search, curvature, unknowns);
}

static bool jump(const struct search *search, double curvature, double *most,
                 struct unknowns *unknowns, int *steps)
{
    double twice;
    const double y = contact_radius(search, curvature, most);
    if (!(y > 0)) return false;
    const struct arc arc = torus_at(search, y, &twice);
    *unknowns = unknowns_of(&arc);
    return settle(search, curvature, unknowns, steps);
}

// The thinnest of bridges of smaller and smaller volumes that a lower curvature holds:
// into UNKNOWNS. Returns its curvature; 0 where no bridge is held by any above 0, and
// below 0 where none was found of so low a curvature.
static double thinner(const struct search *search, double curvature,
                      struct unknowns *unknowns, int *steps)
{
    const double thickest = 100;
    const int volumes = 50; // down to 1e-9
    double at = -1;
    for (int n = 0; n < volumes; n++) {
        struct equilibrium found;
        const double volume = thickest * pow(0.6, n);
        if (find_equilibrium(search->bodies, volume, search->gap, &found)) {
            if (at > 0) return at;
            continue;
        }
        at = fmax(at, 0);
        const double next = found.arc.turn / found.arc.length;
        *steps += found.steps;
        if (next > curvature) return at > 0 ? at : -1;
        if (at > 0 && next < at) return at;
        if (!(next > 0)) continue;
        const struct unknowns thin = unknowns_of(&found.arc);
        if (!is_held(search, next, &thin)) return at;
        at = next;
        *unknowns = thin;
    }
    return at;
}

// Up to CURVATURE from a lower one at which there is a bridge, if need be beyond the
// MOST of any torus.
static enum status approach(const struct search *search, double curvature, double most,
                            struct unknowns *unknowns, int *steps)
{
    const double shortest = 1e-4, lowest = 0.3 * curvature;
    double at = 0.95 * fmin(most, curvature), stride = 1.1;
    while (at > lowest && !jump(search, at, &most, unknowns, steps))
        at *= 0.9;
    if (!(at > lowest)) at = thinner(search, curvature, unknowns, steps);
    if (!(at > 0)) return at < 0 ? STATUS_NOT_CONVERGED : STATUS_NO;
    while (at < curvature) {
        const double next = fmin(at * stride, curvature);
        struct unknowns higher = *unknowns;
        if (settle(search, next, &higher, steps)) {
            *unknowns = higher;
            at = next;
        } else if ((stride = 1 + (stride - 1) / 2) < 1 + shortest)
            return STATUS_NO;
    }
    return STATUS_OK;
}

// Bridges at a gap stand a curvature of 1.12 times the highest MOST of any torus
// and 1.4 more, and of exp(-2.4 sqrt(gap)) / gap: bounds found at gaps from 1e-4 to
// 0.4, radii from 1:1 to 1:1000 and contact angles from 0 to 80 degrees.
static bool is_beyond_all(double curvature, double gap, double most)
{
    return curvature > 1.15 * most + 1.5 ||
           curvature * gap > exp(-2.4 * sqrt(fmax(gap, 0)));
}

// Whether overlapping bodies meet at too wide a wedge for liquid under suction: at an
// angle, through the bodies, of at most both contact angles together. With R1, R2 and
// the distance D of the centres its cosine is (R1^2 + R2^2 - D^2) / (2 R1 R2).
static bool is_wide_wedge(const struct bodies *bodies, double gap)
{
    const double a = bodies->curvature[0], b = bodies->curvature[1], depth = -gap;
    const double wedge = -1 + depth * (a + b) - depth * depth * a * b / 2;
    return depth > 0 &&
           cos(bodies->contact_angle[0] + bodies->contact_angle[1]) <= wedge;
}

enum status find_at_curvature(const struct bodies *bodies, double curvature, double gap,
                              struct equilibrium *found, double *volume)
{
    const struct search search = {bodies, gap};
    struct unknowns unknowns;
    enum status status = STATUS_OK;
    *found = (struct equilibrium){.gap = gap};
    if (is_wide_wedge(bodies, gap)) return STATUS_NO;
    double most;
    if (!jump(&search, curvature, &most, &unknowns, &found->steps)) {
        if (is_beyond_all(curvature, gap, most)) return STATUS_NO;
        status = approach(&search, curvature, most, &unknowns, &found->steps);
    }
    if (status) return status;
    found->arc = arc_of(&unknowns);
    *volume = span_of(bodies, &found->arc).volume + bodies_overlap(bodies, gap).volume;
    return STATUS_OK;
}
