// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of a packing, against closed forms: cut spheres and lenses, lattices,
// chains, Poisson points.
#include "../../test.h"
#include "../support_lattice.h"
#include "basics/memory.h"
#include "geometry/fabric.h"
#include "geometry/neighbours.h"
#include "geometry/radial_distribution.h"
#include "geometry/sphere_box_volume.h"

#include <gsl/gsl_integration.h>
#include <stdlib.h>
#include <string.h>

static const double far = HUGE_VAL;

// ---- cut spheres --------------------------------------------------------------------

static double from(double x, double y, double z)
{
    return sphere_in_box(1, (struct vector){x, y, z}, (struct vector){far, far, far});
}

TEST(planes_through_the_middle_halve_a_sphere)
{
    const double whole = 4 * M_PI / 3;
    assert_within(from(-far, -far, -far), whole, 1e-15);
    assert_within(from(0, -far, -far), whole / 2, 1e-15);
    assert_within(from(-far, 0, 0), whole / 4, 1e-15);
    assert_within(from(0, 0, 0), whole / 8, 1e-15);
}

TEST(caps)
{
    for (double h = 0.05; h < 2; h += 0.05) {
        const double cap = M_PI * h * h * (3 - h) / 3;
        assert_within(from(1 - h, -far, -far), cap, 1e-14);
        assert_within(from(-far, 1 - h, -far), cap, 1e-14);
        assert_within(from(-far, -far, 1 - h), cap, 1e-14);
    }
}

// A plane, an edge or a corner that touches the sphere from within or without.
TEST(touching_planes_cut_nothing)
{
    const double whole = 4 * M_PI / 3, edge = sqrt(0.5), corner = sqrt(1. / 3);
    const struct vector one = {1, 1, 1};
    assert_within(sphere_in_box(1, scale(-1, one), one), whole, 1e-15);
    assert_within(from(1, -far, -far), 0, 0);
    assert_within(from(edge, edge, -far), 0, 1e-14);
    assert_within(from(corner, corner, corner), 0, 1e-14);
    assert_within(from(0.9, 0.9, 0.9), 0, 0);
    assert_within(from(-1, 0, 0), whole / 4, 1e-15);
}

// The cube inscribed in a sphere is all sphere; half of one not quite in it as well.
TEST(a_box_within_is_full)
{
    const struct vector half = {0.5, 0.3, 0.6};
    assert_within(sphere_in_box(1, scale(-1, half), half), 8 * 0.5 * 0.3 * 0.6, 1e-14);
    const double a = sqrt(1. / 3);
    const struct vector cube = {a, a, a};
    assert_within(sphere_in_box(1, scale(-1, cube), cube), 8 * a * a * a, 1e-14);
}

// x > a, y > b, z > c by another road: what is left of the area of a disc.
struct corner {
    double a, b, c;
};

static double height_above(double y, double x, double c)
{
    return fmax(0, sqrt(fmax(0, 1 - x * x - y * y)) - c);
}

// Integral of height_above over y, by its antiderivative.
static double slice_area(double x, void *data)
{
    const struct corner *corner = data;
    const double disc = 1 - x * x, end2 = disc - corner->c * corner->c;
    if (end2 <= 0) return 0;
    const double end = sqrt(end2), b = fmax(corner->b, -end);
    if (b >= end) return 0;
    const double r = sqrt(disc);
    const double top = 0.5 * (end * sqrt(disc - end * end) + disc * asin(end / r));
    const double low = 0.5 * (b * sqrt(disc - b * b) + disc * asin(b / r));
    return top - low - corner->c * (end - b);
}

TEST(corners_by_quadrature)
{
    assert_within(height_above(0, 0, 0), 1, 0);
    gsl_integration_cquad_workspace *room = gsl_integration_cquad_workspace_alloc(200);
    uint64_t seed = 1;
    for (int k = 0; k < 200; k++) {
        // c >= 0, so that the section is above one arc
        struct corner corner = {2 * next_random(&seed) - 1, 2 * next_random(&seed) - 1,
                                next_random(&seed)};
        const gsl_function area = {slice_area, &corner};
        double volume, error;
        const double end = sqrt(1 - corner.c * corner.c);
        if (corner.a >= end) continue;
        const double start = fmax(corner.a, -end);
        gsl_integration_cquad(&area, start, end, 1e-13, 0, room, &volume, &error, NULL);
        assert_within(from(corner.a, corner.b, corner.c), volume, 1e-11);
    }
    gsl_integration_cquad_workspace_free(room);
}

// Boxes side by side share out the whole sphere, at any scale.
TEST(parts_add_up_at_any_scale)
{
    const double scales[] = {1, 3e-9, 7e3};
    for (int s = 0; s < 3; s++) {
        const double r = scales[s], whole = 4 * M_PI / 3 * r * r * r;
        const double at[3][4] = {{-far, -0.3 * r, 0.7 * r, far},
                                 {-far, 0.1 * r, 0.2 * r, far},
                                 {-far, -0.9 * r, -0.2 * r, far}};
        double sum = 0;
        for (int k = 0; k < 27; k++) {
            const int x = k % 3, y = k / 3 % 3, z = k / 9;
            sum += sphere_in_box(
                r, (struct vector){at[0][x], at[1][y], at[2][z]},
                (struct vector){at[0][x + 1], at[1][y + 1], at[2][z + 1]});
        }
        assert_within(sum / whole, 1, 1e-14);
    }
}

// ---- lenses -------------------------------------------------------------------------

static double cap(double radius, double height)
{
    return M_PI * height * height * (3 * radius - height) / 3;
}

TEST(a_lens_is_two_caps)
{
    assert_within(lens_volume(1, 1, 1), 5 * M_PI / 12, 1e-15);
    assert_within(lens_volume(1, 1, 2), 0, 0);
    assert_within(lens_volume(1, 1, 0), 4 * M_PI / 3, 1e-15);
    assert_within(lens_volume(2, 0.5, 1), M_PI / 6, 1e-15);
    assert_within(lens_volume(2, 0.5, 1.5), M_PI / 6, 1e-15); // just inside
    const double a = 1, b = 0.6, d = 1.3, x = (d * d + a * a - b * b) / (2 * d);
    assert_within(lens_volume(a, b, d), cap(a, a - x) + cap(b, b - (d - x)), 1e-14);
}

// Half a lens by another road: along its own axis its sections are discs, and a plane
// cuts segments off them.
struct cut_lens {
    double first, second, distance, slope, offset; // of the cut
};

static double disc_part(double t, void *data)
{
    const struct cut_lens *lens = data;
    const double s = t - lens->distance;
    const double square =
        fmin(lens->first * lens->first - t * t, lens->second * lens->second - s * s);
    if (square <= 0) return 0;
    const double r = sqrt(square), x = (lens->offset - lens->slope * t) /
                                       sqrt(1 - lens->slope * lens->slope);
    if (x >= r) return M_PI * square;
    if (x <= -r) return 0;
    return square * (M_PI - acos(x / r)) + x * sqrt(square - x * x);
}

static double lens_below(double first, double second, struct vector apart, double z)
{
    const struct lens lens = lens_between(first, second, apart);
    return lens_in_box(&lens, (struct vector){-far, -far, -far},
                       (struct vector){far, far, z});
}

TEST(cut_lenses_by_quadrature)
{
    gsl_integration_cquad_workspace *room = gsl_integration_cquad_workspace_alloc(400);
    uint64_t seed = 5;
    for (int k = 0; k < 300; k++) {
        const double a = 1, b = 0.4 + 0.6 * next_random(&seed);
        const double gap = k % 2 ? 1e-3 : 0.5 * next_random(&seed);
        const double slope = 2 * next_random(&seed) - 1, d = a + b - 2 * gap * b;
        const double across = sqrt(1 - slope * slope) * d;
        const struct vector apart = {0.6 * across, -0.8 * across, slope * d};
        const double plane = (d * d + a * a - b * b) / (2 * d);
        const double z = plane * slope + (next_random(&seed) - 0.5) * sqrt(gap);
        struct cut_lens lens = {a, b, d, slope, z};
        const gsl_function area = {disc_part, &lens};
        double left, right, error;
        gsl_integration_cquad(&area, d - b, plane, 0, 1e-10, room, &left, &error, NULL);
        gsl_integration_cquad(&area, plane, a, 0, 1e-10, room, &right, &error, NULL);
        const double spheres = 4 * M_PI / 3 * (a * a * a + b * b * b);
        assert_within(lens_below(a, b, apart, z), left + right,
                      1e-14 * spheres + 1e-9 * (left + right));
    }
    gsl_integration_cquad_workspace_free(room);
}

TEST(lenses_cut_along_and_across)
{
    const double whole = lens_volume(1, 1, 1.8);
    const struct vector along = {0, 0, 1.8}, across = {1.8, 0, 0};
    assert_within(lens_below(1, 1, along, 0.9), whole / 2, 1e-13);
    assert_within(lens_below(1, 1, along, 0.95), whole - cap(1, 0.05), 1e-13);
    assert_within(lens_below(1, 1, across, 0), whole / 2, 1e-13);
    assert_within(lens_below(1, 1, along, 0.8), 0, 1e-13);
    assert_within(lens_below(1, 1, along, 1), whole, 0);
    assert_within(lens_below(2, 0.5, (struct vector){0, 0, 1}, 1), M_PI / 12, 1e-14);
    assert_within(lens_below(0.5, 2, (struct vector){0, 0, 1}, 0), M_PI / 12, 1e-14);
    const struct vector low = {-far, 0, -far}, high = {far, far, 0}; // a quarter of it
    const struct lens lens = lens_between(1, 1, across);
    assert_within(lens_in_box(&lens, low, high), whole / 4, 1e-13);
}

// ---- lattices -----------------------------------------------------------------------

enum cell { CUBIC, BODY_CENTRED, FACE_CENTRED };

// SIDE^3 cells of touching grains in a box that repeats, moved off its sides.
static struct packing lattice(enum cell kind, int side, double radius)
{
    static const int most[] = {1, 2, 4};
    static const double edge[] = {2, 2.3094010767585030, 2.8284271247461901};
    static const double place[3][4][3] = {
        {{0}},
        {{0}, {0.5, 0.5, 0.5}},
        {{0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}};
    const double a = edge[kind] * radius;
    struct packing packing = {.n_particle = most[kind] * side * side * side,
                              .upper = {a * side, a * side, a * side},
                              .periodic = {1, 1, 1}};
    packing.position = NEW_ARRAY(struct vector, packing.n_particle);
    packing.radius = NEW_ARRAY(double, packing.n_particle);
    for (int i = 0; i < packing.n_particle; i++) {
        const int cell = i / most[kind];
        const double *at = place[kind][i % most[kind]];
        packing.position[i] = (struct vector){a * (cell % side + at[0] + 0.1),
                                              a * (cell / side % side + at[1] + 0.2),
                                              a * (cell / side / side + at[2] + 0.25)};
        packing.radius[i] = radius;
    }
    return packing;
}

static struct contacts contacts_of(const struct packing *packing)
{
    struct contacts contacts;
    contacts.pair =
        (const int32_t(*)[2])neighbour_pairs(packing, 1e-9, &contacts.count);
    return contacts;
}

static void free_contacts(struct contacts *contacts)
{
    free((void *)(uintptr_t)contacts->pair);
}

static double bulk_porosity(const struct packing *packing)
{
    struct contacts contacts = contacts_of(packing);
    struct window window;
    double porosity;
    assert_true(inner_window(packing, &window));
    slice_porosity(packing, &contacts, &window, 1, &porosity);
    free_contacts(&contacts);
    return porosity;
}

TEST(porosity_of_lattices)
{
    const double wanted[] = {1 - M_PI / 6, 1 - M_PI * sqrt(3) / 8, 1 - M_PI / sqrt(18)};
    const double scales[] = {1, 1e-9, 1e3};
    for (enum cell kind = CUBIC; kind <= FACE_CENTRED; kind++)
        for (int s = 0; s < 3; s++) {
            struct packing packing = lattice(kind, 4, scales[s]);
            assert_within(bulk_porosity(&packing), wanted[kind], 2e-9); // contacts open
            packing_free(&packing);
        }
}

// Walls cut the grains of the bulk; a window of whole cells has the porosity of all.
TEST(porosity_between_walls)
{
    struct packing packing = lattice(FACE_CENTRED, 7, 1);
    struct contacts contacts = contacts_of(&packing);
    const double a = 2 * sqrt(2);
    const struct window window = {{1.37 * a, 2.11 * a, 1.77 * a},
                                  {4.37 * a, 5.11 * a, 5.77 * a}};
    double porosity;
    memset(packing.periodic, 0, 3);
    slice_porosity(&packing, &contacts, &window, 1, &porosity);
    assert_within(porosity, 1 - M_PI / sqrt(18), 1e-13);
    free_contacts(&contacts);
    packing_free(&packing);
}

// Layers of spheres: section pi (1 - z^2) over 4, integrated.
TEST(slices_of_a_cubic_lattice)
{
    enum { SLICES = 40 };
    for (int periodic = 0; periodic < 2; periodic++) {
        struct packing packing = lattice(CUBIC, 4, 1);
        for (int i = 0; i < packing.n_particle; i++)
            packing.position[i].z += 0.5; // grains from 0 to 8
        packing.periodic[2] = (uint8_t)periodic;
        struct contacts contacts = contacts_of(&packing);
        const struct window window = {packing.lower, packing.upper};
        double porosity[SLICES];
        slice_porosity(&packing, &contacts, &window, SLICES, porosity);
        for (int k = 0; k < SLICES; k++) {
            const double low = 0.2 * (k % 10) - 1, high = low + 0.2;
            const double solid =
                M_PI * (high - low - (pow(high, 3) - pow(low, 3)) / 3) / (4 * 0.2);
            assert_within(porosity[k], 1 - solid, 1e-13);
        }
        free_contacts(&contacts);
        packing_free(&packing);
    }
}

// Overlaps count once: the solid of slices is that of the spheres less the lenses.
TEST(slices_hold_the_solid_volume)
{
    enum { SLICES = 37 };
    struct packing packing = lattice(BODY_CENTRED, 4, 1);
    for (int i = 0; i < packing.n_particle; i++)
        packing.radius[i] = 1.03;
    struct contacts contacts = contacts_of(&packing);
    assert_int_equal(contacts.count, 4 * packing.n_particle);
    const double solid = packing.n_particle *
                         (4 * M_PI / 3 * pow(1.03, 3) - 4 * lens_volume(1.03, 1.03, 2));
    assert_within(solid_volume(&packing, &contacts) / solid, 1, 1e-12);
    const struct window window = {packing.lower, packing.upper};
    double porosity[SLICES], sum = 0;
    slice_porosity(&packing, &contacts, &window, SLICES, porosity);
    for (int k = 0; k < SLICES; k++)
        sum += (1 - porosity[k]) / SLICES;
    assert_within(sum * pow(packing.upper.x, 3) / solid, 1, 1e-10);
    free_contacts(&contacts);
    packing_free(&packing);
}

// One layer: nothing is left out along y, and a square lattice of spheres has 1 - pi/6.
TEST(porosity_of_one_layer)
{
    struct packing packing = lattice(CUBIC, 6, 1);
    int n = 0;
    for (int i = 0; i < packing.n_particle; i++) {
        if (packing.position[i].y > 2) continue;
        packing.position[n] = packing.position[i];
        packing.position[n++].y = 1;
    }
    packing.n_particle = n;
    packing.upper.y = 2;
    memset(packing.periodic, 0, 3);
    assert_int_equal(n, 36);
    assert_true(packing_is_flat(&packing));
    assert_within(bulk_porosity(&packing), 1 - M_PI / 6, 1e-9);
    packing_free(&packing);
}

TEST(no_bulk_between_near_walls)
{
    struct packing packing = lattice(CUBIC, 2, 1);
    packing.periodic[0] = 0;
    struct window window;
    assert_false(inner_window(&packing, &window));
    packing_free(&packing);
}

// ---- contacts -----------------------------------------------------------------------

TEST(contacts_of_lattices)
{
    const int wanted[] = {6, 8, 12};
    for (enum cell kind = CUBIC; kind <= FACE_CENTRED; kind++) {
        struct packing packing = lattice(kind, 3, 1e-6);
        struct contacts contacts = contacts_of(&packing);
        int *walls = wall_contacts(&packing, 1e-9);
        int *count = grain_contacts(&packing, &contacts);
        uint8_t *rattler =
            find_rattlers(&packing, &contacts, walls, least_contacts(&packing, false));
        double fabric[9];
        assert_true(fabric_tensor(&packing, &contacts, fabric));
        for (int i = 0; i < packing.n_particle; i++) {
            assert_int_equal(count[i], wanted[kind]);
            assert_int_equal(walls[i], 0);
            assert_int_equal(rattler[i], 0);
        }
        for (int c = 0; c < 9; c++)
            assert_within(fabric[c], c % 4 ? 0 : 1. / 3, 1e-14);
        assert_within(fabric_deviator(fabric, false), 0, 1e-14);
        free(walls);
        free(count);
        free(rattler);
        free_contacts(&contacts);
        packing_free(&packing);
    }
}

// COUNT touching grains in a row along a direction, far from any wall.
static struct packing chain(int count, struct vector direction)
{
    struct packing packing = {
        .n_particle = count, .lower = {-99, -99, -99}, .upper = {99, 99, 99}};
    packing.position = NEW_ARRAY(struct vector, count);
    packing.radius = NEW_ARRAY(double, count);
    for (int i = 0; i < count; i++) {
        packing.position[i] = scale(2 * i, direction);
        packing.radius[i] = 1;
    }
    return packing;
}

TEST(fabric_of_a_chain)
{
    const struct vector e = {2. / 7, 3. / 7, 6. / 7};
    struct packing packing = chain(5, e);
    struct contacts contacts = contacts_of(&packing);
    double fabric[9], density[9];
    assert_true(fabric_tensor(&packing, &contacts, fabric));
    for (int c = 0; c < 9; c++)
        assert_within(fabric[c], component(e, c / 3) * component(e, c % 3), 1e-14);
    assert_within(fabric_deviator(fabric, false), 1, 1e-14);
    contact_inclination(&packing, &contacts, 9, density); // acos(6/7) = 31 degrees
    for (int k = 0; k < 9; k++)
        assert_within(density[k], k == 3 ? 1 / (cos(M_PI / 6) - cos(4 * M_PI / 18)) : 0,
                      1e-12);
    free_contacts(&contacts);
    packing_free(&packing);
}

// In one plane a triangular lattice is isotropic, a chain is not.
TEST(fabric_of_one_layer)
{
    const double isotropic[9] = {0.5, 0, 0, 0, 0, 0, 0, 0, 0.5};
    const double line[9] = {[8] = 1};
    assert_within(fabric_deviator(isotropic, true), 0, 0);
    assert_within(fabric_deviator(line, true), 1, 1e-15);
    struct packing packing = chain(4, (struct vector){0, 0, 1});
    packing.lower.y = -1;
    packing.upper.y = 1;
    assert_true(packing_is_flat(&packing));
    struct contacts contacts = contacts_of(&packing);
    double density[6];
    contact_inclination(&packing, &contacts, 6, density);
    assert_within(density[0], 6, 1e-14); // all in one class of six
    free_contacts(&contacts);
    packing_free(&packing);
}

// A chain unravels from its ends; a lattice between walls stands; a free grain rattles.
TEST(rattlers_unravel)
{
    struct packing packing = lattice(CUBIC, 4, 1);
    for (int i = 0; i < packing.n_particle; i++)
        packing.position[i].z += 0.5;
    memset(packing.periodic, 0, 2); // grains no longer touch across x and y
    struct contacts contacts = contacts_of(&packing);
    int *none = NEW_ARRAY(int, packing.n_particle);
    uint8_t *rattler =
        find_rattlers(&packing, &contacts, none, least_contacts(&packing, false));
    for (int i = 0; i < packing.n_particle; i++)
        assert_int_equal(rattler[i], 0); // 4 contacts along the edges
    free(rattler);
    free_contacts(&contacts);

    packing.periodic[2] = 0; // now the corners have 3, and all comes apart
    contacts = contacts_of(&packing);
    rattler = find_rattlers(&packing, &contacts, none, least_contacts(&packing, false));
    int rattlers = 0;
    for (int i = 0; i < packing.n_particle; i++)
        rattlers += rattler[i];
    assert_int_equal(rattlers, 64);
    free(rattler);

    for (int i = 0; i < packing.n_particle; i++) // walls hold it
        packing.position[i] = add(packing.position[i], (struct vector){0.8, 0.6, 0});
    int *walls = wall_contacts(&packing, 1e-9), at_walls = 0;
    rattler =
        find_rattlers(&packing, &contacts, walls, least_contacts(&packing, false));
    for (int i = 0; i < packing.n_particle; i++) {
        assert_int_equal(rattler[i], 0);
        at_walls += walls[i];
    }
    assert_int_equal(at_walls, 6 * 16);
    free(walls);
    free(rattler);
    free(none);
    free_contacts(&contacts);
    packing_free(&packing);
}

// ---- radial distribution ------------------------------------------------------------

// Neighbours of a grain in the shells of an fcc lattice: r^2 / 2 a^2 = 1, 2, 3, ...
TEST(shells_of_fcc)
{
    static const int wanted[] = {12, 6, 24, 12, 24, 8, 48, 6, 36, 24};
    enum { COUNT = 71 };
    const double scales[] = {1, 1e-9};
    for (int s = 0; s < 2; s++) {
        const double radius = scales[s], width = 0.1 * radius;
        struct packing packing =
            lattice(FACE_CENTRED, 3, radius); // 3 cells < 2 reaches
        const struct window window = {packing.lower, packing.upper};
        double g[COUNT];
        assert_true(radial_reach(&packing, &window) >= COUNT * width);
        assert_true(radial_distribution(&packing, &window, width, COUNT, g));
        const double density = (packing.n_particle - 1) / pow(packing.upper.x, 3);
        double found[COUNT], sum = 0, all = 0;
        for (int k = 0; k < COUNT; k++) {
            const double out = (k + 0.5) * width, in = k ? (k - 0.5) * width : 0;
            found[k] = g[k] * density * 4 * M_PI / 3 * (pow(out, 3) - pow(in, 3));
            all += found[k];
        }
        for (int shell = 0; shell < 10; shell++) {
            const int k = (int)(20 * sqrt(shell + 1) + 0.5);
            assert_within(found[k], wanted[shell], 1e-9);
            sum += found[k];
        }
        // shells 11 and 12 end the range: 24 at sqrt(11), 24 at sqrt(12)
        assert_within(all, sum + 24 + 24, 1e-9);
        packing_free(&packing);
    }
}

static struct packing poisson(int n, const double edge[3], bool flat, uint64_t *seed)
{
    struct packing packing = {.n_particle = n, .upper = {edge[0], edge[1], edge[2]}};
    packing.position = NEW_ARRAY(struct vector, n);
    packing.radius = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++) {
        packing.position[i] =
            (struct vector){edge[0] * next_random(seed),
                            flat ? edge[1] / 2 : edge[1] * next_random(seed),
                            edge[2] * next_random(seed)};
        packing.radius[i] = flat ? edge[1] / 2 : 1e-3;
    }
    return packing;
}

// g = 1 for points that know nothing of each other, with walls, without and half and
// half, to 4 standard errors of 40 samples each.
static void check_poisson(const uint8_t periodic[3], bool flat)
{
    enum { SAMPLES = 40, COUNT = 12, POINTS = 400 };
    const double edge[3] = {1, flat ? 1e-3 : 1.4, 1.8}, width = flat ? 0.05 : 0.08;
    double sum[COUNT] = {0}, squares[COUNT] = {0};
    uint64_t seed = 11;
    for (int s = 0; s < SAMPLES; s++) {
        struct packing packing = poisson(POINTS, edge, flat, &seed);
        memcpy(packing.periodic, periodic, 3);
        assert_int_equal(packing_is_flat(&packing), flat);
        const struct window window = {packing.lower, packing.upper};
        double g[COUNT];
        assert_true(radial_reach(&packing, &window) > COUNT * width);
        assert_true(radial_distribution(&packing, &window, width, COUNT, g));
        for (int k = 0; k < COUNT; k++) {
            sum[k] += g[k] / SAMPLES;
            squares[k] += g[k] * g[k] / SAMPLES;
        }
        packing_free(&packing);
    }
    for (int k = 1; k < COUNT; k++) {
        const double error = sqrt((squares[k] - sum[k] * sum[k]) / (SAMPLES - 1));
        assert_true(error < 0.02);
        assert_within(sum[k], 1, 4 * error);
    }
}

TEST(poisson_points_are_uncorrelated)
{
    check_poisson((const uint8_t[3]){1, 1, 1}, false);
    check_poisson((const uint8_t[3]){0, 0, 0}, false);
    check_poisson((const uint8_t[3]){0, 1, 0}, false);
    check_poisson((const uint8_t[3]){0, 0, 0}, true);
    check_poisson((const uint8_t[3]){1, 0, 1}, true);
}

TEST(nothing_is_said_of_nothing)
{
    struct packing packing = {.upper = {1, 1, 1}};
    packing.position = NEW_ARRAY(struct vector, 0);
    packing.radius = NEW_ARRAY(double, 0);
    struct contacts contacts = contacts_of(&packing);
    const struct window window = {packing.lower, packing.upper};
    double value[3], fabric[9];
    assert_false(fabric_tensor(&packing, &contacts, fabric));
    assert_false(radial_distribution(&packing, &window, 0.1, 3, value));
    slice_porosity(&packing, &contacts, &window, 3, value);
    for (int k = 0; k < 3; k++)
        assert_within(value[k], 1, 0);
    free_contacts(&contacts);
    packing_free(&packing);
}
