// SPDX-License-Identifier: GPL-3.0-or-later
// Unknown: R, the radius of the menisci that stay in the gaps between the discs of the
// section when gas fills its middle. A displacement of the gas along the throat does as
// much work as it makes surface [Mayer & Stowe 1965, Princen 1969]:
//     gas area = R (meniscus + cos(theta) gas rim),   pressure = sigma / R.
// In the gap between discs i and j, a distance d apart, the meniscus has its centre C
// at
//     l_i = |c_i C|,  l_i^2 = r_i^2 + R^2 + 2 r_i R cos(theta),
// and with the angles of the triangles c_i C c_j and c_i contact C
//     phi_i   = angle at c_i from c_j to C,
//     delta_i = angle at c_i from the contact to C,   eps_i the same at C,
// liquid wets phi_i - delta_i of disc i, the meniscus is R psi long,
//     psi = pi - phi_i - phi_j - eps_i - eps_j,
// and the liquid's area is that of the triangle c_i C c_j without the triangles to the
// contacts, the meniscus' sector and the wetted sectors, which share half a lens where
// discs overlap. A gap wider than the meniscus
// (l_i + l_j < d) holds no liquid.
//
// The gas area changes with R as R times what the right side does, so the fixed point
//     R <- gas area / (meniscus + cos(theta) gas rim)
// converges with the square of the error [Mason & Morrow 1991]. Where a gap loses its
// liquid before the two sides are equal they jump past each other: R is where they do,
// found by halving. (delta and eps by atan2: acos near 1 keeps half the digits.)
#include "network/entry_radius.h"

#include <math.h>
#include <stdbool.h>

enum { MOST_ROUNDS = 100 };

// A step of CONVERGED leaves an error of its square. Halving ends near rounding:
// throats on both sides of one gap are equally easy to enter where it loses its liquid,
// and entry_order.h tells others from such by 1e-12.
static const double CONVERGED = 1e-9, HALVED = 1e-15;

// What liquid in one gap takes: area, length of the meniscus, angles of both discs.
struct liquid_gap {
    double area, meniscus, wetted[2];
};

static double limited_acos(double x)
{
    return acos(fmin(1, fmax(-1, x)));
}

// Angles of two discs, a distance D apart, that lie in each other, from the line
// between them: into HIDDEN. Returns the half of their lens on that side, which both
// sectors count.
static double hide_overlap(const double r[2], double d, double hidden[2])
{
    double lens = 0;
    for (int i = 0; i < 2; i++) {
        const double x = (d + (r[i] - r[!i]) * ((r[i] + r[!i]) / d)) / 2;
        const double half = sqrt(fmax(0, r[i] * r[i] - x * x));
        hidden[i] = atan2(half, x);
        lens += (r[i] * r[i] * hidden[i] - x * half) / 2;
    }
    return lens;
}

static struct liquid_gap fill_gap(const double r[2], double d, double R, double cosine,
                                  double sine)
{
    double l[2], phi[2], delta[2], eps[2];
    struct liquid_gap gap = {0};
    for (int i = 0; i < 2; i++)
        l[i] = sqrt(r[i] * r[i] + R * R + 2 * r[i] * R * cosine);
    if (!(l[0] + l[1] > d)) return gap;
    for (int i = 0; i < 2; i++) {
        const double other = l[!i];
        phi[i] = limited_acos((l[i] * l[i] + d * d - other * other) / (2 * l[i] * d));
        delta[i] = atan2(R * sine, r[i] + R * cosine);
        eps[i] = atan2(r[i] * sine, R + r[i] * cosine);
    }
    const double psi = M_PI - phi[0] - phi[1] - eps[0] - eps[1];
    gap.area = d * l[0] * sin(phi[0]) / 2 - psi * R * R / 2;
    for (int i = 0; i < 2; i++) {
        gap.wetted[i] = phi[i] - delta[i];
        gap.area -= r[i] * l[i] * sin(delta[i]) / 2 + gap.wetted[i] * r[i] * r[i] / 2;
    }
    gap.meniscus = R * psi;
    // No liquid is in too wide a wedge between discs that overlap. Areas, and with a
    // contact angle what is wetted, may be below 0: the meniscus reaches through the
    // gap into the next polygon, until its centre is on the line between the discs.
    struct liquid_gap dry = {0};
    if (r[0] + r[1] > d) gap.area += hide_overlap(r, d, dry.wetted);
    return psi > 0 ? gap : dry;
}

// Radius of grain NUMBER in the section's narrowest plane; 0 beyond its end.
static double disc(const struct open_section *section, int number, double z)
{
    const struct section_grain *grain = &section->grain[number];
    const double offset = z - grain->height;
    return sqrt(fmax(0, grain->radius * grain->radius - offset * offset));
}

// The right side of the fixed point.
static double next_radius(const struct open_section *section, double z, double R,
                          double cosine, double sine)
{
    double area = open_area(section, z), meniscus = 0, rim = 0;
    for (int k = 0; k < section->n_grain; k++)
        rim += section->grain[k].angle * disc(section, k, z);
    for (int k = 0; k < section->n_gap; k++) {
        const struct section_gap *gap = &section->gap[k];
        const bool mirror = gap->grain[1] < 0; // half of a gap twice as wide
        const double first = disc(section, gap->grain[0], z);
        const double r[2] = {first, mirror ? first : disc(section, gap->grain[1], z)};
        if (!(r[0] > 0 && r[1] > 0)) continue;
        const double share = mirror ? 0.5 : 1;
        const struct liquid_gap liquid =
            fill_gap(r, mirror ? 2 * gap->apart : gap->apart, R, cosine, sine);
        area -= share * liquid.area;
        meniscus += share * liquid.meniscus;
        rim -= share * (liquid.wetted[0] * r[0] + liquid.wetted[1] * r[1]);
    }
    return area / (meniscus + cosine * fmax(0, rim));
}

double entry_radius(const struct open_section *section, double contact_angle)
{
    const double cosine = cos(contact_angle), sine = sin(contact_angle);
    const double z = narrowest_place(section);
    double rim = 0, low = 0, high = HUGE_VAL;
    for (int k = 0; k < section->n_grain; k++)
        rim += section->grain[k].angle * disc(section, k, z);
    double R = open_area(section, z) / (cosine * rim); // all gaps dry
    for (int round = 0; round < MOST_ROUNDS && R > 0 && isfinite(R); round++) {
        const double next = next_radius(section, z, R, cosine, sine);
        if (fabs(next - R) <= CONVERGED * R) return 2 * cosine * next;
        if (high - low <= HALVED * R) return 2 * cosine * R;
        *(next > R ? &low : &high) = R;
        R = next > low && next < high ? next : low + (fmin(high, 4 * R) - low) / 2;
    }
    return 0;
}
