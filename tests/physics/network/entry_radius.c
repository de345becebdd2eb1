// SPDX-License-Identifier: GPL-3.0-or-later
// The radius at which gas enters between discs: rods that touch in their closed form,
// unequal discs with contact angles by virtual work, and units.
#include "network/entry_radius.h"

#include "../../test.h"

enum { MOST = 6 };

// A polygon of equal discs around the origin, neighbours APART.
static struct open_section regular(int n, double radius, double apart,
                                   struct section_grain grain[MOST],
                                   struct section_gap gap[MOST])
{
    const double angle = M_PI * (n - 2) / n;
    for (int i = 0; i < n; i++) {
        grain[i] = (struct section_grain){
            .angle = angle, .radius = radius, .reach = apart / (2 * sin(M_PI / n))};
        gap[i] = (struct section_gap){{i, (i + 1) % n}, apart};
    }
    return (struct open_section){.area = n * apart * apart / (4 * tan(M_PI / n)),
                                 .length = radius,
                                 .n_grain = n,
                                 .n_gap = n,
                                 .grain = grain,
                                 .gap = gap};
}

// Gas area less R (menisci + rim) between N touching rods of radius 1, wetted
// perfectly: menisci of radius R touch the rods at acos(1 / (1 + R)) from the line
// between them.
static double excess(int n, double R)
{
    const double wetted = acos(1 / (1 + R)), turned = M_PI - 2 * wetted;
    const double height = sqrt((1 + R) * (1 + R) - 1);
    const double liquid = height - wetted - turned * R * R / 2;
    const double angle = M_PI * (n - 2) / n;
    const double gas = n / tan(M_PI / n) - n * angle / 2 - n * liquid;
    return gas - R * (n * R * turned + n * (angle - 2 * wetted));
}

TEST(touching_rods)
{
    for (int n = 3; n <= 4; n++) {
        double low = 1e-3, high = 0.6;
        for (int k = 0; k < 100; k++) {
            const double R = (low + high) / 2;
            *(excess(n, R) > 0 ? &low : &high) = R;
        }
        struct section_grain grain[MOST];
        struct section_gap gap[MOST];
        const struct open_section section = regular(n, 1, 2, grain, gap);
        assert_close(entry_radius(&section, 0), 2 * low, 1e-10);
    }
}

// Gas area less R (menisci + cos(theta) rim) between three rods of radius 1, their
// centres APART, also less than 2: the hexagon of the six contacts, less three segments
// of rods, with three of menisci.
static double excess_of_three(double apart, double angle, double R)
{
    const double l = sqrt(1 + R * R + 2 * R * cos(angle)), half = apart / 2;
    const double from_line =
        acos(half / l) - atan2(R * sin(angle), 1 + R * cos(angle)); // of the contact
    const double rim = M_PI / 3 - 2 * from_line;
    const double wide = apart - 2 * cos(from_line); // between the contacts
    const double turned = 2 * asin(wide / (2 * R));
    const double inner = 2 * sin(rim / 2); // the other sides of the hexagon
    const double side = wide + 2 * inner;  // of the triangle that they cut off
    const double hexagon = sqrt(3) / 4 * (side * side - 3 * inner * inner);
    return hexagon - 1.5 * (rim - sin(rim)) + 1.5 * R * R * (turned - sin(turned)) -
           3 * R * (R * turned + cos(angle) * rim);
}

TEST(overlapping_rods)
{
    for (double apart = 1.8; apart < 2.05; apart += 0.05)
        for (int degrees = 0; degrees < 30; degrees += 12) {
            const double angle = degrees * M_PI / 180;
            double low = 1e-2, high = 0.3;
            for (int k = 0; k < 100; k++) {
                const double R = (low + high) / 2;
                *(excess_of_three(apart, angle, R) > 0 ? &low : &high) = R;
            }
            struct section_grain grain[MOST];
            struct section_gap gap[MOST];
            struct section_overlap overlap[MOST];
            struct open_section section = regular(3, 1, apart, grain, gap);
            for (int i = 0; i < 3 && apart < 2; i++)
                overlap[section.n_overlap++] =
                    (struct section_overlap){{apart / 2, apart / 2}, {1, 1}, 0};
            section.overlap = overlap;
            assert_close(entry_radius(&section, angle), 2 * cos(angle) * low, 1e-9);
        }
}

// Discs far apart: gas enters when the menisci between two of them meet, half a circle
// across the gap.
TEST(far_discs)
{
    struct section_grain grain[MOST];
    struct section_gap gap[MOST];
    const struct open_section section = regular(4, 0.05, 1, grain, gap);
    assert_close(entry_radius(&section, 0), 1 - 2 * 0.05, 1e-9);
}

// With a contact angle too: the meniscus goes on past the line between the discs, its
// centre comes to that line, l = 1/2 from both.
TEST(far_discs_at_an_angle)
{
    struct section_grain grain[MOST];
    struct section_gap gap[MOST];
    const double r = 0.05;
    const struct open_section section = regular(4, r, 1, grain, gap);
    for (int degrees = 20; degrees <= 80; degrees += 20) {
        const double angle = degrees * M_PI / 180, half = r * cos(angle);
        const double R = sqrt(half * half + 0.25 - r * r) - half;
        assert_close(entry_radius(&section, angle), 2 * cos(angle) * R, 1e-9);
    }
}

// Half a square, cut along a mirror, is as the square.
TEST(mirrors)
{
    struct section_grain grain[MOST], half_grain[MOST];
    struct section_gap gap[MOST], half_gap[MOST];
    const struct open_section whole = regular(4, 1, 2, grain, gap);
    const struct open_section half = {.area = 2,
                                      .length = 1,
                                      .n_grain = 2,
                                      .n_gap = 3,
                                      .grain = half_grain,
                                      .gap = half_gap};
    for (int i = 0; i < 2; i++) {
        half_grain[i] =
            (struct section_grain){.angle = M_PI / 2, .radius = 1, .reach = sqrt(2)};
        half_gap[i] = (struct section_gap){{i, -1}, 1};
    }
    half_gap[2] = (struct section_gap){{0, 1}, 2};
    for (int degrees = 0; degrees <= 60; degrees += 20) {
        const double angle = degrees * M_PI / 180;
        assert_close(entry_radius(&half, angle), entry_radius(&whole, angle), 1e-12);
    }
}

// Liquid that wets worse lets gas in at a lower pressure: cos(theta) / radius falls.
TEST(wetting)
{
    struct section_grain grain[MOST];
    struct section_gap gap[MOST];
    const struct open_section section = regular(3, 1, 2.1, grain, gap);
    double last = HUGE_VAL;
    for (int degrees = 0; degrees < 90; degrees += 10) {
        const double angle = degrees * M_PI / 180;
        const double pressure = 2 * cos(angle) / entry_radius(&section, angle);
        assert_true(pressure < last && pressure > 0);
        last = pressure;
    }
}

TEST(units)
{
    struct section_grain grain[MOST], small_grain[MOST];
    struct section_gap gap[MOST], small_gap[MOST];
    const struct open_section section = regular(3, 1, 2.1, grain, gap);
    const double unit = 0x1p-22;
    const struct open_section small =
        regular(3, unit, 2.1 * unit, small_grain, small_gap);
    assert_close(entry_radius(&small, 0.3), unit * entry_radius(&section, 0.3), 1e-11);
}
