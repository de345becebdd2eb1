// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns: none; integrals over z along the throat, of
//     area(z) = polygon - sum over grains of angle / 2 rho^2,
//     rho^2   = radius^2 - (z - height)^2, where that is above 0,
// exact for grains that do not overlap: what a sector covers outside the polygon, the
// sectors of the next polygon leave out. Overlaps add back half of the lens between two
// grains (the other half lies in the next polygon).
//
// Between the ends of grains, z = height +- radius, the area is a parabola
//     area = p + q (z - centre)^2,
// whose reciprocal has an integral in closed form. Where lenses count, and for flow,
// Gauss-Legendre points take its place: 1 / area is smooth there, steepest at the
// centres, where intervals are split.
//
// Flow [Happel 1959; the profile of a duct]: a slice conducts as the duct between few
// grains or as an array of rods would, whichever is more,
//     duct  = area r_in^2 / 8,
//     array = polygon^3 s f(s) / rim^2,  s = 1 - area / polygon,
//     f(s)  = -ln s - 3/2 + 2 s - s^2/2,
//     slice = (duct^4 + array^4)^(1/4),
// with r_in the disc that fits in: that between three grains, else the one around the
// throat's line. The exponent joins the two limits as solutions for ducts between three
// and four discs do.
//
// Wall collisions (Knudsen) add rim / (2 area) times a mean free path to the resistance
// of each slice, so that a throat's radius for them is
//     int dz / area  /  int rim / (2 area^2) dz.
#include "network/open_section.h"

#include "network/inscribed_disc.h"

#include <math.h>
#include <stdbool.h>

// Lenses below this part of the polygon are left out, which changes the open area, at
// least a tenth of the polygon between grains that touch, by a thousandth at most.
static const double LEAST_LENS = 1e-4;
// A throat without length has this one, relative to the root of its polygon.
static const double LEAST_LENGTH = 1e-12;

// ---- the section at some places -----------------------------------------------------

// Gauss-Legendre points of an interval -1..1, and their weights [Abramowitz & Stegun
// 25.4.30].
enum { POINTS = 6 };
static const double ABSCISSA[POINTS] = {-0.932469514203152, -0.661209386466265,
                                        -0.238619186083197, 0.238619186083197,
                                        0.661209386466265,  0.932469514203152};
static const double WEIGHT[POINTS] = {0.171324492379170, 0.360761573048139,
                                      0.467913934572691, 0.467913934572691,
                                      0.360761573048139, 0.171324492379170};

// Sections at the points of an interval.
struct slices {
    double z[POINTS], area[POINTS];
    double rim[POINTS];       // of grains and walls, m
    double inscribed[POINTS]; // radius of the disc that fits in, m
};

// The part of a disc beyond a chord at a distance APART from its centre: none, or all
// of it where the chord does not cut it.
static double segment(double rho2, double apart)
{
    const double half = sqrt(fmax(0, rho2 - apart * apart));
    return rho2 * atan2(half, apart) - apart * half;
}

// Half of what two discs share; a wall has no disc.
static double half_lens(const struct section_overlap *overlap, double z)
{
    const double offset = z - overlap->height;
    double lens = 0;
    for (int end = 0; end < 2; end++) {
        const double radius = overlap->radius[end];
        const double rho2 = radius * radius - offset * offset;
        if (rho2 > 0) lens += segment(rho2, overlap->apart[end]) / 2;
    }
    return lens;
}

// Takes the sector of a grain out of the slices.
static void block(struct slices *slices, const struct section_grain *grain)
{
    const double radius2 = grain->radius * grain->radius;
    for (int k = 0; k < POINTS; k++) {
        const double offset = slices->z[k] - grain->height;
        const double square = radius2 - offset * offset;
        const double rho2 = square > 0 ? square : 0, rho = sqrt(rho2);
        const double clear = square > 0 ? grain->reach - rho : HUGE_VAL;
        slices->area[k] -= grain->angle / 2 * rho2;
        slices->rim[k] += grain->angle * rho;
        slices->inscribed[k] =
            clear < slices->inscribed[k] ? clear : slices->inscribed[k];
    }
}

// Whether the disc around the throat's line is not the widest one: between three grains
// of unequal sizes clearances differ there.
static bool is_lopsided(const struct open_section *section)
{
    const struct section_grain *grain = section->grain;
    return section->n_grain == 3 && !(section->wall > 0) &&
           !(grain[0].radius == grain[1].radius && grain[0].radius == grain[2].radius);
}

// Takes the disc that touches all three grains where it is the wider one.
static void widen_slices(const struct open_section *section, struct slices *slices)
{
    for (int k = 0; k < POINTS; k++) {
        double centre[3][2], radius[3];
        for (int i = 0; i < 3; i++) {
            const struct section_grain *grain = &section->grain[i];
            const double offset = slices->z[k] - grain->height;
            centre[i][0] = grain->across[0];
            centre[i][1] = grain->across[1];
            radius[i] = sqrt(fmax(0, grain->radius * grain->radius - offset * offset));
        }
        if (radius[0] > 0 && radius[1] > 0 && radius[2] > 0)
            slices->inscribed[k] =
                fmax(slices->inscribed[k], inscribed_disc(centre, radius));
    }
}

static void cut_slices(const struct open_section *section, struct slices *slices)
{
    for (int k = 0; k < POINTS; k++) {
        slices->area[k] = section->area;
        slices->rim[k] = section->wall;
        slices->inscribed[k] = section->wall > 0 ? 0 : HUGE_VAL;
    }
    for (int i = 0; i < section->n_grain; i++)
        block(slices, &section->grain[i]);
    for (int i = 0; i < section->n_overlap; i++)
        for (int k = 0; k < POINTS; k++)
            slices->area[k] += half_lens(&section->overlap[i], slices->z[k]);
}

double open_area(const struct open_section *section, double z)
{
    struct slices slices;
    for (int k = 0; k < POINTS; k++)
        slices.z[k] = z;
    cut_slices(section, &slices);
    return slices.area[0];
}

// f(1 - OPEN), Happel's profile, for the open share of a polygon:
//     open^3 / 3 + open^4 / 4 + ...,
// which the logarithm would lose where little is open.
static double array_profile(double open)
{
    if (open > 0.25) {
        const double solid = 1 - open;
        return -log(solid) - 1.5 + 2 * solid - solid * solid / 2;
    }
    double sum = 0, power = open * open * open;
    for (int k = 3; sum + power / k > sum; k++, power *= open)
        sum += power / k;
    return sum;
}

// What a slice of unit length conducts at unit viscosity, m4; HUGE_VAL without a rim.
// Duct and array both grow as area, polygon and rim together: a polygon that is cut in
// equal parts, as ties of the diagram cut it, conducts as before.
static double slice_conductance(double polygon, double area, double rim,
                                double inscribed)
{
    const double open = area / polygon;
    if (!(rim > 0) || !(open < 1)) return HUGE_VAL;
    const double radius = fmax(0, inscribed);
    const double duct = area * radius * radius / 8;
    const double array =
        polygon * polygon * polygon * (1 - open) * array_profile(open) / (rim * rim);
    // Scaled by the larger one: fourth powers of m4 would underflow.
    const double more = duct > array ? duct : array;
    const double ratio = duct > array ? array / duct : duct / array;
    return more * sqrt(sqrt(1 + ratio * ratio * ratio * ratio));
}

// ---- intervals in which the same grains block ---------------------------------------

// The next place after FROM at which a grain begins or ends.
static double next_break(const struct open_section *section, double from)
{
    double next = section->length;
    for (int k = 0; k < section->n_grain; k++) {
        const struct section_grain *grain = &section->grain[k];
        for (int side = -1; side <= 1; side += 2) {
            const double at = grain->height + side * grain->radius;
            if (at > from && at < next) next = at;
        }
    }
    return next;
}

// The area between two breaks, without lenses.
struct parabola {
    double p, q, centre;
};

static struct parabola area_between(const struct open_section *section, double from,
                                    double to)
{
    const double middle = from + (to - from) / 2;
    double constant = section->area, slope = 0, q = 0;
    for (int k = 0; k < section->n_grain; k++) {
        const struct section_grain *grain = &section->grain[k];
        if (!(fabs(middle - grain->height) < grain->radius)) continue;
        const double half = grain->angle / 2;
        const double lever = grain->height - middle; // centres lie close together
        constant -= half * (grain->radius * grain->radius - lever * lever);
        slope += half * lever;
        q += half;
    }
    if (!(q > 0)) return (struct parabola){constant, 0, middle};
    return (struct parabola){constant - slope * slope / q, q, middle + slope / q};
}

// int dz / area from FROM to TO; HUGE_VAL where the area is not above 0 throughout.
static double resistance(struct parabola area, double from, double to)
{
    const double u = from - area.centre, v = to - area.centre;
    const double nearest = u > 0 ? u : v < 0 ? v : 0;
    if (!(area.p + area.q * nearest * nearest > 0)) return HUGE_VAL;
    if (!(area.q > 0)) return (to - from) / area.p;
    if (area.p > 0) {
        const double k = sqrt(area.p / area.q);
        return atan2(k * (to - from), k * k + u * v) / (area.q * k);
    }
    const double k = sqrt(-area.p / area.q); // below |u| and |v|, which have one sign
    if (!(k > 0)) return (to - from) / (area.q * u * v);
    return log((v - k) * (u + k) / ((v + k) * (u - k))) / (2 * area.q * k);
}

// ---- integrals ----------------------------------------------------------------------

struct integrals {
    double diffusion, flow, wall; // resistances; wall: int rim / (2 area^2)
};

static const struct integrals closed = {HUGE_VAL, HUGE_VAL, HUGE_VAL};

// Adds an interval by its points.
static void add_slices(const struct open_section *section, double from, double to,
                       struct integrals *sum)
{
    struct slices slices;
    const double half = (to - from) / 2;
    for (int k = 0; k < POINTS; k++)
        slices.z[k] = from + half * (1 + ABSCISSA[k]);
    cut_slices(section, &slices);
    if (is_lopsided(section)) widen_slices(section, &slices);
    // Where each grain overlaps the next and no disc fits in, all of them overlap:
    // lenses give their common part back too often.
    const bool ring = section->n_overlap >= section->n_grain && !(section->wall > 0);
    for (int k = 0; k < POINTS; k++) {
        const double weight = half * WEIGHT[k], area = slices.area[k];
        if (!(area > 0) || (ring && !(slices.inscribed[k] > 0))) {
            *sum = closed;
            return;
        }
        sum->diffusion += weight / area;
        sum->flow += weight / slice_conductance(section->area, area, slices.rim[k],
                                                slices.inscribed[k]);
        sum->wall += weight * slices.rim[k] / (2 * area * area);
    }
}

double narrowest_place(const struct open_section *section)
{
    double sum = 0;
    for (int k = 0; k < section->n_grain; k++)
        sum += section->grain[k].height;
    const double mean = section->n_grain ? sum / section->n_grain : 0;
    return fmin(fmax(mean, 0), section->length);
}

static double diffusive_resistance(const struct open_section *section)
{
    double sum = 0, from = 0;
    while (from < section->length) {
        const double to = next_break(section, from);
        sum += resistance(area_between(section, from, to), from, to);
        from = to;
    }
    return sum;
}

static bool lenses_count(const struct open_section *section)
{
    double lens = 0;
    for (int k = 0; k < section->n_overlap; k++)
        lens += half_lens(&section->overlap[k], section->overlap[k].height);
    return lens > LEAST_LENS * section->area;
}

struct throat_shape section_shape(const struct open_section *given)
{
    struct open_section section = *given;
    if (!(section.area > 0)) return (struct throat_shape){0};
    section.length = fmax(section.length, LEAST_LENGTH * sqrt(section.area));
    const bool lenses = lenses_count(&section);
    if (!lenses) section.n_overlap = 0;

    struct integrals sum = {0};
    const double middle = narrowest_place(&section);
    if (lenses && !(open_area(&section, middle) > 0)) sum = closed;
    if (middle > 0) add_slices(&section, 0, middle, &sum);
    if (middle < section.length) add_slices(&section, middle, section.length, &sum);
    if (!lenses) sum.diffusion = diffusive_resistance(&section);
    if (!(sum.diffusion < HUGE_VAL && sum.flow < HUGE_VAL))
        return (struct throat_shape){0};

    const double round = sqrt(section.area / M_PI); // where no grain is beside it
    const double duct = section.area * round * round / 8;
    return (struct throat_shape){1 / sum.diffusion,
                                 sum.flow > 0 ? 1 / sum.flow : duct / section.length,
                                 sum.wall > 0 ? sum.diffusion / sum.wall : round};
}
