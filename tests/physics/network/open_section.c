// SPDX-License-Identifier: GPL-3.0-or-later
// Open sections of throats against areas counted point by point, resistances against
// Simpson's rule, and ducts of known resistance.
#include "network/open_section.h"
#include "network/inscribed_disc.h"

#include "../../test.h"

#include <stdbool.h>

enum { GRAINS = 3 };

// Three grains in the plane, and the polygon between them.
struct triangle {
    double x[GRAINS], y[GRAINS], radius[GRAINS], height;
    double foot[2]; // where the throat goes through the plane
};

static double apart(const struct triangle *triangle, int a, int b)
{
    return hypot(triangle->x[a] - triangle->x[b], triangle->y[a] - triangle->y[b]);
}

// The angle at corner I by the law of cosines.
static double angle(const struct triangle *triangle, int i)
{
    const int j = (i + 1) % GRAINS, k = (i + 2) % GRAINS;
    const double a = apart(triangle, i, j), b = apart(triangle, i, k),
                 c = apart(triangle, j, k);
    return acos((a * a + b * b - c * c) / (2 * a * b));
}

static double area_of(const struct triangle *triangle)
{
    const double a = apart(triangle, 0, 1), b = apart(triangle, 1, 2),
                 c = apart(triangle, 2, 0), s = (a + b + c) / 2;
    return sqrt(s * (s - a) * (s - b) * (s - c)); // Heron
}

static struct open_section section_of(const struct triangle *triangle, double length,
                                      struct section_grain grain[GRAINS],
                                      struct section_overlap overlap[GRAINS])
{
    struct open_section section = {.area = area_of(triangle),
                                   .length = length,
                                   .n_grain = GRAINS,
                                   .grain = grain,
                                   .overlap = overlap};
    for (int i = 0; i < GRAINS; i++) {
        const int j = (i + 1) % GRAINS;
        const double d = apart(triangle, i, j), r = triangle->radius[i],
                     s = triangle->radius[j];
        const double reach = hypot(triangle->foot[0] - triangle->x[i],
                                   triangle->foot[1] - triangle->y[i]);
        grain[i] = (struct section_grain){
            angle(triangle, i),
            r,
            triangle->height,
            reach,
            {triangle->x[i] - triangle->foot[0], triangle->y[i] - triangle->foot[1]}};
        if (!(r + s > d)) continue;
        const double x = (d * d + r * r - s * s) / (2 * d);
        overlap[section.n_overlap++] =
            (struct section_overlap){{x, d - x}, {r, s}, triangle->height};
    }
    return section;
}

static bool is_inside(const struct triangle *triangle, double x, double y)
{
    int left = 0;
    for (int i = 0; i < GRAINS; i++) {
        const int j = (i + 1) % GRAINS;
        left += (triangle->x[j] - triangle->x[i]) * (y - triangle->y[i]) -
                    (triangle->y[j] - triangle->y[i]) * (x - triangle->x[i]) >
                0;
    }
    return left == 0 || left == GRAINS;
}

// The part of the triangle that no disc covers, on a grid of points.
static double counted_area(const struct triangle *triangle, double z)
{
    enum { ACROSS = 1500 };
    const double side = 4.0 / ACROSS, offset = z - triangle->height;
    int open = 0;
    for (int i = 0; i < ACROSS; i++)
        for (int k = 0; k < ACROSS; k++) {
            const double x = -1 + (i + 0.5) * side, y = -1 + (k + 0.5) * side;
            bool free = is_inside(triangle, x, y);
            for (int g = 0; g < GRAINS && free; g++) {
                const double rho2 =
                    triangle->radius[g] * triangle->radius[g] - offset * offset;
                const double dx = x - triangle->x[g], dy = y - triangle->y[g];
                free = dx * dx + dy * dy >= rho2;
            }
            open += free;
        }
    return open * side * side;
}

static const struct triangle touching = {{0, 1, 0.5},
                                         {0, 0, 0.8660254037844386},
                                         {0.5, 0.5, 0.5},
                                         0.3,
                                         {0.5, 0.2886751345948129}};
static const struct triangle unequal = {
    {0, 1.2, 0.3}, {0, 0.1, 1.1}, {0.7, 0.4, 0.35}, 0.1, {0.6, 0.5}};
static const struct triangle overlapping = {
    {0, 1, 0.4}, {0, 0, 1}, {0.55, 0.52, 0.5}, 0.4, {0.5, 0.4}};

static void assert_areas(const struct triangle *triangle)
{
    struct section_grain grain[GRAINS];
    struct section_overlap overlap[GRAINS];
    const struct open_section section = section_of(triangle, 1, grain, overlap);
    for (int k = 0; k <= 4; k++) {
        const double z = 0.25 * k;
        assert_within(open_area(&section, z), counted_area(triangle, z), 1e-3);
    }
}

TEST(areas)
{
    assert_areas(&touching);
    assert_areas(&unequal);
    assert_areas(&overlapping);
}

// 1 / int dz / area by Simpson's rule.
static double summed_diffusion(const struct open_section *section)
{
    enum { STEPS = 100000 };
    const double step = section->length / STEPS;
    double sum = 0;
    for (int k = 0; k <= STEPS; k++) {
        const int weight = k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2;
        sum += weight * step / 3 / open_area(section, k * step);
    }
    return 1 / sum;
}

static void assert_diffusion(const struct triangle *triangle, double length,
                             double tolerance)
{
    struct section_grain grain[GRAINS];
    struct section_overlap overlap[GRAINS];
    const struct open_section section = section_of(triangle, length, grain, overlap);
    const double wanted = summed_diffusion(&section);
    assert_close(section_shape(&section).diffusion, wanted, tolerance);
}

TEST(diffusion)
{
    assert_diffusion(&touching, 1.3, 1e-9); // grains end within the throat
    assert_diffusion(&touching, 0.2, 1e-9); // before the narrowest place
    assert_diffusion(&unequal, 1.1, 1e-9);
    assert_diffusion(&overlapping, 1, 1e-3); // by six points on each side
}

// Far from any grain a throat is the prism of its polygon.
TEST(prism)
{
    struct section_grain grain[GRAINS];
    struct section_overlap overlap[GRAINS];
    struct triangle far = touching;
    far.height = -3;
    const struct open_section section = section_of(&far, 2, grain, overlap);
    assert_close(section_shape(&section).diffusion, area_of(&far) / 2, 1e-15);
}

// Three discs that cover the middle of the triangle close the throat.
TEST(closed)
{
    struct section_grain grain[GRAINS];
    struct section_overlap overlap[GRAINS];
    struct triangle covered = touching;
    for (int i = 0; i < GRAINS; i++)
        covered.radius[i] = 0.58; // three discs over the middle
    const struct open_section section = section_of(&covered, 1, grain, overlap);
    const struct throat_shape shape = section_shape(&section);
    assert_true(shape.diffusion == 0);
    assert_true(shape.flow == 0);
}

// Everything in other units: conductances scale as length and length^3.
TEST(units)
{
    struct section_grain grain[GRAINS];
    struct section_overlap overlap[GRAINS];
    const struct open_section section = section_of(&unequal, 1.1, grain, overlap);
    const struct throat_shape shape = section_shape(&section);
    struct triangle small = unequal;
    const double unit = 0x1p-30;
    for (int i = 0; i < GRAINS; i++) {
        small.x[i] *= unit;
        small.y[i] *= unit;
        small.radius[i] *= unit;
    }
    small.height *= unit;
    small.foot[0] *= unit;
    small.foot[1] *= unit;
    struct section_grain other[GRAINS];
    const struct open_section scaled = section_of(&small, 1.1 * unit, other, overlap);
    const struct throat_shape tiny = section_shape(&scaled);
    assert_close(tiny.diffusion, unit * shape.diffusion, 1e-13);
    assert_close(tiny.flow, unit * unit * unit * shape.flow, 1e-13);
    assert_close(tiny.hydraulic_radius, unit * shape.hydraulic_radius, 1e-13);
}

// Discs that touch each other: Descartes' theorem on curvatures. And a disc that is
// known to touch three others, wherever they lie.
TEST(inscribed)
{
    const double a = 1, b = 0.4, c = 0.15, ab = a + b, ac = a + c, bc = b + c;
    const double x = (ab * ab + ac * ac - bc * bc) / (2 * ab);
    const double centre[3][2] = {{0, 0}, {ab, 0}, {x, sqrt(ac * ac - x * x)}};
    const double radius[3] = {a, b, c}, k[3] = {1 / a, 1 / b, 1 / c};
    const double inner =
        k[0] + k[1] + k[2] + 2 * sqrt(k[0] * k[1] + k[1] * k[2] + k[2] * k[0]);
    assert_close(inscribed_disc(centre, radius), 1 / inner, 1e-12);

    const double disc = 0.37, turn[3] = {0.3, 2.2, 4.4}, around[3] = {1.3, 0.2, 0.05};
    double placed[3][2];
    for (int i = 0; i < 3; i++) {
        placed[i][0] = 5 + (disc + around[i]) * cos(turn[i]);
        placed[i][1] = -2 + (disc + around[i]) * sin(turn[i]);
    }
    assert_close(inscribed_disc(placed, around), disc, 1e-12);

    const double in_line[3][2] = {{0, 0}, {1, 0}, {2, 0}};
    assert_true(inscribed_disc(in_line, around) == 0);
    const double wide[3] = {3, 3, 3}; // cover the gap
    assert_true(inscribed_disc(placed, wide) == 0);
}
