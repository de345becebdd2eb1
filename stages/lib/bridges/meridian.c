// SPDX-License-Identifier: GPL-3.0-or-later
// The arc z(s) = y exp(i psi) of meridian.h between two bodies, its integrals, and all
// derivatives by the four unknowns (`arc`), in closed form. With h = turn, L = length,
// x = s / L from 0 to 1,
//     z(x) = z(0) exp(2ihx) + L (exp(2ihx) - 1) / (2h) ,
// and at each body y = contact-line radius and psi = pi/2 - half-filling - contact
// angle.
//     miss   = exp(-ih) z(1) - exp(ih) z(0) - i L sin(h)/h   (find_miss; 0 in
//     equilibrium), gap    = integral of Re z / |z| ds - both sagittas, volume = pi
//     integral of Re z |z| ds - both caps,  area = 2 pi integral of |z| ds.
// The integrands have square-root singularities beside every neck; the substitution x =
// middle + scale sinh t moves them to distance pi/2, where 16 Gauss points a panel
// suffice. Series replace sin(x)/x and its like near 0: no shape is special.
#include "bridges/meridian.h"

#include <math.h>

// Plain products: the operators of <complex.h> look for NaN at every step.
struct number {
    double re, im;
};

static struct number times(struct number a, struct number b)
{
    return (struct number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

// sin(x)/x; below the bound the series' next term is under rounding.
static double sinc(double x)
{
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : sin(x) / x;
}

static bool equal(const double of[2])
{
    return !(of[0] < of[1] || of[0] > of[1]);
}

bool bodies_are_equal(const struct bodies *bodies)
{
    return equal(bodies->curvature) && equal(bodies->contact_angle);
}

struct contact_line contact_line(const struct bodies *bodies, int which, double reach)
{
    const double curvature = bodies->curvature[which], angle = curvature * reach;
    const double half = sinc(0.5 * angle) * reach;
    struct contact_line line = {.angle = angle,
                                .radius = reach * sinc(angle),
                                .sagitta = 0.5 * curvature * half * half};
    const double radius2 = line.radius * line.radius, height = line.sagitta;
    line.wet_area = M_PI * (radius2 + height * height);
    line.cap = M_PI * height * (3 * radius2 + height * height) / 6;
    return line;
}

// A contact line, the slope there, and their changes with the reach.
struct foot {
    struct contact_line line;
    double turned; // half-filling and contact angle: pi/2 less the slope outwards
    double radius_slope, sagitta_slope, cap_slope; // by the logarithm of the reach
    double turned_slope;
};

static struct foot foot_of(const struct bodies *bodies, int which, double reach)
{
    const struct contact_line line = contact_line(bodies, which, reach);
    const double rise = reach * sin(line.angle);
    return (struct foot){.line = line,
                         .turned = line.angle + bodies->contact_angle[which],
                         .radius_slope = reach * cos(line.angle),
                         .sagitta_slope = rise,
                         .cap_slope = M_PI * line.radius * line.radius * rise,
                         .turned_slope = line.angle};
}

// z at the first contact line, and its change with the logarithm of the reach.
struct beginning {
    struct number z, slope;
};

static struct beginning beginning_of(const struct foot *foot)
{
    const double sine = sin(foot->turned), cosine = cos(foot->turned);
    const double y = foot->line.radius, turned = foot->turned_slope * y;
    return (struct beginning){{y * sine, -y * cosine},
                              {foot->radius_slope * sine + turned * cosine,
                               -foot->radius_slope * cosine + turned * sine}};
}

// ---- does the arc meet the second body? --------------------------------------------

// exp(-i turn) z(end) - exp(i turn) z(begin) - i length sinc(turn): zero when it does.
static void find_miss(const struct foot foot[2], const struct arc *arc,
                      struct span *span)
{
    static const double sign[2] = {-1, 1};
    for (int k = 0; k < 2; k++) {
        const struct foot *at = &foot[k];
        const double sine = sin(at->turned + arc->turn);
        const double cosine = cos(at->turned + arc->turn), y = at->line.radius;
        span->miss[0] += sign[k] * y * sine;
        span->miss[1] += y * cosine;
        span->miss_slope[0][k] =
            sign[k] * (at->radius_slope * sine + y * cosine * at->turned_slope);
        span->miss_slope[1][k] =
            at->radius_slope * cosine - y * sine * at->turned_slope;
        span->miss_slope[0][ARC_TURN] += sign[k] * y * cosine;
        span->miss_slope[1][ARC_TURN] -= y * sine;
    }
    const double turn = arc->turn, chord = arc->length * sinc(turn);
    span->miss[1] -= chord;
    span->miss_slope[1][ARC_LENGTH] = -chord;
    span->miss_slope[1][ARC_TURN] -=
        arc->length * (fabs(turn) < 1e-3 ? -turn / 3 : (cos(turn) - sinc(turn)) / turn);
}

// ---- the integrals along it --------------------------------------------------------

// Gauss' nodes between -1 and 1 and their weights, 16 points.
enum { HALF_RULE = 8 };
static const double rule[HALF_RULE][2] = {{0.095012509837637454, 0.18945061045506859},
                                          {0.28160355077925892, 0.18260341504492361},
                                          {0.45801677765722737, 0.16915651939500262},
                                          {0.61787624440264377, 0.14959598881657676},
                                          {0.755404408355003, 0.12462897125553403},
                                          {0.86563120238783176, 0.095158511682492591},
                                          {0.9445750230732326, 0.062253523938647706},
                                          {0.98940093499164994, 0.027152459411754037}};

// Places along the arc from 0 to 1 by t, as middle + scale sinh t. The integrands have
// square roots where y = 0, off the real axis beside every neck; at t they lie pi/2
// off.
struct places {
    double middle, scale, from, to;
    int panels;
};

static struct places places_of(const struct number begin, double end_radius,
                               const struct arc *arc)
{
    const double curvature = arc->turn / arc->length;
    const struct number about = {1 + 2 * curvature * begin.re,
                                 2 * curvature * begin.im};
    const double eccentricity = hypot(about.re, about.im);
    const double radius2 = begin.re * begin.re + begin.im * begin.im;
    const double force = begin.re + curvature * radius2;
    const double neck = fabs(2 * force / (1 + eccentricity)); // also of H = 0
    const double small = 1e-9;
    const double turned = atan2(about.im, about.re);
    const double length = arc->length, radius = sqrt(radius2);
    double middle = -begin.im, scale = neck;
    if (fabs(arc->turn) * radius > small * length) {
        middle = -turned / (2 * curvature);
        scale = asinh(fabs(curvature) * neck / sqrt(fmax(eccentricity, small))) /
                fabs(curvature);
    }
    scale = fmax(scale, small * length);
    struct places places = {middle / length, scale / length, 0, 0, 1};
    places.from = asinh(-places.middle / places.scale);
    places.to = asinh((1 - places.middle) / places.scale);
    const double wide = (places.to - places.from) / 2.2;
    const double slender = length / (4 * fmin(radius, end_radius));
    places.panels = (int)fmin(ceil(fmax(wide, fmin(slender, 6))), 30);
    return places;
}

// d/dh of (exp(2ihx) - 1)/(2h), with TURNED = exp(2ihx) and MOVED that quotient.
static struct number bend_by_turn(double h, double x, struct number turned,
                                  struct number moved)
{
    if (fabs(h) > 1e-3)
        return (struct number){(-x * turned.im - moved.re) / h,
                               (x * turned.re - moved.im) / h};
    return (struct number){-x * x, -4.0 / 3 * h * x * x * x};
}

// z at place X (0 to 1) along the arc, and its changes.
struct place {
    struct number z, change[ARC_NUMBERS];
};

static struct place place_at(const struct beginning *begin, const struct arc *arc,
                             double x)
{
    const double h = arc->turn, length = arc->length;
    const double sine = sin(h * x), cosine = cos(h * x);
    const double chord = fabs(h) < 1e-8 ? x : sine / h;
    const struct number turned = {cosine * cosine - sine * sine, 2 * sine * cosine};
    const struct number moved = {-sine * chord, cosine * chord};
    const struct number from = times(begin->z, turned);
    const struct number along = {length * moved.re, length * moved.im};
    const struct number bent = bend_by_turn(h, x, turned, moved);
    return (struct place){.z = {from.re + along.re, from.im + along.im},
                          .change[ARC_FIRST] = times(begin->slope, turned),
                          .change[ARC_LENGTH] = along,
                          .change[ARC_TURN] = {-2 * x * from.im + length * bent.re,
                                               2 * x * from.re + length * bent.im}};
}

// Adds to SPAN what the integrands are at a place, times WEIGHT.
static void add_place(const struct place *place, double weight, struct span *span)
{
    const struct number z = place->z;
    const double y = sqrt(z.re * z.re + z.im * z.im), inverse = 1 / y;
    span->gap += weight * z.re * inverse;
    span->volume += weight * z.re * y;
    span->area += weight * y;
    for (int k = 0; k < ARC_NUMBERS; k++) {
        if (k == ARC_SECOND) continue;
        const double real = place->change[k].re;
        const double dy = (z.re * real + z.im * place->change[k].im) * inverse;
        span->gap_slope[k] += weight * inverse * (real - z.re * inverse * dy);
        span->volume_slope[k] += weight * (y * real + z.re * dy);
    }
}

static void integrate(const struct beginning *begin, double end_radius,
                      const struct arc *arc, struct span *span)
{
    const struct places places = places_of(begin->z, end_radius, arc);
    const double half = 0.5 * (places.to - places.from) / places.panels;
    for (int panel = 0; panel < places.panels; panel++)
        for (int k = 0; k < 2 * HALF_RULE; k++) {
            const double *node = rule[k / 2];
            const double t =
                places.from + half * (2 * panel + 1) + (k % 2 ? half : -half) * node[0];
            const double x = places.middle + places.scale * sinh(t);
            const double weight = half * node[1] * places.scale * cosh(t);
            const struct place place = place_at(begin, arc, x);
            add_place(&place, weight * arc->length, span);
        }
    span->gap_slope[ARC_LENGTH] += span->gap; // both are over a length yet
    span->volume_slope[ARC_LENGTH] += span->volume;
}

static void find_waist(const struct beginning *begin, const struct arc *arc,
                       struct span *span)
{
    const struct place middle = place_at(begin, arc, 0.5);
    for (int k = 0; k < ARC_NUMBERS; k++)
        span->waist_slope[k] =
            middle.z.re * middle.change[k].re + middle.z.im * middle.change[k].im;
}

struct span span_of(const struct bodies *bodies, const struct arc *arc)
{
    struct span span = {0};
    const struct foot foot[2] = {foot_of(bodies, 0, arc->reach[0]),
                                 foot_of(bodies, 1, arc->reach[1])};
    find_miss(foot, arc, &span);
    const struct beginning begin = beginning_of(&foot[0]);
    find_waist(&begin, arc, &span);
    integrate(&begin, foot[1].line.radius, arc, &span);

    span.volume *= M_PI;
    span.area *= 2 * M_PI;
    for (int k = 0; k < ARC_NUMBERS; k++)
        span.volume_slope[k] *= M_PI;
    for (int k = 0; k < 2; k++) {
        span.gap -= foot[k].line.sagitta;
        span.volume -= foot[k].line.cap;
        span.gap_slope[k] -= foot[k].sagitta_slope;
        span.volume_slope[k] -= foot[k].cap_slope;
    }
    return span;
}

// ---- what else one asks of an arc --------------------------------------------------

double arc_force(const struct bodies *bodies, const struct arc *arc)
{
    const struct foot foot = foot_of(bodies, 0, arc->reach[0]);
    const double y = foot.line.radius;
    return y * (sin(foot.turned) + arc->turn / arc->length * y);
}

// z = (E exp(2iHs) - 1)/(2H) is nearest to 0 where the exponential is 1.
double arc_neck(const struct bodies *bodies, const struct arc *arc)
{
    const struct foot foot[2] = {foot_of(bodies, 0, arc->reach[0]),
                                 foot_of(bodies, 1, arc->reach[1])};
    const double ends = fmin(foot[0].line.radius, foot[1].line.radius);
    if (!(cos(foot[0].turned) > 0 && cos(foot[1].turned) > 0)) return ends;
    const double curvature = arc->turn / arc->length;
    const double force = arc_force(bodies, arc);
    return fmin(ends, 2 * force / (1 + sqrt(fmax(0, 1 + 4 * curvature * force))));
}

static struct number arc_place(const struct beginning *begin, const struct arc *arc,
                               double x)
{
    const double angle = arc->turn * x, chord = arc->length * x * sinc(angle);
    const double sine = sin(angle), cosine = cos(angle);
    const struct number half = {cosine, sine};
    const struct number from = times(begin->z, times(half, half));
    return (struct number){from.re - chord * sine, from.im + chord * cosine};
}

// Each stretch between two places by Gauss' rule.
static double rise(const struct beginning *begin, const struct arc *arc, double from,
                   double to)
{
    double sum = 0;
    for (int k = 0; k < 2 * HALF_RULE; k++) {
        const double *node = rule[k / 2];
        const double x =
            0.5 * (from + to) + (k % 2 ? 0.5 : -0.5) * (to - from) * node[0];
        const struct number z = arc_place(begin, arc, x);
        sum += node[1] * z.re / hypot(z.re, z.im);
    }
    return 0.5 * (to - from) * arc->length * sum;
}

void arc_profile(const struct bodies *bodies, const struct arc *arc, int count,
                 double *height, double *radius)
{
    const struct foot foot = foot_of(bodies, 0, arc->reach[0]);
    const struct beginning begin = beginning_of(&foot);
    double at = -foot.line.sagitta;
    for (int k = 0; k < count; k++) {
        const double x = (double)k / (count - 1);
        if (k) at += rise(&begin, arc, (double)(k - 1) / (count - 1), x);
        const struct number z = arc_place(&begin, arc, x);
        height[k] = at;
        radius[k] = hypot(z.re, z.im);
    }
}

struct overlap bodies_overlap(const struct bodies *bodies, double gap)
{
    if (gap >= 0) return (struct overlap){0};
    const double depth = -gap;
    const double a = bodies->curvature[0], b = bodies->curvature[1], ab = depth * a * b;
    const double share = 0.5 * depth / (a + b - ab);
    const double height[2] = {share * (2 * a - ab), share * (2 * b - ab)};
    const int curved = a >= b ? 0 : 1;
    const double radius2 =
        height[curved] * (2 / bodies->curvature[curved] - height[curved]);
    struct overlap overlap = {.radius_squared = radius2};
    for (int k = 0; k < 2; k++)
        overlap.volume += M_PI * height[k] * (3 * radius2 + height[k] * height[k]) / 6;
    return overlap;
}
