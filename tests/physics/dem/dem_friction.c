// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb slip [K 4.25, 4.26]: at mu F^n, no sooner; beside a bond too.
#include "../dem_scene.h"

static const double weight = 1e-7; // N on each grain

// A bonded plate of 3 x 3 grains on a floor, pressed down and pushed along x by PUSHING
// of the friction limit; how far it went and how fast it is.
struct slide {
    double displacement, velocity, time;
};

static struct slide slide_plate(double pushing, bool walls)
{
    struct packing packing = cubic_lattice(3, 3, 1, false);
    struct dem_setup setup = stiff_setup(&packing);
    const struct dem_wall floor = {.point = {0, 0, 0}, .normal = {0, 0, 2}};
    setup.bond.normal_stiffness = setup.bond.shear_stiffness = 1e17;
    setup.wall = &floor;
    setup.n_wall = walls;
    struct dem *dem = create(&setup);
    struct vector *force = NEW_ARRAY(struct vector, 9);
    for (int i = 0; i < 9; i++)
        force[i].z = -weight;
    dem_set_force(dem, force);
    settle(dem, 1e-9);
    const double start = displacement_of(dem, 4).x;
    for (int k = 1; k <= 100; k++) { // slowly, so as not to start it by a blow
        for (int i = 0; i < 9; i++)
            force[i].x = pushing * k / 100 * 0.5 * weight;
        dem_set_force(dem, force);
        run(dem, 100);
    }
    run(dem, 20000);
    const int64_t began = dem_cycle(dem);
    struct vector velocity[9];
    dem_velocities(dem, velocity);
    const double first = velocity[4].x;
    run(dem, 2000);
    dem_velocities(dem, velocity);
    const struct slide slide = {.displacement = displacement_of(dem, 4).x - start,
                                .velocity = velocity[4].x - first,
                                .time = (double)(dem_cycle(dem) - began) *
                                        dem_time_step(dem)};
    free(force);
    dem_free(dem);
    packing_free(&packing);
    return slide;
}

TEST(plate_sticks)
{
    const struct slide slide = slide_plate(0.9, true);
    assert_true(fabs(slide.velocity) < 1e-12);
    // The floor gives way by F/k_s, and the grains roll on it against their bonds.
    assert_true(slide.displacement > 0.9 * 0.5 * weight / 3e4);
    assert_true(slide.displacement < 1e-4 * RADIUS);
}

TEST(plate_slides)
{
    const double pushing = 1.5;
    const struct slide slide = slide_plate(pushing, true);
    const double mass = 3230 * 4.0 / 3 * M_PI * pow(RADIUS, 3);
    const double wanted = (pushing - 1) * 0.5 * weight / mass * slide.time;
    assert_close(slide.velocity, wanted, 1e-3);
}

// What the contact cannot carry, the bond does: (H - mu N) / (k^s A) of shear, and
// H r^2 / (k^n I) of bending. Soft contacts, as rolling is damped through shear only.
TEST(contact_slips_beside_a_bond)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    const uint8_t fixed[2] = {1, 0};
    setup.fixed = fixed;
    setup.material.normal_stiffness = setup.material.shear_stiffness = 20;
    setup.bond.shear_stiffness = 1e14;
    struct dem *dem = create(&setup);
    const double radius = 0.5858 * RADIUS, area = M_PI * radius * radius;
    const double bending_inertia = 0.25 * area * radius * radius;
    const double pressing = 1e-10, across = 0.3e-10;
    push(dem, 1, (struct vector){-pressing, 0, 0});
    settle(dem, 1e-10);
    // The contact carries its stiffness' share of what presses.
    const double normal = pressing * 10 / (10 + 8e14 * area);
    for (int k = 1; k <= 1000; k++) { // slowly: what swings back slips back
        push(dem, 1, (struct vector){-pressing, across * k / 1000, 0});
        run(dem, 1000);
    }
    settle(dem, 1e-10);
    const double wanted = (across - 0.5 * normal) / (1e14 * area) +
                          across * RADIUS * RADIUS / (8e14 * bending_inertia);
    assert_close(displacement_of(dem, 1).y, wanted, 1e-3);
    dem_free(dem);
    packing_free(&packing);
}

// A bonded plate on a held one, pressed and pushed over it: every contact between the
// two carries mu F^n across once they slide, and none ever more.
TEST(plates_slide_at_the_limit)
{
    struct packing packing = cubic_lattice(3, 3, 2, false);
    int n_bond = 0;
    for (int b = 0; b < packing.n_bond; b++)
        if ((packing.bond[b][0] < 9) == (packing.bond[b][1] < 9))
            memcpy(packing.bond[n_bond++], packing.bond[b], sizeof *packing.bond);
    packing.n_bond = n_bond;
    uint8_t fixed[18] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.normal_stiffness = setup.bond.shear_stiffness = 1e17;
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    struct vector force[18] = {{0, 0, 0}};
    for (int i = 9; i < 18; i++)
        force[i] = (struct vector){weight, 0.5 * weight, -weight};
    dem_set_force(dem, force);
    for (int k = 0; k < 50; k++) {
        run(dem, 20);
        int n_contact = 0, n_sliding = 0;
        for (int p = 0; p < dem->pairs.n_pair; p++) {
            const struct pair_geometry lie = pair_geometry(dem, p, 1);
            if (dem->pairs.bond[p] >= 0 || lie.overlap < 0) continue;
            const struct vector shear =
                lane_vector(dem->pairs.shear[p / 8].force, p % 8);
            const double limit = 0.5 * dem->law.normal_stiffness * lie.overlap;
            assert_true(norm(shear) <= limit * (1 + 1e-9));
            n_sliding += norm(shear) >= limit * (1 - 1e-9);
            n_contact++;
        }
        if (k > 25) assert_int_equal(n_contact, n_sliding);
    }
    dem_free(dem);
    packing_free(&packing);
}
