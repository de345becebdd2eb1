// SPDX-License-Identifier: GPL-3.0-or-later
// The closed forms of [G 2] and of Soulie, in effective radii and surface tensions:
// `gap`, `volume` (over the cube) and `angle` give the force. G's equation numbers
// stand at each. A model stays finite outside the range that its authors meant;
// flags_of says where that is. Trap: Willett's full fit grows without bound as volumes
// vanish (LEAST_VOLUME).
#include "bridges/bridges.h"

#include <math.h>

double bridge_effective_radius(const struct bridge *bridge)
{
    return 2 / (1 / bridge->radius[0] + 1 / bridge->radius[1]);
}

double bridge_dimensionless_volume(const struct bridge *bridge)
{
    const double scale = bridge_effective_radius(bridge);
    return bridge->volume / scale / scale / scale;
}

// The input of the models: all in effective radii; forces in those and the surface
// tension.
struct reduced {
    double gap, volume, angle;
    double half_gap; // over sqrt(volume): S+ [G 6]
};

static double one_angle(const struct bridge *bridge)
{
    const double *angle = bridge->contact_angle;
    if (!(angle[0] < angle[1] || angle[0] > angle[1])) return angle[0];
    return acos(0.5 * (cos(angle[0]) + cos(angle[1])));
}

static struct reduced reduce(const struct bridge *bridge, double separation)
{
    const double volume = bridge_dimensionless_volume(bridge);
    const double gap = fmax(separation / bridge_effective_radius(bridge), 0);
    return (struct reduced){gap, volume, one_angle(bridge), gap / (2 * sqrt(volume))};
}

double bridge_rupture_distance(const struct bridge *bridge)
{
    const double edge = cbrt(bridge_dimensionless_volume(bridge));
    return bridge_effective_radius(bridge) * (1 + 0.5 * one_angle(bridge)) *
           (edge + 0.1 * edge * edge);
}

// [G 5, A1-A7], with a/2 where A6 has a: the meridian's circle touches both spheres.
static inline double weigert(const struct reduced *is)
{
    const double reach =
        is->volume / (0.96 * (1 + 3 * is->gap) * (1 + 1.1 * sin(is->angle))); // sin^4
    const double sine = fmin(sqrt(sqrt(reach)), 1), filling = asin(sine);
    const double turned = filling + is->angle;
    const double height = 2 * sin(0.5 * filling) * sin(0.5 * filling) + 0.5 * is->gap;
    // R1 is height over the cosine, infinite at 90 degrees; R2 stays finite there. It
    // has no sense where the circle would cross the axis.
    const double neck =
        fmax(sine - height * tan(0.25 * M_PI - 0.5 * turned), 1e-3 * sine);
    const double suction = cos(turned) / height - 1 / neck;
    return M_PI * sine * sine * suction + 2 * M_PI * sine * sin(turned);
}

// [G 8]
static inline double willett_reduced(const struct reduced *is)
{
    const double s = is->half_gap;
    return 2 * M_PI * cos(is->angle) / (1 + s * (2.1 + 10 * s));
}

// [G 7, B1-B4]
static inline double willett_fit(double t, double volume, double half_gap)
{
    const double l = log(volume);
    const double f1 = (-0.44507 + t * (0.050832 - 1.1466 * t)) +
                      l * ((-0.1119 + t * (-0.000411 - 0.1490 * t)) +
                           l * ((-0.012101 + t * (-0.0036456 - 0.01255 * t)) +
                                l * (-0.0005 + t * (-0.0003505 - 0.00029076 * t))));
    const double f2 = (1.9222 + t * (-0.57473 - 1.2918 * t)) +
                      l * ((-0.0668 + t * (-0.1201 - 0.22574 * t)) +
                           l * (-0.0013375 + t * (-0.0068988 - 0.01137 * t)));
    const double f3 = (1.268 + t * (-0.01396 - 0.23566 * t)) +
                      l * ((0.198 + t * (0.092 - 0.06418 * t)) +
                           l * ((0.02232 + t * (0.02238 - 0.009853 * t)) +
                                l * (0.0008585 + t * (0.001318 - 0.00053 * t))));
    const double f4 = (-0.010703 + t * (0.073776 - 0.34742 * t)) +
                      l * ((0.03345 + t * (0.04543 - 0.09056 * t)) +
                           l * (0.0018574 + t * (0.004456 - 0.006257 * t)));
    if (!(half_gap > 0)) return 2 * M_PI * exp(f1);
    const double s = log(half_gap);
    return 2 * M_PI * exp(f1 - f2 * exp(s * (f3 + f4 * s)));
}

// Below this volume the fit leaves its ground (at 1e-8 the force is 74 times too
// large). As volumes vanish the force becomes a function of S+ alone: so the fit is
// held at this volume, and beyond the S+ of nine tenths of rupture there, falls as [G
// 8] does.
static const double LEAST_VOLUME = 3e-5;

static inline double willett_full(const struct reduced *is)
{
    if (is->volume >= LEAST_VOLUME)
        return willett_fit(is->angle, is->volume, is->half_gap);
    const double edge = cbrt(LEAST_VOLUME);
    const double widest = 0.9 * (1 + 0.5 * is->angle) * (edge + 0.1 * edge * edge) /
                          (2 * sqrt(LEAST_VOLUME));
    struct reduced held = *is;
    held.half_gap = fmin(is->half_gap, widest);
    return willett_fit(is->angle, LEAST_VOLUME, held.half_gap) * willett_reduced(is) /
           willett_reduced(&held);
}

// 2 d [G 10], without the difference of near-equal numbers.
static inline double immersion(const struct reduced *is)
{
    const double area = 2 * is->volume / M_PI;
    return area / (is->gap + sqrt(is->gap * is->gap + area));
}

// [G 12]
static inline double rabinovich_lambert(const struct reduced *is)
{
    return 2 * M_PI * cos(is->angle) / (1 + is->gap / immersion(is));
}

// [G 9, 11]
static inline double rabinovich(const struct reduced *is)
{
    const double embracing = fmin(sqrt(immersion(is)), M_PI);
    return rabinovich_lambert(is) +
           2 * M_PI * sin(embracing) * sin(is->angle + embracing);
}

// Soulie et al. (2006), with the effective radius for both of theirs, as Yade has it.
static inline double soulie(const struct reduced *is)
{
    const double l = log(is->volume), t = is->angle;
    const double a = -1.1 * pow(is->volume, -0.53);
    const double b = (-0.148 * l - 0.96) * t * t - 0.0082 * l + 0.48;
    const double c = 0.0018 * l + 0.078;
    return M_PI * (c + exp(a * is->gap + b));
}

static inline double reduced_force(const struct reduced *is, enum bridge_model model)
{
    switch (model) {
    case BRIDGE_WEIGERT:
        return weigert(is);
    case BRIDGE_WILLETT_FULL:
        return willett_full(is);
    case BRIDGE_WILLETT_REDUCED:
        return willett_reduced(is);
    case BRIDGE_RABINOVICH:
        return rabinovich(is);
    case BRIDGE_RABINOVICH_LAMBERT:
        return rabinovich_lambert(is);
    case BRIDGE_SOULIE:
        return soulie(is);
    default:
        return NAN;
    }
}

// [G 2.3]: Willett's fits hold for angles below 50 degrees and volumes below 0.1.
static unsigned flags_of(const struct bridge *bridge, const struct reduced *is,
                         enum bridge_model model, double separation)
{
    unsigned flags = 0;
    if (separation < 0) flags |= BRIDGE_OVERLAPS;
    if (separation > bridge_rupture_distance(bridge)) flags |= BRIDGE_RUPTURED;
    if (is->angle > 50 * M_PI / 180) flags |= BRIDGE_ANGLE;
    if (is->volume > 0.1) flags |= BRIDGE_VOLUME;
    if (model == BRIDGE_WILLETT_FULL && is->volume < LEAST_VOLUME)
        flags |= BRIDGE_VOLUME;
    const double *angle = bridge->contact_angle;
    if (angle[0] < angle[1] || angle[0] > angle[1]) flags |= BRIDGE_UNEQUAL_ANGLES;
    return flags;
}

double bridge_model_force(const struct bridge *bridge, enum bridge_model model,
                          double separation, unsigned *flags)
{
    const struct reduced is = reduce(bridge, separation);
    if (flags) *flags = flags_of(bridge, &is, model, separation);
    return bridge->surface_tension * bridge_effective_radius(bridge) *
           reduced_force(&is, model);
}

// The loop of one model, so that the compiler sees which it is.
#define FORCES_OF(model)                                                               \
    for (int k = 0; k < count; k++) {                                                  \
        const double apart = gap[k] > 0 ? gap[k] : 0;                                  \
        const struct reduced is = {apart, volume[k], contact_angle,                    \
                                   apart / (2 * sqrt(volume[k]))};                     \
        force[k] = model(&is);                                                         \
    }                                                                                  \
    return

void bridge_model_forces(enum bridge_model model, double contact_angle, int count,
                         const double *volume, const double *gap, double *force)
{
    switch (model) {
    case BRIDGE_WEIGERT:
        FORCES_OF(weigert);
    case BRIDGE_WILLETT_FULL:
        FORCES_OF(willett_full);
    case BRIDGE_WILLETT_REDUCED:
        FORCES_OF(willett_reduced);
    case BRIDGE_RABINOVICH:
        FORCES_OF(rabinovich);
    case BRIDGE_RABINOVICH_LAMBERT:
        FORCES_OF(rabinovich_lambert);
    case BRIDGE_SOULIE:
        FORCES_OF(soulie);
    default:
        return;
    }
}
