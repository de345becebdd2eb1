// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes for the tests of the discrete elements: lattices of bonded grains with the
// numbers of [K Table 5.1], built in memory.
#pragma once

#include "../random.h"
#include "../test.h"
#include "basics/memory.h"
#include "dem/engine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RADIUS 250e-9

// A packing with room for N_BOND bonds, to be filled by the caller.
static inline struct packing new_packing(int n_particle, int n_bond)
{
    struct packing packing = {.n_particle = n_particle, .n_bond = n_bond};
    packing.position = NEW_ARRAY(struct vector, n_particle);
    packing.radius = NEW_ARRAY(double, n_particle);
    packing.bond = allocate((size_t)n_bond, sizeof *packing.bond);
    for (int i = 0; i < n_particle; i++)
        packing.radius[i] = RADIUS;
    return packing;
}

// Touching grains on a cubic lattice, bonded along the axes, numbered with x fastest;
// across the sides too where the box repeats.
static inline struct packing cubic_lattice(int nx, int ny, int nz, bool periodic_sides)
{
    const int n = nx * ny * nz, count[3] = {nx, ny, nz};
    struct packing packing = new_packing(n, 3 * n);
    int n_bond = 0;
    for (int i = 0; i < n; i++) {
        const int at[3] = {i % nx, i / nx % ny, i / (nx * ny)};
        packing.position[i] =
            (struct vector){(2 * at[0] + 1) * RADIUS, (2 * at[1] + 1) * RADIUS,
                            (2 * at[2] + 1) * RADIUS};
        const int stride[3] = {1, nx, nx * ny};
        for (int axis = 0; axis < 3; axis++) {
            const bool wraps = at[axis] == count[axis] - 1;
            if (wraps && !(periodic_sides && axis < 2)) continue;
            const int j =
                wraps ? i - (count[axis] - 1) * stride[axis] : i + stride[axis];
            packing.bond[n_bond][0] = i < j ? i : j;
            packing.bond[n_bond++][1] = i < j ? j : i;
        }
    }
    packing.n_bond = n_bond;
    packing.upper = (struct vector){2 * nx * RADIUS, 2 * ny * RADIUS, 2 * nz * RADIUS};
    packing.periodic[0] = packing.periodic[1] = periodic_sides;
    return packing;
}

// Two grains that touch along x, bonded.
static inline struct packing bonded_pair(void)
{
    return cubic_lattice(2, 1, 1, false);
}

// [K Table 5.1] with bonds that do not break and a time step well inside the limit.
static inline struct dem_setup stiff_setup(const struct packing *packing)
{
    return (struct dem_setup){.packing = packing,
                              .material = {.density = 3230,
                                           .normal_stiffness = 3e4,
                                           .shear_stiffness = 3e4,
                                           .friction = 0.5,
                                           .damping_ratio = 0.7},
                              .bond = {.normal_stiffness = 8e14,
                                       .shear_stiffness = 8e14,
                                       .normal_strength = INFINITY,
                                       .shear_strength = INFINITY,
                                       .radius_fraction = 0.5858},
                              .time_step_safety = 0.02,
                              .threads = 1};
}

static inline struct dem *create(const struct dem_setup *setup)
{
    struct dem *dem;
    struct reason reason = {""};
    const enum status status = dem_create(&dem, setup, &reason);
    if (status != STATUS_OK) fail_msg("dem_create: %s", reason.text);
    return dem;
}

static inline void run(struct dem *dem, int64_t cycles)
{
    struct reason reason = {""};
    if (dem_run(dem, cycles, &reason) != STATUS_OK) fail_msg("%s", reason.text);
}

static inline void settle(struct dem *dem, double tolerance)
{
    struct reason reason = {""};
    if (dem_run_until(dem, tolerance, 20000000, &reason) != STATUS_OK)
        fail_msg("%s", reason.text);
}

// Every byte of the state by which one could go on as the other.
static inline void assert_same_state(const struct dem *a, const struct dem *b)
{
    int n, m;
    struct named_array *p = dem_save(a, &n), *q = dem_save(b, &m);
    assert_int_equal(n, m);
    for (int k = 0; k < n; k++) {
        const size_t size = (size_t)p[k].count * number_size(p[k].type);
        assert_string_equal(p[k].name, q[k].name);
        assert_int_equal(p[k].count, q[k].count);
        if (size > 0 && memcmp(p[k].data, q[k].data, size))
            fail_msg("cycle %d: %s differs", (int)dem_cycle(a), p[k].name);
    }
    free_arrays(p, n);
    free_arrays(q, m);
}

static inline struct vector displacement_of(const struct dem *dem, int particle)
{
    struct vector *all = NEW_ARRAY(struct vector, dem->n_particle);
    dem_displacements(dem, all);
    const struct vector one = all[particle];
    free(all);
    return one;
}

// A force on one grain only.
static inline void push(struct dem *dem, int particle, struct vector force)
{
    struct vector *all = NEW_ARRAY(struct vector, dem->n_particle);
    all[particle] = force;
    dem_set_force(dem, all);
    free(all);
}

// Evenly distributed in [-1,1); advances STATE.
static inline double next_signed(uint64_t *state)
{
    return 2 * next_random(state) - 1;
}

static inline struct vector *random_vectors(int count, double size, uint64_t seed)
{
    struct vector *all = NEW_ARRAY(struct vector, count);
    for (int i = 0; i < count; i++) {
        all[i].x = size * next_signed(&seed);
        all[i].y = size * next_signed(&seed);
        all[i].z = size * next_signed(&seed);
    }
    return all;
}

// With random velocities, of SPEED at the surface too.
static inline struct dem *shaken(const struct dem_setup *setup, double speed,
                                 uint64_t seed)
{
    struct dem *dem = create(setup);
    const int n = setup->packing->n_particle;
    struct vector *velocity = random_vectors(n, speed, seed);
    struct vector *spin = random_vectors(n, speed / RADIUS, seed + 1);
    dem_set_velocity(dem, velocity, spin);
    free(velocity);
    free(spin);
    return dem;
}

// Bonds of 1 kPa that break while grains fly and turn at SPEED: what both momenta
// change is rounding.
static inline void keeps_momentum(struct dem_setup setup, const double speed)
{
    setup.bond.normal_strength = setup.bond.shear_strength = 1e3;
    struct dem *dem = shaken(&setup, speed, 1);
    const struct dem_momentum before = dem_momentum(dem);
    run(dem, 5000);
    int n_crack;
    dem_cracks(dem, &n_crack);
    assert_in_range(n_crack, 1, setup.packing->n_bond);
    const struct dem_momentum after = dem_momentum(dem);
    const double mass =
        setup.packing->n_particle * 3230 * 4.0 / 3 * M_PI * pow(RADIUS, 3);
    assert_true(distance(before.linear, after.linear) < 1e-13 * mass * speed);
    assert_true(distance(before.angular, after.angular) <
                1e-12 * mass * speed * RADIUS * 4);
    dem_free(dem);
}

// Dynamics that cannot be made, for a reason that says WHY.
static inline void assert_refused(struct dem_setup setup, const char *why)
{
    struct dem *dem;
    struct reason reason = {""};
    assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_BAD_DATA);
    assert_null(dem);
    if (!strstr(reason.text, why)) fail_msg("%s", reason.text);
}
