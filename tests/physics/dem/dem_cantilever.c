// SPDX-License-Identifier: GPL-3.0-or-later
// A row of parallel-bonded grains, the first held, against Timoshenko's beam.
//
// A bond is an elastic hinge without length at the contact: it bends by M/(k^n I),
// shears by F/(k^s A), stretches by F/(k^n A) and twists by T/(k^s J). Bonds are 2R
// apart, so the row is a beam with E A = k^n A 2R, E I = k^n I 2R, kappa G A = k^s A
// 2R, G J = k^s J 2R, of length 2R a bond from the centre of the grain held to that of
// the last. Sums over the hinges give what the row must do exactly, and differ from the
// beam by 1/(2n)^2.
#include "../dem_scene.h"

#include <gsl/gsl_linalg.h>

enum { BONDS = 20, GRAINS = BONDS + 1, LAST = BONDS };

static const double normal_stiffness = 8e14; // of bonds, N/m3
// So that bending is nearly all, and so that shear is more.
static const double shear_stiffnesses[2] = {3e14, 1e11};
static double shear_stiffness;
static const double density = 3230;

static double bond_radius(void)
{
    return 0.8 * RADIUS;
}

static double area(void)
{
    return M_PI * bond_radius() * bond_radius();
}

static double bending_inertia(void)
{
    return M_PI / 4 * pow(bond_radius(), 4);
}

static double grain_mass(void)
{
    return density * 4.0 / 3 * M_PI * pow(RADIUS, 3);
}

static double grain_inertia(void)
{
    return 0.4 * grain_mass() * RADIUS * RADIUS;
}

static double bending_stiffness(void)
{
    return normal_stiffness * bending_inertia() * 2 * RADIUS;
}

static double shearing_stiffness(void)
{
    return shear_stiffness * area() * 2 * RADIUS;
}

// Bonds alone: a contact that opens and closes is no part of a beam.
static struct dem *row(double local_damping, double safety)
{
    struct packing packing = cubic_lattice(GRAINS, 1, 1, false);
    uint8_t fixed[GRAINS] = {1};
    const struct dem_setup setup = {
        .packing = &packing,
        .material = {.density = density, .local_damping = local_damping},
        .bond = {.normal_stiffness = normal_stiffness,
                 .shear_stiffness = shear_stiffness,
                 .normal_strength = INFINITY,
                 .shear_strength = INFINITY,
                 .radius_fraction = 0.8},
        .fixed = fixed,
        .time_step_safety = safety,
        .threads = 1};
    struct dem *dem = create(&setup);
    packing_free(&packing);
    return dem;
}

// ---- statics -----------------------------------------------------------------------

struct end {
    struct vector moved;
    double turned; // about z
};

// The forces on the last grain, and on the last but one; spins are summed up, as grains
// keep no orientation.
static struct end bend(struct vector last, struct vector before)
{
    struct dem *dem = row(0.7, 0.25);
    struct vector force[GRAINS] = {{0}}, spin[GRAINS];
    force[LAST] = last;
    force[LAST - 1] = before;
    dem_set_force(dem, force);
    struct end end = {.turned = 0};
    for (int cycle = 0; cycle < 300000; cycle++) {
        run(dem, 1);
        dem_spins(dem, spin);
        end.turned += dem_time_step(dem) * spin[LAST].z;
    }
    end.moved = displacement_of(dem, LAST);
    dem_free(dem);
    return end;
}

static void check_end_load(void)
{
    const double force = 1e-16, n = BONDS, length = 2 * RADIUS * n;
    const struct end end = bend((struct vector){0, force, 0}, (struct vector){0});
    const double hinge = normal_stiffness * bending_inertia();
    const double bending = force * RADIUS * RADIUS * n * (4 * n * n - 1) / 3 / hinge;
    const double shearing = force * n / (shear_stiffness * area());
    assert_close(end.moved.y, bending + shearing, 1e-6);
    assert_close(end.turned, force * RADIUS * n * n / hinge, 1e-6);
    // Timoshenko
    assert_close(end.moved.y,
                 force * pow(length, 3) / (3 * bending_stiffness()) +
                     force * length / shearing_stiffness(),
                 1e-3);
    assert_close(end.turned, force * length * length / (2 * bending_stiffness()), 1e-6);
}

// By a couple of forces at the last two centres: M over all but the last two radii of
// the beam, where it falls to nothing.
static void check_end_moment(void)
{
    const double force = 1e-16, moment = 2 * RADIUS * force,
                 length = 2 * RADIUS * BONDS;
    const struct end end =
        bend((struct vector){0, force, 0}, (struct vector){0, -force, 0});
    const double arm = length - 2 * RADIUS; // of the force that is nearer
    const double by_last = force * length * length / 2,
                 by_other = force * arm * arm / 2;
    assert_close(end.turned, (by_last - by_other) / bending_stiffness(), 1e-6);
    // Both forces as on Timoshenko's beam; beyond the nearer one it carries on
    // straight.
    const double deflection =
        (force * pow(length, 3) / 3 - force * pow(arm, 3) / 3 - by_other * 2 * RADIUS) /
            bending_stiffness() +
        force * 2 * RADIUS / shearing_stiffness();
    assert_close(end.moved.y, deflection, 1e-3);
    // Pure bending by M over the whole of it, but for where the couple is.
    assert_close(end.turned, moment * length / bending_stiffness(), 0.03);
}

static void check_axial_load(void)
{
    const double force = 1e-9;
    const struct end end = bend((struct vector){force, 0, 0}, (struct vector){0});
    assert_close(end.moved.x, force * BONDS / (normal_stiffness * area()), 1e-8);
    assert_true(end.moved.y == 0 && end.moved.z == 0 && end.turned == 0);
}

// ---- vibration ---------------------------------------------------------------------

// Zero crossings of the row's COORDINATE, a period apart twice over; rad/s.
static double frequency(struct dem *dem, double (*coordinate)(const struct dem *),
                        int half_periods)
{
    double first = 0, now = 0;
    for (int crossings = 0; crossings <= half_periods;) {
        const double before = now;
        run(dem, 1);
        now = coordinate(dem);
        if (!(before * now < 0)) continue;
        const double at = (double)dem_cycle(dem) - now / (now - before);
        if (crossings++ == 0) first = at;
        if (crossings == half_periods + 1)
            return M_PI * half_periods / ((at - first) * dem_time_step(dem));
    }
    return 0;
}

static double tip_height(const struct dem *dem)
{
    return displacement_of(dem, LAST).y;
}

static double tip_twist(const struct dem *dem)
{
    struct vector spin[GRAINS];
    dem_spins(dem, spin);
    return spin[LAST].x;
}

// The hinges' stiffness and the grains' inertia, deflection and R times rotation of
// each grain but the first: the smallest omega and its shape.
static double discrete_frequency(double shape[2 * BONDS])
{
    enum { SIZE = 2 * BONDS };
    const double shear = shear_stiffness * area();
    const double bending = normal_stiffness * bending_inertia() / (RADIUS * RADIUS);
    const double inertia[2] = {grain_mass(), 0.4 * grain_mass()};
    gsl_matrix *k = gsl_matrix_calloc(SIZE, SIZE);
    for (int bond = 0; bond < BONDS; bond++) {
        // The slip w_j - w_i - R phi_i - R phi_j and the bend phi_j - phi_i.
        const double slip[4] = {-1, -1, 1, -1}, bend_by[4] = {0, -1, 0, 1};
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < 4; b++) {
                const int i = 2 * bond - 2 + a, j = 2 * bond - 2 + b;
                if (i < 0 || j < 0) continue; // the grain held
                *gsl_matrix_ptr(k, (size_t)i, (size_t)j) +=
                    (shear * slip[a] * slip[b] + bending * bend_by[a] * bend_by[b]) /
                    sqrt(inertia[i % 2] * inertia[j % 2]);
            }
    }
    // Inverse iteration, from a parabola.
    gsl_vector *x = gsl_vector_alloc(SIZE);
    for (size_t i = 0; i < SIZE; i++)
        gsl_vector_set(x, i, i % 2 ? 0 : (double)(i * i));
    gsl_linalg_cholesky_decomp1(k);
    double size = 1;
    for (int again = 0; again < 60; again++) {
        gsl_vector_scale(x, 1 / gsl_blas_dnrm2(x));
        gsl_linalg_cholesky_svx(k, x);
        size = gsl_blas_dnrm2(x);
    }
    for (int i = 0; i < SIZE; i++)
        shape[i] = gsl_vector_get(x, (size_t)i) / sqrt(inertia[i % 2]);
    gsl_matrix_free(k);
    gsl_vector_free(x);
    return 1 / sqrt(size);
}

// Deflection, rotation, moment and shear force along Timoshenko's beam at OMEGA, in
// units of E I and L; at the end M = J w^2 phi and F = -m w^2 w of the half grain
// beyond the last centre have to balance. Zero at a natural frequency.
static double end_imbalance(double omega)
{
    const double length = 2 * RADIUS * BONDS, ei = bending_stiffness();
    const double inertia = omega * omega * pow(length, 3) / ei; // of a unit of mass
    const double mass = inertia * grain_mass() / (2 * RADIUS) * length;
    const double turning = inertia * grain_inertia() / (2 * RADIUS) / length;
    const double soft = ei / (shearing_stiffness() * length * length);
    // w' = phi + soft F, phi' = M, M' = -F - turning phi, F' = -mass w
    const double rates[16] = {0, 1,        0, soft, 0,     0, 1, 0,
                              0, -turning, 0, -1,   -mass, 0, 0, 0};
    gsl_matrix *across = gsl_matrix_alloc(4, 4);
    const gsl_matrix_const_view generator = gsl_matrix_const_view_array(rates, 4, 4);
    gsl_linalg_exponential_ss(&generator.matrix, across, GSL_PREC_DOUBLE);
    double left[2][2]; // of end conditions, by what M and F start with
    for (size_t start = 0; start < 2; start++) {
        const double w = gsl_matrix_get(across, 0, 2 + start);
        const double phi = gsl_matrix_get(across, 1, 2 + start);
        const double half = 0.5 / BONDS; // of a grain, over the beam
        left[0][start] = gsl_matrix_get(across, 2, 2 + start) - half * turning * phi;
        left[1][start] = gsl_matrix_get(across, 3, 2 + start) - half * mass * w;
    }
    gsl_matrix_free(across);
    return left[0][0] * left[1][1] - left[0][1] * left[1][0];
}

static double timoshenko_frequency(void)
{
    const double length = 2 * RADIUS * BONDS;
    const double slender =
        sqrt(bending_stiffness() / (grain_mass() / (2 * RADIUS))) / (length * length);
    const double sign = end_imbalance(0.01 * slender);
    double high = 0.1 * slender; // from below, to the first of them
    while (end_imbalance(high) * sign > 0)
        high *= 1.1;
    double low = high / 1.1;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        if (end_imbalance(middle) * sign > 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void check_bending_frequency(void)
{
    double shape[2 * BONDS];
    const double discrete = discrete_frequency(shape);
    struct dem *dem = row(0, 0.1);
    struct vector velocity[GRAINS] = {{0}}, spin[GRAINS] = {{0}};
    const double speed = 1e-5 * RADIUS * discrete / shape[2 * BONDS - 2];
    for (int i = 1; i < GRAINS; i++) {
        velocity[i].y = speed * shape[2 * i - 2];
        spin[i].z = speed * shape[2 * i - 1] / RADIUS;
    }
    dem_set_velocity(dem, velocity, spin);
    const double measured = frequency(dem, tip_height, 6);
    dem_free(dem);
    assert_close(measured, discrete, 1e-5);
    assert_close(measured, timoshenko_frequency(), 2e-3);
}

// A chain of n discs on springs between, held at one end: 2 w0 sin(pi/(4 n + 2)).
static void check_twisting_frequency(void)
{
    struct dem *dem = row(0, 0.1);
    struct vector spin[GRAINS] = {{0}};
    for (int i = 1; i < GRAINS; i++)
        spin[i].x = 1e3 * sin(M_PI * i / (2 * BONDS + 1));
    dem_set_velocity(dem, NULL, spin);
    const double measured = frequency(dem, tip_twist, 6);
    dem_free(dem);
    const double polar = 2 * bending_inertia();
    const double hinge = sqrt(shear_stiffness * polar / grain_inertia());
    assert_close(measured, 2 * hinge * sin(M_PI / (4 * BONDS + 2)), 1e-5);
    // A rod of length L with half a grain at its end is near pi/2 sqrt(GJ/(rho J))/L.
    const double rod = M_PI / 2 * hinge / (BONDS + 0.5);
    assert_close(measured, rod, 1e-3);
}

TEST(end_load)
{
    for (int k = 0; k < 2; k++) {
        shear_stiffness = shear_stiffnesses[k];
        check_end_load();
    }
}

TEST(end_moment)
{
    for (int k = 0; k < 2; k++) {
        shear_stiffness = shear_stiffnesses[k];
        check_end_moment();
    }
}

TEST(axial_load)
{
    for (int k = 0; k < 2; k++) {
        shear_stiffness = shear_stiffnesses[k];
        check_axial_load();
    }
}

TEST(bending_frequency)
{
    for (int k = 0; k < 2; k++) {
        shear_stiffness = shear_stiffnesses[k];
        check_bending_frequency();
    }
}

TEST(twisting_frequency)
{
    for (int k = 0; k < 2; k++) {
        shear_stiffness = shear_stiffnesses[k];
        check_twisting_frequency();
    }
}
