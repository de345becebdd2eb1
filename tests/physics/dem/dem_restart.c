// SPDX-License-Identifier: GPL-3.0-or-later
// An engine made anew from the saved state of another goes on to the same bytes, and
// what is not such a state is refused.
#include "../dem_scene.h"
#include "geometry/neighbours.h"

#include <stdbool.h>

// ---- what is compared ---------------------------------------------------------------

static void assert_same(const char *what, const void *a, const void *b, size_t size)
{
    if (size > 0 && memcmp(a, b, size)) fail_msg("%s differs", what);
}

static void assert_same_vectors(const char *what, const struct dem *a,
                                const struct dem *b,
                                void (*ask)(const struct dem *, struct vector *))
{
    const size_t n = (size_t)a->n_particle;
    struct vector *of_a = NEW_ARRAY(struct vector, n);
    struct vector *of_b = NEW_ARRAY(struct vector, n);
    ask(a, of_a);
    ask(b, of_b);
    assert_same(what, of_a, of_b, n * sizeof *of_a);
    free(of_a);
    free(of_b);
}

static void assert_same_contacts(const struct dem *a, const struct dem *b)
{
    int n, m;
    struct dem_contact *p = dem_contacts(a, &n), *q = dem_contacts(b, &m);
    assert_int_equal(n, m);
    for (int k = 0; k < n; k++) {
        assert_same("contact", p[k].particle, q[k].particle, sizeof p->particle);
        assert_int_equal(p[k].bond, q[k].bond);
        assert_same("overlap", &p[k].overlap, &q[k].overlap, sizeof p->overlap);
        assert_same("force", &p[k].force, &q[k].force, sizeof p->force);
        assert_same("position", &p[k].position, &q[k].position, sizeof p->position);
    }
    free(p);
    free(q);
}

static void assert_same_cracks(const struct dem *a, const struct dem *b)
{
    int n, m;
    const struct dem_crack *p = dem_cracks(a, &n), *q = dem_cracks(b, &m);
    assert_int_equal(n, m);
    for (int k = 0; k < n; k++) {
        assert_int_equal(p[k].bond, q[k].bond);
        assert_int_equal(p[k].mode, q[k].mode);
        assert_int_equal(p[k].cycle, q[k].cycle);
        assert_same("crack", &p[k].time, &q[k].time, sizeof p->time);
        assert_same("crack", &p[k].position, &q[k].position, sizeof p->position);
    }
}

static void assert_same_sums(const struct dem *a, const struct dem *b)
{
    const struct dem_energy ea = dem_energy(a), eb = dem_energy(b);
    assert_same("energy", &ea, &eb, sizeof ea);
    const struct dem_momentum ma = dem_momentum(a), mb = dem_momentum(b);
    assert_same("momentum", &ma, &mb, sizeof ma);
    const struct dem_census ca = dem_census(a), cb = dem_census(b);
    assert_int_equal(ca.contacts, cb.contacts);
    assert_same("stress", ca.stress, cb.stress, sizeof ca.stress);
    const double la = dem_time_step_limit_now(a), lb = dem_time_step_limit_now(b);
    assert_same("time step limit", &la, &lb, sizeof la);
    const double ua = dem_unbalanced_ratio(a), ub = dem_unbalanced_ratio(b);
    assert_same("unbalanced ratio", &ua, &ub, sizeof ua);
    for (int w = 0; w < a->n_wall; w++) {
        const struct dem_wall_state wa = dem_wall_state(a, w),
                                    wb = dem_wall_state(b, w);
        assert_same("wall", &wa, &wb, sizeof wa);
    }
    for (int g = 0; g < a->n_driven; g++) {
        const struct dem_group_state ga = dem_group_state(a, g),
                                     gb = dem_group_state(b, g);
        assert_same("group", &ga, &gb, sizeof ga);
    }
}

static void assert_same_everything(const struct dem *a, const struct dem *b)
{
    assert_int_equal(dem_cycle(a), dem_cycle(b));
    assert_same_vectors("position", a, b, dem_positions);
    assert_same_vectors("displacement", a, b, dem_displacements);
    assert_same_vectors("velocity", a, b, dem_velocities);
    assert_same_vectors("spin", a, b, dem_spins);
    assert_same_contacts(a, b);
    assert_same_cracks(a, b);
    assert_same_sums(a, b);
    assert_same_state(a, b);
}

// ---- run, stop, go on ---------------------------------------------------------------

// What a scene does between its two halves and on the way; HALF is 0 or 1.
typedef void task(struct dem *dem, int half);

static struct dem *restored(const struct dem *from, struct dem_setup setup, int threads)
{
    setup.threads = threads;
    struct dem *dem = create(&setup);
    struct reason reason = {""};
    int count;
    struct named_array *array = dem_save(from, &count);
    if (dem_restore(dem, array, count, &reason) != STATUS_OK)
        fail_msg("dem_restore: %s", reason.text);
    free_arrays(array, count);
    return dem;
}

// The whole against the two halves, the second by 1, 2 and 3 threads.
static void check(const struct dem_setup *setup, task *work)
{
    struct dem *whole = create(setup), *first = create(setup);
    work(whole, 0);
    work(whole, 1);
    work(first, 0);
    for (int threads = 1; threads <= 3; threads++) {
        struct dem *second = restored(first, *setup, threads);
        assert_same_everything(first, second);
        work(second, 1);
        assert_same_everything(whole, second);
        dem_free(second);
    }
    dem_free(first);
    dem_free(whole);
}

// ---- scenes -------------------------------------------------------------------------

static void pull(struct dem *dem, int half)
{
    const int n = dem->n_particle;
    struct vector *force = random_vectors(n, half ? 2e-8 : 1e-8, 11);
    dem_set_force(dem, force);
    free(force);
    run(dem, half ? 150 : 120);
    int n_crack;
    dem_cracks(dem, &n_crack);
    assert_in_range(n_crack, 1, dem->n_bond - 1); // or the scene tests nothing
}

TEST(bonded_lattice)
{
    struct packing packing = cubic_lattice(6, 6, 8, false);
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.normal_strength = setup.bond.shear_strength = 3e3;
    setup.balance_energy = true;
    uint8_t *fixed = NEW_ARRAY(uint8_t, packing.n_particle);
    for (int i = 0; i < 36; i++)
        fixed[i] = 1;
    setup.fixed = fixed;
    check(&setup, pull);
    free(fixed);
    packing_free(&packing);
}

TEST(contact_bonds)
{
    struct packing packing = cubic_lattice(6, 6, 8, true);
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.kind = DEM_CONTACT_BOND;
    setup.bond.normal_strength = setup.bond.shear_strength = 4e-9;
    setup.balance_energy = true;
    check(&setup, pull);
    packing_free(&packing);
}

// Grains of several sizes on a loose lattice, moving at random.
static struct packing cloud(int edge, double spread, bool periodic)
{
    const int n = edge * edge * edge;
    struct packing packing = new_packing(n, 0);
    struct vector *shift = random_vectors(n, 0.2 * RADIUS, 3);
    uint64_t seed = 5;
    for (int i = 0; i < n; i++) {
        const int at[3] = {i % edge, i / edge % edge, i / (edge * edge)};
        packing.position[i] =
            add(shift[i], (struct vector){(2.4 * at[0] + 1.3) * RADIUS,
                                          (2.4 * at[1] + 1.3) * RADIUS,
                                          (2.4 * at[2] + 1.3) * RADIUS});
        packing.radius[i] = RADIUS * (1 - spread * fabs(next_signed(&seed)));
    }
    const double side = 2.4 * edge * RADIUS;
    packing.upper = (struct vector){side, side, side};
    for (int axis = 0; axis < 3; axis++)
        packing.periodic[axis] = periodic;
    free(shift);
    return packing;
}

static void throw(struct dem * dem, double radii_a_step)
{
    const double speed = radii_a_step * RADIUS / dem_time_step(dem);
    struct vector *velocity = random_vectors(dem->n_particle, speed, 7);
    struct vector *spin = random_vectors(dem->n_particle, speed / RADIUS, 9);
    dem_set_velocity(dem, velocity, spin);
    free(velocity);
    free(spin);
}

// A lid under servo control, a floor that moves aside, a belt about them.
static void shake(struct dem *dem, int half)
{
    if (half == 0) {
        throw(dem, 0.02);
        run(dem, 400);
        dem_set_gravity(dem, (struct vector){1e11, 0, -1e12});
        dem_set_wall_motion(dem, 1, (struct vector){100, 0, 0}, (struct vector){0});
        dem_set_servo(dem, 0, 2e-5);
        dem_set_friction(dem, 0.3);
        dem_set_local_damping(dem, 0.2);
    }
    run(dem, 400);
    assert_true(dem->search_cycle > 0); // pairs were sought again
}

TEST(walled_cloud)
{
    struct packing packing = cloud(8, 0.4, false);
    const struct vector up = packing.upper, middle = scale(0.5, up);
    const struct dem_wall wall[] = {
        {.point = up,
         .normal = {0, 0, -1},
         .servo_force = 1e-5,
         .servo_largest_speed = 50},
        {.point = packing.lower, .normal = {0, 0, 1}, .velocity = {50, 0, 0}},
        {.point = middle,
         .normal = {0, 0, 1},
         .shape = DEM_CYLINDER,
         .radius = 0.75 * up.x,
         .spin = {0, 0, 1e7},
         .has_friction = true,
         .friction = 0.2}};
    struct dem_setup setup = stiff_setup(&packing);
    setup.n_wall = 3;
    setup.wall = wall;
    setup.balance_energy = true;
    check(&setup, shake);
    packing_free(&packing);
}

static void fly(struct dem *dem, int half)
{
    if (half == 0) throw(dem, 0.02);
    run(dem, half ? 500 : 300);
}

TEST(hertz_cloud)
{
    struct packing packing = cloud(8, 0.4, true);
    struct dem_setup setup = stiff_setup(&packing);
    setup.law = DEM_HERTZ;
    setup.material.young_modulus = 1e9;
    setup.material.poisson_ratio = 0.25;
    setup.material.restitution = 0.8;
    setup.largest_overlap = 0.1;
    setup.balance_energy = true;
    check(&setup, fly);
    packing_free(&packing);
}

// Grains of three sizes that resist rolling, in a belt.
TEST(rolling_cloud)
{
    struct packing packing = cloud(8, 0.4, false);
    const struct vector up = packing.upper, middle = scale(0.5, up);
    const struct dem_wall belt = {.point = middle,
                                  .shape = DEM_SPHERE,
                                  .radius = 0.87 * up.x,
                                  .spin = {0, 1e7, 1e7}};
    for (int law = DEM_LINEAR; law <= DEM_HERTZ; law++) {
        struct dem_setup setup = stiff_setup(&packing);
        setup.law = (enum dem_law)law;
        setup.material.contact_time = 1e-7;
        setup.material.young_modulus = 1e9;
        setup.material.poisson_ratio = 0.25;
        setup.material.restitution = 0.8;
        setup.material.rolling_friction = 0.3;
        setup.material.rolling_damping = 0.2;
        setup.largest_overlap = 0.1;
        setup.balance_energy = true;
        setup.n_wall = 1;
        setup.wall = &belt;
        check(&setup, fly);
    }
    packing_free(&packing);
}

// Dry grains that adhere to each other and to a belt.
TEST(adhesive_cloud)
{
    struct packing packing = cloud(8, 0.4, false);
    const struct vector up = packing.upper;
    const struct dem_wall belt = {.point = scale(0.5, up),
                                  .shape = DEM_SPHERE,
                                  .radius = 0.87 * up.x,
                                  .spin = {0, 1e7, 1e7}};
    struct dem_setup setup = stiff_setup(&packing);
    setup.law = DEM_HERTZ;
    setup.material.young_modulus = 1e9;
    setup.material.poisson_ratio = 0.25;
    setup.material.restitution = 0.8;
    setup.largest_overlap = 0.1;
    setup.adhesion = 0.1;
    setup.balance_energy = true;
    setup.n_wall = 1;
    setup.wall = &belt;
    check(&setup, fly);
    packing_free(&packing);
}

TEST(two_timed_materials)
{
    struct packing packing = cloud(8, 0.3, true);
    struct dem_setup setup = stiff_setup(&packing);
    setup.law = DEM_TIMED;
    setup.material.contact_time = 1e-7;
    setup.material.restitution = 0.7;
    struct dem_material other = setup.material;
    other.density = 1000;
    other.friction = 0.1;
    setup.other = &other;
    setup.n_other = 1;
    uint8_t *material = NEW_ARRAY(uint8_t, packing.n_particle);
    for (int i = 0; i < packing.n_particle; i++)
        material[i] = i % 3 == 0;
    setup.material_of = material;
    check(&setup, fly);
    free(material);
    packing_free(&packing);
}

// More than are left in the order they came in, enough for several threads; numbered
// anew on the way.
static void crowd(struct dem *dem, int half)
{
    if (half == 0) throw(dem, 0.03);
    run(dem, 120);
    assert_true(half == 0 || dem->searches_in_order < 64); // it was renumbered
    if (half == 0) dem->searches_in_order = 64;            // as after many searches
}

TEST(renumbered_crowd)
{
    struct packing packing = cloud(18, 0.3, true);
    assert_true(packing.n_particle > 5000);
    struct dem_setup setup = stiff_setup(&packing);
    setup.density_scaling = true;
    check(&setup, crowd);
    packing_free(&packing);
}

// As pack does it: grains that grow in a box that closes in, without friction.
static void squeeze(struct dem *dem, int half)
{
    const double stretch[3] = {0.998, 1, 0.997};
    for (int k = 0; k < 15 + half; k++) {
        dem_rescale(dem, stretch, 1.001);
        run(dem, 20);
    }
}

TEST(squeezed_crowd)
{
    for (int spread = 0; spread < 2; spread++) {
        struct packing packing = cloud(18, 0.3 * spread, true);
        struct dem_setup setup = stiff_setup(&packing);
        setup.material.friction = 0;
        setup.density_scaling = true;
        check(&setup, squeeze);
        packing_free(&packing);
    }
}

// All that an engine can have at once: driven groups, of which one turns back, bonds,
// liquid, walls, a ledger, applied forces and a step that was shortened.
static void stir(struct dem *dem, int half)
{
    const double step = dem_time_step(dem);
    const struct vector on = {0.005 * RADIUS / step, 0, 0};
    if (half == 0) {
        throw(dem, 0.01);
        push(dem, 7, (struct vector){1e-9, 0, 0});
    }
    dem_set_group_motion(dem, 0, on, 0.001 / step);
    dem_set_group_motion(dem, 1, scale(half ? -1 : 1, on), half ? 0 : -0.001 / step);
    run(dem, 60);
    if (half == 0) { // as when grains gather neighbours
        dem->step_was_shortened = true;
        dem->time_step_limit = 0.98 * dem->time_step / AUTOMATIC_SHARE;
        dem->time_step *= 0.98;
    }
    int n_crack;
    dem_cracks(dem, &n_crack);
    assert_true(n_crack > 0 && dem->search_cycle > 0);
    for (int g = 0; g < 2; g++)
        assert_true(norm(dem_group_state(dem, g).moment) > 0);
}

TEST(stirred_crowd)
{
    struct packing packing = cloud(17, 0.3, true);
    free(packing.bond);
    packing.bond = neighbour_pairs(&packing, 0.12, &packing.n_bond);
    const struct vector middle = scale(0.5, packing.upper);
    const struct dem_wall wall = {
        .normal = {0, 0, 1}, .velocity = {0, 0, 100}, .spin = {0, 0, 1e7}};
    packing.periodic[2] = false;
    const struct dem_group group[2] = {{.point = middle, .axis = {1, 0, 1}},
                                       {.point = middle, .axis = {0, 1, 0}}};
    const struct dem_liquid liquid = {.model = BRIDGE_WILLETT_FULL,
                                      .surface_tension = 0.07,
                                      .contact_angle = 0.2,
                                      .volume = 1e-3 * RADIUS * RADIUS * RADIUS,
                                      .shared = true,
                                      .wets_walls = true};
    struct dem_setup setup = stiff_setup(&packing);
    uint8_t *of = NEW_ARRAY(uint8_t, packing.n_particle);
    for (int i = 0; i < packing.n_particle; i++)
        of[i] = (uint8_t)(i % 12 < 2 ? 1 + i % 12 : 0);
    setup.bond.normal_strength = setup.bond.shear_strength = 1e4;
    setup.n_wall = 1;
    setup.wall = &wall;
    setup.n_group = 2;
    setup.group = group;
    setup.group_of = of;
    setup.liquid = &liquid;
    setup.balance_energy = true;
    setup.time_step_safety = NAN;
    check(&setup, stir);
    free(of);
    packing_free(&packing);
}

TEST(no_grains)
{
    struct packing packing = new_packing(0, 0);
    packing.upper = (struct vector){1, 1, 1};
    struct dem_setup setup = stiff_setup(&packing);
    check(&setup, fly);
    packing_free(&packing);
}

// ---- what is refused ----------------------------------------------------------------

static enum status try_restore(const struct dem_setup *setup,
                               const struct named_array *array, int count)
{
    struct dem *dem = create(setup);
    struct reason reason = {""};
    const enum status status = dem_restore(dem, array, count, &reason);
    if (status == STATUS_OK)
        dem_run(dem, 50, &reason); // may diverge, must not crash
    else
        assert_true(strlen(reason.text) > 0 && !strchr(reason.text, '\n'));
    dem_free(dem);
    return status;
}

// One number of one array at a time becomes what it cannot be.
TEST(damaged_arrays)
{
    struct packing packing = cubic_lattice(4, 4, 4, false);
    const struct dem_wall floor = {.normal = {0, 0, 1}};
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.normal_strength = setup.bond.shear_strength = 1e3;
    setup.n_wall = 1;
    setup.wall = &floor;
    setup.balance_energy = true;
    struct dem *dem = create(&setup);
    pull(dem, 0);
    int count;
    struct named_array *array = dem_save(dem, &count);
    dem_free(dem);
    for (int k = 0; k < count; k++) {
        struct named_array *of = &array[k];
        assert_true(of->count > 0); // each is tried
        const int64_t was = of->count;
        of->count--;
        assert_int_equal(try_restore(&setup, array, count), STATUS_BAD_DATA);
        of->count = was;
        const int64_t at = was / 2;
        double *number = of->data;
        int32_t *integer = of->data;
        int64_t *large = of->data;
        uint8_t *small = of->data;
        const double number_was = of->type == ARRAY_FLOAT64 ? number[at] : 0;
        const int32_t integer_was = of->type == ARRAY_INT32 ? integer[at] : 0;
        const int64_t large_was = of->type == ARRAY_INT64 ? large[at] : 0;
        const uint8_t small_was = of->type == ARRAY_UINT8 ? small[at] : 0;
        if (of->type == ARRAY_FLOAT64) number[at] = NAN;
        if (of->type == ARRAY_INT32) integer[at] = INT32_MIN;
        if (of->type == ARRAY_INT64) large[at] = -1;
        if (of->type == ARRAY_UINT8) small[at] = 7;
        assert_int_equal(try_restore(&setup, array, count), STATUS_BAD_DATA);
        if (of->type == ARRAY_FLOAT64) number[at] = number_was;
        if (of->type == ARRAY_INT32) integer[at] = integer_was;
        if (of->type == ARRAY_INT64) large[at] = large_was;
        if (of->type == ARRAY_UINT8) small[at] = small_was;
    }
    assert_int_equal(try_restore(&setup, array, count), STATUS_OK);
    assert_int_equal(try_restore(&setup, array, count - 1), STATUS_BAD_DATA);
    free_arrays(array, count);
    packing_free(&packing);
}

// Any bit of any integer array: refused, or run without a crash.
TEST(flipped_bits)
{
    struct packing packing = cubic_lattice(3, 3, 3, false);
    const struct dem_wall floor = {.normal = {0, 0, 1}};
    struct dem_setup setup = stiff_setup(&packing);
    setup.n_wall = 1;
    setup.wall = &floor;
    struct dem *dem = create(&setup);
    run(dem, 10);
    int count;
    struct named_array *array = dem_save(dem, &count);
    dem_free(dem);
    uint64_t seed = 1;
    for (int k = 0; k < count; k++) {
        static const int64_t size[] = {8, 4, 8, 1};
        const int64_t bytes = array[k].count * size[array[k].type];
        for (int trial = 0; trial < 20 && bytes > 0; trial++) {
            const double where = next_random(&seed);
            uint8_t *byte = (uint8_t *)array[k].data + (int64_t)(where * (double)bytes);
            const uint8_t was = *byte;
            *byte ^= (uint8_t)(1u << trial % 8);
            try_restore(&setup, array, count);
            *byte = was;
        }
    }
    free_arrays(array, count);
    packing_free(&packing);
}

TEST(another_scene)
{
    struct packing packing = cubic_lattice(3, 3, 3, false);
    struct packing other = cubic_lattice(3, 3, 4, false);
    struct dem_setup setup = stiff_setup(&packing), larger = stiff_setup(&other);
    struct dem *dem = create(&setup);
    int count;
    struct named_array *array = dem_save(dem, &count);
    assert_int_equal(try_restore(&larger, array, count), STATUS_BAD_DATA);
    free_arrays(array, count);
    dem_free(dem);
    packing_free(&packing);
    packing_free(&other);
}
