// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid in pores between grains that move, against closed forms: throats of three
// grains that touch (Descartes' theorem), the room between four, forces that sum to the
// pull on the whole surface, their virial, and the void of a lattice.
#include "network/pore_liquid.h"
#include "../../test.h"

#include "../../random.h"
#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

static const double R = 0.26e-6, SUCTION = 2e6;

static struct pore_liquid init(const struct packing *packing)
{
    struct pore_liquid liquid;
    struct reason reason;
    assert_int_equal(pore_liquid_init(&liquid, packing, &reason), STATUS_OK);
    return liquid;
}

// ---- four grains that touch ---------------------------------------------------------

struct four {
    struct packing packing;
    struct vector at[4];
    double radius[4];
};

static void place_four(struct four *four)
{
    const double up = sqrt(2.0 / 3), middle = sqrt(3) / 6;
    const struct vector corner[4] = {
        {0, 0, 0}, {1, 0, 0}, {0.5, 3 * middle, 0}, {0.5, middle, up}};
    for (int i = 0; i < 4; i++) {
        four->at[i] =
            add((struct vector){3 * R, 3 * R, 3 * R}, scale(2 * R, corner[i]));
        four->radius[i] = R;
    }
    four->packing = (struct packing){.n_particle = 4,
                                     .upper = {8 * R, 8 * R, 8 * R},
                                     .position = four->at,
                                     .radius = four->radius};
}

TEST(throat_of_touching_grains)
{
    struct four four;
    place_four(&four);
    struct pore_liquid liquid = init(&four.packing);
    assert_int_equal(liquid.n, 1);
    for (int k = 0; k < 4; k++)
        assert_close(throat_radius_at(&liquid, 0, k, four.at, four.radius),
                     R * (2 / sqrt(3) - 1), 1e-12);
    // Radii of 1, 2 and 3 around a right angle: Descartes' circle is 6/23.
    const double r[3] = {R, 2 * R, 3 * R};
    const struct vector at[3] = {{0, 0, 0}, {3 * R, 0, 0}, {0, 4 * R, 0}};
    for (int m = 0; m < 3; m++) { // facet 3 has corners 0, 1, 2
        const int grain = liquid.pore[0].corner[m];
        four.at[grain] = at[m];
        four.radius[grain] = r[m];
    }
    assert_close(throat_radius_at(&liquid, 0, 3, four.at, four.radius), R * 6 / 23,
                 1e-12);
    pore_liquid_free(&liquid);
}

TEST(room_between_touching_grains)
{
    struct four four;
    place_four(&four);
    struct pore_liquid liquid = init(&four.packing);
    const double whole = pow(2 * R, 3) / (6 * sqrt(2));
    const double grains = 4 * R * R * R / 3 * acos(23.0 / 27);
    double tetrahedra;
    assert_close(liquid_volume(&liquid, four.at, four.radius, &tetrahedra),
                 whole - grains, 1e-12);
    assert_close(tetrahedra, whole, 1e-12);
    pore_liquid_free(&liquid);
}

// Drops the suction just below and lifts it just above 2 gamma / rho of its throats.
TEST(gas_enters_at_its_radius)
{
    struct four four;
    place_four(&four);
    struct pore_liquid liquid = init(&four.packing);
    const double rho = R * (2 / sqrt(3) - 1);
    uint8_t which[1] = {0};
    assert_int_equal(mark_entered(&liquid, four.at, four.radius, 1.0001 * rho, which),
                     0);
    liquid.pore[0].beyond[0] = BEYOND_OPEN;
    find_menisci(&liquid);
    assert_int_equal(mark_entered(&liquid, four.at, four.radius, 1.0001 * rho, which),
                     0);
    assert_int_equal(mark_entered(&liquid, four.at, four.radius, 0.9999 * rho, which),
                     1);
    let_gas_in(&liquid, which);
    assert_int_equal(liquid.n_meniscus, 0);
    assert_within(liquid_volume(&liquid, four.at, four.radius, NULL), 0, 0);
    pore_liquid_free(&liquid);
}

// With gas on all sides a pore of volume V pulls its grains together: no net force, and
// the virial of a pressure -P, - 3 P V.
TEST(pore_in_gas)
{
    struct four four;
    place_four(&four);
    struct pore_liquid liquid = init(&four.packing);
    for (int k = 0; k < 4; k++)
        liquid.pore[0].beyond[k] = BEYOND_OPEN;
    find_menisci(&liquid);
    four.at[3].x += 0.3 * R;
    struct vector force[4] = {{0}}, net = {0};
    add_meniscus_forces(&liquid, four.at, SUCTION, force);
    double virial = 0;
    for (int i = 0; i < 4; i++) {
        net = add(net, force[i]);
        virial += dot(force[i], four.at[i]);
    }
    const double volume = pow(2 * R, 3) / (6 * sqrt(2)); // moved along a facet
    assert_within(norm(net), 0, 1e-14 * SUCTION * R * R);
    assert_close(virial, -3 * SUCTION * volume, 1e-12);
    pore_liquid_free(&liquid);
}

TEST(pore_inside_out)
{
    struct four four;
    place_four(&four);
    struct pore_liquid liquid = init(&four.packing);
    const double height = four.at[3].z - four.at[0].z;
    const double share[5] = {1, -0.19, -0.21, 7.9, 8.1};
    for (int k = 0; k < 5; k++) {
        uint8_t which[1] = {0};
        four.at[3].z = four.at[0].z + share[k] * height;
        assert_int_equal(mark_distorted(&liquid, four.at, which), k == 2 || k == 4);
    }
    pore_liquid_free(&liquid);
}

// ---- layers -------------------------------------------------------------------------

enum { SIDE = 6, HIGH = 5, N = SIDE * SIDE * HIGH };

// A cubic lattice, periodic sideways, its centres moved by up to NOISE radii, and whole
// boxes away as a replay may leave them.
static struct packing layer(double noise)
{
    uint64_t state = 3;
    struct packing packing = {.n_particle = N,
                              .upper = {2 * R * SIDE, 2 * R * SIDE, 2 * R * HIGH + R},
                              .periodic = {true, true, false}};
    packing.position = NEW_ARRAY(struct vector, N);
    packing.radius = NEW_ARRAY(double, N);
    for (int i = 0; i < N; i++) {
        const int place[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (int axis = 0; axis < 3; axis++)
            set_component(
                &packing.position[i], axis,
                R * (1 + 2 * place[axis] + noise * (next_random(&state) - 0.5)));
        packing.position[i].x += 2 * R * SIDE * (i % 3 - 1);
        packing.radius[i] = R;
    }
    return packing;
}

TEST(void_of_a_lattice)
{
    struct packing packing = layer(0);
    struct pore_liquid liquid = init(&packing);
    const double share = 1 - M_PI / 6, whole = 8 * R * R * R * SIDE * SIDE * (HIGH - 1);
    double tetrahedra;
    assert_close(liquid_volume(&liquid, packing.position, packing.radius, &tetrahedra),
                 share * whole, 1e-12);
    assert_close(tetrahedra, whole, 1e-12);
    pore_liquid_free(&liquid);
    packing_free(&packing);
}

// Down on the surface as a whole, whatever its shape; sideways nothing; and gas inside
// adds nothing. Also when grains have moved.
TEST(net_pull_of_a_surface)
{
    uint64_t seed = 5;
    struct packing packing = layer(0.5);
    struct pore_liquid liquid = init(&packing);
    for (int round = 0; round < 3; round++) {
        struct vector *force = NEW_ARRAY(struct vector, N), net = {0};
        add_meniscus_forces(&liquid, packing.position, SUCTION, force);
        for (int i = 0; i < N; i++)
            net = add(net, force[i]);
        const double all = SUCTION * pow(2 * R * SIDE, 2);
        assert_close(net.z, -all, 1e-12);
        assert_within(hypot(net.x, net.y), 0, 1e-12 * all);
        free(force);
        // Every tenth pore that does not reach the floor; then grains move.
        for (int p = 0; p < liquid.n; p += 10) {
            bool closed = false;
            for (int k = 0; k < 4; k++)
                closed |= liquid.pore[p].beyond[k] == BEYOND_CLOSED;
            liquid.pore[p].has_gas = !closed;
        }
        find_menisci(&liquid);
        for (int i = 0; i < N; i++)
            packing.position[i].y += 0.2 * R * next_random(&seed);
    }
    assert_true(liquid.n_meniscus > 4 * liquid.n / 20);
    pore_liquid_free(&liquid);
    packing_free(&packing);
}

// The widest throats first, until they have held what is wanted.
TEST(widest_first)
{
    struct packing packing = layer(0.5);
    struct pore_liquid liquid = init(&packing);
    uint8_t *which = NEW_ARRAY(uint8_t, liquid.n);
    const double wanted = 20 * R * R * R;
    const double narrowest =
        mark_widest(&liquid, packing.position, packing.radius, wanted, which);
    double held = 0;
    for (int p = 0; p < liquid.n; p++)
        if (which[p]) held += pore_room(&liquid, p, packing.position, packing.radius);
    assert_true(held >= wanted && held < wanted + 5 * R * R * R);
    assert_int_equal(
        mark_entered(&liquid, packing.position, packing.radius, narrowest, which), 0);
    pore_liquid_free(&liquid);
    packing_free(&packing);
    free(which);
}

TEST(too_few_grains)
{
    struct four four;
    place_four(&four);
    four.packing.n_particle = 3;
    struct pore_liquid liquid;
    struct reason reason;
    assert_int_equal(pore_liquid_init(&liquid, &four.packing, &reason),
                     STATUS_BAD_DATA);
    pore_liquid_free(&liquid);
}
