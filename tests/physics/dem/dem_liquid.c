// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid bridges between moving grains: formed by touch, kept until rupture, pulling as
// the models and the exact solution say; their liquid shared.
#include "../dem_scene.h"

#include "bridges/bridges.h"

static struct dem_liquid some_liquid(enum bridge_model model)
{
    return (struct dem_liquid){.model = model,
                               .surface_tension = 0.07,
                               .contact_angle = 0.2,
                               .volume = 1e-3 * RADIUS * RADIUS * RADIUS,
                               .pulls_in_contact = true};
}

static struct dem_setup loose_setup(const struct packing *packing,
                                    const struct dem_liquid *liquid)
{
    return (struct dem_setup){.packing = packing,
                              .material = {.density = 2500,
                                           .normal_stiffness = 100,
                                           .shear_stiffness = 100 * 2.0 / 7,
                                           .damping_ratio = 0.1},
                              .liquid = liquid,
                              .time_step_safety = 0.02,
                              .threads = 1};
}

// Grains in a row that touch.
static struct packing row_of(int n, const double *radius)
{
    struct packing packing = new_packing(n, 0);
    double x = 0;
    for (int i = 0; i < n; i++) {
        packing.radius[i] = radius[i];
        packing.position[i] = (struct vector){x + radius[i], RADIUS, RADIUS};
        x += 2 * radius[i];
    }
    packing.upper = (struct vector){x, 2 * RADIUS, 2 * RADIUS};
    return packing;
}

static double force_now(const struct dem *dem, double *separation)
{
    int count;
    struct dem_bridge *bridge = dem_bridges(dem, &count);
    const double force = count > 0 ? bridge->force : NAN;
    if (count > 0) *separation = bridge->separation;
    free(bridge);
    return force;
}

// The force of another place: the model, or the exact solution for its table.
static double wanted(const struct bridge *bridge, enum bridge_model model, double a)
{
    if (model != BRIDGE_TABLE) return bridge_model_force(bridge, model, a, NULL);
    struct bridge_state state;
    struct reason reason;
    assert_int_equal(bridge_solve(bridge, a, &state, &reason), STATUS_OK);
    return state.force;
}

// So fast that the bridge does not matter; back again, the grains never touch.
static void pull_apart(enum bridge_model model, double other_radius)
{
    const double radius[2] = {RADIUS, other_radius};
    struct packing packing = row_of(2, radius);
    const struct dem_liquid liquid = some_liquid(model);
    const struct dem_setup setup = loose_setup(&packing, &liquid);
    const struct bridge bridge = {
        {radius[0], radius[1]}, {0.2, 0.2}, 0.07, liquid.volume};
    struct dem *dem = create(&setup);
    const double step = 0.002 * RADIUS, speed = step / dem_time_step(dem);
    double rupture = bridge_rupture_distance(&bridge), a = 0;
    if (model == BRIDGE_TABLE) {
        struct bridge_state last;
        struct reason reason;
        assert_int_equal(bridge_solve_rupture(&bridge, &last, &reason), STATUS_OK);
        rupture = last.separation;
    }
    int seen = 0;
    for (int cycle = 0; cycle < 200; cycle++) {
        const double sign = cycle < 100 ? 1 : -0.5;
        dem_set_velocity(dem, (struct vector[2]){{0, 0, 0}, {sign * speed, 0, 0}},
                         NULL);
        run(dem, 1);
        const double force = force_now(dem, &a);
        if (isnan(force)) continue;
        seen++;
        assert_true(cycle < 100 && a <= rupture * (1 + 1e-12));
        assert_close(force, wanted(&bridge, model, a),
                     model == BRIDGE_TABLE ? 1e-5 : 1e-11);
    }
    assert_true(a > rupture - 1.1 * step && seen < 100);
    dem_free(dem);
    packing_free(&packing);
}

TEST(pulls_as_the_models_until_rupture)
{
    for (int model = BRIDGE_WEIGERT; model < BRIDGE_MODELS; model++)
        pull_apart((enum bridge_model)model, 0.5 * RADIUS);
    pull_apart(BRIDGE_TABLE, RADIUS);
    pull_apart(BRIDGE_TABLE, 0.5 * RADIUS);
    pull_apart(BRIDGE_TABLE, 0.1 * RADIUS);
}

// At rest the contact carries what the bridge pulls with at a = 0, if it pulls there.
TEST(presses_grains_together)
{
    const double radius[2] = {RADIUS, RADIUS};
    struct packing packing = row_of(2, radius);
    for (int pulls = 0; pulls < 2; pulls++) {
        struct dem_liquid liquid = some_liquid(BRIDGE_RABINOVICH_LAMBERT);
        liquid.pulls_in_contact = pulls;
        const struct dem_setup setup = loose_setup(&packing, &liquid);
        struct dem *dem = create(&setup);
        run(dem, 30000);
        double a = 1;
        const double force = force_now(dem, &a),
                     at_contact = 2 * M_PI * RADIUS * 0.07 * cos(0.2);
        if (pulls) {
            assert_close(force, at_contact, 1e-12);
            assert_close(-a, at_contact / 50, 1e-9); // two grains of 100 N/m in series
        } else
            assert_true(force == 0 && a == 0);
        dem_free(dem);
    }
    packing_free(&packing);
}

// Volumes of the bridges 0-1, 1-2, or 0.
static void volumes_of(const struct dem *dem, double volume[2])
{
    int count;
    struct dem_bridge *bridge = dem_bridges(dem, &count);
    volume[0] = volume[1] = 0;
    for (int k = 0; k < count; k++)
        volume[bridge[k].particle[0]] = bridge[k].volume;
    free(bridge);
}

TEST(shares_its_liquid)
{
    const double radius[3] = {RADIUS, 0.8 * RADIUS, RADIUS};
    struct packing packing = row_of(3, radius);
    struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_FULL);
    liquid.shared = true;
    const struct dem_setup setup = loose_setup(&packing, &liquid);
    struct dem *dem = create(&setup);
    double volume[2];
    volumes_of(dem, volume); // the grain in the middle halves its own
    assert_close(volume[0], 1.5 * liquid.volume, 1e-14);
    assert_close(volume[1], 1.5 * liquid.volume, 1e-14);
    const double speed = 0.002 * RADIUS / dem_time_step(dem);
    dem_set_velocity(dem, (struct vector[3]){{0, 0, 0}, {0, 0, 0}, {speed, 0, 0}},
                     NULL);
    run(dem, 300);
    volumes_of(dem, volume);
    assert_close(volume[0], 2 * liquid.volume, 1e-14);
    assert_true(volume[1] == 0);
    dem_free(dem);
    packing_free(&packing);
}

// Wet grains of two sizes, thrown about where the box repeats along x.
enum { SIDE = 14, MANY = SIDE * SIDE * SIDE };

static struct packing wet_grains(void)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
    packing.n_bond = 0;
    packing.periodic[0] = true;
    for (int i = 0; i < MANY; i++)
        packing.radius[i] = i % 7 ? RADIUS : 0.9 * RADIUS;
    return packing;
}

static struct dem *thrown(const struct packing *packing,
                          const struct dem_liquid *liquid, int threads, double safety)
{
    struct dem_setup setup = loose_setup(packing, liquid);
    struct dem_wall wall[4] = {{.normal = {0, 1, 0}},
                               {.point = packing->upper, .normal = {0, -1, 0}},
                               {.normal = {0, 0, 1}},
                               {.point = packing->upper, .normal = {0, 0, -1}}};
    setup.wall = wall;
    setup.n_wall = liquid->wets_walls ? 4 : 0;
    setup.threads = threads;
    setup.time_step_safety = safety;
    setup.balance_energy = true;
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(MANY, 0.5, 5);
    dem_set_velocity(dem, velocity, NULL);
    free(velocity);
    return dem;
}

static int bridges_in(const struct dem *dem)
{
    int count;
    free(dem_bridges(dem, &count));
    return count;
}

static void assert_same(const struct dem *a, const struct dem *b)
{
    struct vector *x = NEW_ARRAY(struct vector, MANY),
                  *y = NEW_ARRAY(struct vector, MANY);
    dem_displacements(a, x);
    dem_displacements(b, y);
    assert_memory_equal(x, y, MANY * sizeof *x);
    assert_int_equal(bridges_in(a), bridges_in(b));
    free(x);
    free(y);
}

TEST(same_bytes_whoever_computes)
{
    struct packing packing = wet_grains();
    struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_REDUCED);
    liquid.shared = liquid.wets_walls = true;
    struct dem *one = thrown(&packing, &liquid, 1, 0.02);
    const int began = bridges_in(one);
    run(one, 400);
    assert_true(bridges_in(one) != began && bridges_in(one) > MANY);
    for (int threads = 2; threads < 4; threads++) {
        struct dem *more = thrown(&packing, &liquid, threads, 0.02);
        run(more, 160);
        int count; // stop, and go on in another
        struct named_array *kept = dem_save(more, &count);
        struct dem *again = thrown(&packing, &liquid, threads, 0.02);
        struct reason reason = {""};
        if (dem_restore(again, kept, count, &reason)) fail_msg("%s", reason.text);
        run(again, 240);
        assert_same(one, again);
        free_arrays(kept, count);
        dem_free(more);
        dem_free(again);
    }
    dem_free(one);
    packing_free(&packing);
}

static double norm_of_momentum(const struct dem *dem, double *all)
{
    double size = 0;
    for (int i = 0; i < dem->n_particle; i++)
        size += dem->mass[i] * norm(as_vector(velocity_of(dem, i)));
    *all = size * dem->unit.mass * dem->unit.length / dem->unit.time;
    return norm(dem_momentum(dem).linear);
}

// Momentum stays; energy is in the books, the better the shorter the steps.
TEST(conserves)
{
    struct packing packing = wet_grains();
    const struct dem_liquid liquid = some_liquid(BRIDGE_RABINOVICH);
    double missing[2];
    for (int fine = 0; fine < 2; fine++) {
        const double safety = fine ? 0.005 : 0.02;
        struct dem *dem = thrown(&packing, &liquid, 2, safety);
        double all, began_all;
        const double began = dem_energy(dem).kinetic;
        const struct vector before = dem_momentum(dem).linear;
        norm_of_momentum(dem, &began_all);
        run(dem, (int64_t)(5 / safety));
        const struct dem_energy now = dem_energy(dem);
        norm_of_momentum(dem, &all);
        assert_true(norm(subtract(dem_momentum(dem).linear, before)) <
                    1e-13 * began_all);
        missing[fine] =
            fabs(now.kinetic + now.elastic + now.dashpots + now.bridges - began) /
            began;
        assert_true(fabs(now.bridges) > 0.05 * began);
        dem_free(dem);
    }
    if (!(missing[1] < 0.01 && missing[1] < 0.3 * missing[0])) // of first order
        fail_msg("missing %g, in longer steps %g", missing[1], missing[0]);
    packing_free(&packing);
}

// What contacts list is all that grains do to each other: it adds up to the net force
// on each, and its virial, sum of x F, is the stress [Clausius]. Where each was when
// these forces acted: a time step ago.
TEST(stress_and_contacts_hold_bridges)
{
    struct packing packing = wet_grains();
    packing.periodic[0] = false;
    const struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_FULL);
    struct dem *dem = thrown(&packing, &liquid, 1, 0.02);
    run(dem, 40);
    struct vector *x = NEW_ARRAY(struct vector, MANY),
                  *v = NEW_ARRAY(struct vector, MANY),
                  *net = NEW_ARRAY(struct vector, MANY),
                  *moment = NEW_ARRAY(struct vector, MANY);
    dem_positions(dem, x);
    dem_velocities(dem, v);
    dem_loads(dem, net, moment);
    double virial[9] = {0}, largest = 0, left = 0, size = 0;
    for (int i = 0; i < MANY; i++) {
        const struct vector at = subtract(x[i], scale(dem_time_step(dem), v[i]));
        for (int k = 0; k < 9; k++)
            virial[k] += component(at, k / 3) * component(net[i], k % 3);
        largest = fmax(largest, norm(net[i]));
    }

    int count, over_gaps = 0;
    struct dem_contact *contact = dem_contacts(dem, &count);
    for (int c = 0; c < count; c++) {
        struct vector *on = net;
        on[contact[c].particle[0]] = add(on[contact[c].particle[0]], contact[c].force);
        on[contact[c].particle[1]] =
            subtract(on[contact[c].particle[1]], contact[c].force);
        if (contact[c].overlap >= 0) continue;
        over_gaps++;
        assert_true(contact[c].bridge_volume > 0);
        assert_close(norm(contact[c].force), contact[c].bridge_force, 1e-12);
    }
    for (int i = 0; i < MANY; i++)
        left = fmax(left, norm(net[i]));
    if (!(over_gaps > 100 && left < 1e-12 * largest))
        fail_msg("%d bridges over gaps, %g of %g N missing", over_gaps, left, largest);

    const struct dem_census census = dem_census(dem);
    const double volume = packing.upper.x * packing.upper.y * packing.upper.z;
    for (int k = 0; k < 9; k++)
        size = fmax(size, fabs(virial[k]) / volume);
    for (int k = 0; k < 9; k++)
        assert_within(census.stress[k / 3][k % 3], virial[k] / volume, 1e-10 * size);
    assert_int_equal(census.contacts, count - over_gaps);
    free(contact);
    free(x);
    free(v);
    free(net);
    free(moment);
    dem_free(dem);
    packing_free(&packing);
}

// ---- boxes that are strained --------------------------------------------------------

// The gap of a strained bridge is that of the places, its force that of the gap.
TEST(strained_bridge)
{
    const double radius[2] = {RADIUS, RADIUS};
    struct packing packing = row_of(2, radius);
    packing.upper.x *= 3;
    packing.periodic[0] = true;
    const struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_FULL);
    const struct dem_setup setup = loose_setup(&packing, &liquid);
    struct dem *dem = create(&setup);
    const double stretch[3] = {1.01, 1, 1};
    assert_int_equal(dem_rescale(dem, stretch, 1), STATUS_OK);
    run(dem, 1);
    double a = 0;
    const double force = force_now(dem, &a);
    const struct bridge bridge = {{RADIUS, RADIUS}, {0.2, 0.2}, 0.07, liquid.volume};
    assert_close(a, 0.02 * RADIUS, 1e-12);
    assert_close(force, wanted(&bridge, BRIDGE_WILLETT_FULL, a), 1e-11);
    assert_int_equal(dem_rescale(dem, stretch, 1.01), STATUS_BAD_DATA);
    dem_free(dem);
    packing_free(&packing);
}

// Its work is in the books, what bridges took up included.
static double books_of_strained_box(double safety, struct dem_energy *now)
{
    struct packing packing = wet_grains();
    packing.periodic[1] = packing.periodic[2] = true;
    const struct dem_liquid liquid = some_liquid(BRIDGE_RABINOVICH);
    struct dem *dem = thrown(&packing, &liquid, 2, safety);
    const double began = dem_energy(dem).kinetic;
    const double stretch[3] = {1.001, 0.9995, 1.0005};
    for (int k = 0; k < 25; k++) {
        assert_int_equal(dem_rescale(dem, stretch, 1), STATUS_OK);
        run(dem, (int64_t)(0.2 / safety));
    }
    *now = dem_energy(dem);
    dem_free(dem);
    packing_free(&packing);
    return fabs(now->kinetic + now->elastic + now->dashpots + now->bridges - began -
                now->gained) /
           now->gained;
}

TEST(books_of_a_strained_box)
{
    struct dem_energy now;
    const double coarse = books_of_strained_box(0.02, &now);
    const double fine = books_of_strained_box(0.005, &now);
    if (!(fine < 0.01 && fine < 0.3 * coarse)) // of first order
        fail_msg("missing %g, in longer steps %g", fine, coarse);
    assert_true(fabs(now.bridges) > 0.2 * now.gained);
}

// ---- walls --------------------------------------------------------------------------

static double exact_rupture(const struct bridge *bridge)
{
    struct bridge_state last;
    struct reason reason;
    assert_int_equal(bridge_solve_rupture(bridge, &last, &reason), STATUS_OK);
    return last.separation;
}

// Pulls a grain along x off a WALL that it touches at x = 0. Forces are those of BRIDGE
// within FRACTION, up to a SHARE of the separation at which that ruptures.
static void pull_off(enum bridge_model model, struct dem_wall wall,
                     struct bridge bridge, double share, double fraction)
{
    const double radius = RADIUS;
    const double rupture = model == BRIDGE_TABLE ? exact_rupture(&bridge)
                                                 : bridge_rupture_distance(&bridge);
    struct packing packing = row_of(1, &radius); // it touches the plane x = 0
    struct dem_liquid liquid = some_liquid(model);
    liquid.wets_walls = true;
    struct dem_setup setup = loose_setup(&packing, &liquid);
    setup.wall = &wall;
    setup.n_wall = 1;
    struct dem *dem = create(&setup);
    const double step = 0.002 * RADIUS, speed = step / dem_time_step(dem);
    double a = 0;
    int seen = 0;
    for (int cycle = 0; cycle < 200; cycle++) {
        const struct vector velocity = {cycle < 100 ? speed : -0.5 * speed, 0, 0};
        dem_set_velocity(dem, &velocity, NULL);
        run(dem, 1);
        const double force = force_now(dem, &a);
        if (isnan(force)) continue;
        seen++;
        assert_true(cycle < 100 && a <= rupture * (2 - share + fraction));
        if (a < share * rupture)
            assert_close(force, wanted(&bridge, model, a), fraction);
        if (a > 0) assert_close(dem_wall_state(dem, 0).force.x, force, 1e-12);
    }
    assert_true(a > share * rupture - 1.1 * step && seen > 1 && seen < 100);
    dem_free(dem);
    packing_free(&packing);
}

TEST(pulls_at_planes_until_rupture)
{
    const struct dem_wall plane = {.normal = {1, 0, 0}};
    const struct bridge bridge = {
        {RADIUS, INFINITY}, {0.2, 0.2}, 0.07, some_liquid(BRIDGE_TABLE).volume};
    for (int model = BRIDGE_WEIGERT; model < BRIDGE_MODELS; model++)
        pull_off((enum bridge_model)model, plane, bridge, 1, 1e-11);
    pull_off(BRIDGE_TABLE, plane, bridge, 1, 1e-5);
}

// What liquid.c says of a sphere of ten radii: here the volume is 1.7e-4 of the
// effective radius cubed. The approximations know no other reduction.
TEST(pulls_at_spheres)
{
    const struct dem_wall beside = {.shape = DEM_SPHERE,
                                    .point = {-10 * RADIUS, RADIUS, RADIUS},
                                    .radius = 10 * RADIUS,
                                    .outside = true};
    struct bridge bridge = {
        {RADIUS, 10 * RADIUS}, {0.2, 0.2}, 0.07, some_liquid(BRIDGE_TABLE).volume};
    pull_off(BRIDGE_TABLE, beside, bridge, 0.85, 2.2e-3);
    pull_off(BRIDGE_WILLETT_FULL, beside, bridge, 1, 1e-11);
}

// With little liquid, a film of height h fills the gap kappa_1 x^2/2 + kappa_2 y^2/2 <
// h between curved surfaces, an ellipse of area 2 pi h / sqrt(kappa_1 kappa_2), under
// the suction 2 gamma cos(theta) / h: so Willett's reduced formula pulls at contact,
// and the grain at rest is pressed into the wall by as much.
TEST(presses_grains_to_round_walls)
{
    const double a = RADIUS, b = 3 * RADIUS;
    const struct {
        enum dem_wall_shape shape;
        bool outside;
        double kappa[2];
    } of[] = {{DEM_PLANE, false, {1 / a, 1 / a}},
              {DEM_SPHERE, true, {1 / a + 1 / b, 1 / a + 1 / b}},
              {DEM_SPHERE, false, {1 / a - 1 / b, 1 / a - 1 / b}},
              {DEM_CYLINDER, true, {1 / a + 1 / b, 1 / a}},
              {DEM_CYLINDER, false, {1 / a - 1 / b, 1 / a}},
              {DEM_RING, false, {1 / a, 1 / a}}};
    struct packing packing = row_of(1, &a);
    struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_REDUCED);
    liquid.wets_walls = true;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        const bool round = of[k].shape == DEM_SPHERE || of[k].shape == DEM_CYLINDER;
        const bool flat = of[k].shape == DEM_PLANE || of[k].shape == DEM_RING;
        const double centre = !round ? 0 : of[k].outside ? -b : b;
        const struct dem_wall wall = {.shape = of[k].shape,
                                      .point = {centre, RADIUS, RADIUS},
                                      .normal = {flat, 0, !flat},
                                      .radius = b,
                                      .outside = of[k].outside};
        struct dem_setup setup = loose_setup(&packing, &liquid);
        setup.wall = &wall;
        setup.n_wall = 1;
        struct dem *dem = create(&setup);
        run(dem, 30000);
        double gap = 1;
        const double force = force_now(dem, &gap);
        const double area = 2 * M_PI / sqrt(of[k].kappa[0] * of[k].kappa[1]);
        assert_close(force, 2 * 0.07 * cos(0.2) * area, 1e-11);
        assert_close(-gap, force / 100, 1e-8); // 100 N/m on a rigid wall
        dem_free(dem);
    }
    packing_free(&packing);
}

// A grain on a floor, beside another: it divides its own liquid, the floor has none.
TEST(shares_its_liquid_with_walls)
{
    const double radius[2] = {RADIUS, RADIUS};
    struct packing packing = row_of(2, radius);
    struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_FULL);
    liquid.shared = liquid.wets_walls = true;
    struct dem_setup setup = loose_setup(&packing, &liquid);
    const struct dem_wall side = {.normal = {1, 0, 0}};
    setup.wall = &side;
    setup.n_wall = 1;
    struct dem *dem = create(&setup);
    int count;
    struct dem_bridge *bridge = dem_bridges(dem, &count);
    assert_int_equal(count, 2);
    assert_int_equal(bridge[0].particle[1], -1);
    assert_close(bridge[0].volume, 0.5 * liquid.volume, 1e-14);
    assert_close(bridge[1].volume, 1.5 * liquid.volume, 1e-14);
    free(bridge);
    const double speed = 0.002 * RADIUS / dem_time_step(dem);
    dem_set_velocity(dem, (struct vector[2]){{0, 0, 0}, {speed, 0, 0}}, NULL);
    run(dem, 300);
    bridge = dem_bridges(dem, &count);
    assert_int_equal(count, 1);
    assert_close(bridge[0].volume, liquid.volume, 1e-14);
    free(bridge);
    dem_free(dem);
    packing_free(&packing);
}

// What contacts list is all that grains and walls do to each other, and energy is in
// the books.
static double books_at_walls(double safety)
{
    struct packing packing = wet_grains();
    struct dem_liquid liquid = some_liquid(BRIDGE_RABINOVICH);
    liquid.wets_walls = true;
    struct dem *dem = thrown(&packing, &liquid, 2, safety);
    struct vector *fast = random_vectors(MANY, 6, 5); // m/s: many bridges rupture
    dem_set_velocity(dem, fast, NULL);
    free(fast);
    const double began = dem_energy(dem).kinetic;
    run(dem, (int64_t)(2.5 / safety));
    struct vector *net = NEW_ARRAY(struct vector, MANY),
                  *moment = NEW_ARRAY(struct vector, MANY), wall[4] = {{0}};
    dem_loads(dem, net, moment);
    int count, over_gaps = 0;
    double size = 0, left = 0;
    struct dem_contact *contact = dem_contacts(dem, &count);
    for (int c = 0; c < count; c++) {
        const int32_t *end = contact[c].particle;
        size = fmax(size, norm(contact[c].force));
        net[end[0]] = add(net[end[0]], contact[c].force);
        if (end[1] >= 0)
            net[end[1]] = subtract(net[end[1]], contact[c].force);
        else
            wall[-1 - end[1]] = add(wall[-1 - end[1]], contact[c].force);
        over_gaps += end[1] < 0 && contact[c].overlap < 0;
    }
    for (int i = 0; i < MANY; i++)
        left = fmax(left, norm(net[i]));
    for (int w = 0; w < 4; w++)
        left = fmax(left, distance(wall[w], dem_wall_state(dem, w).force));
    if (!(over_gaps > 20 && left < 1e-12 * size))
        fail_msg("%d bridges over gaps, %g of %g N missing", over_gaps, left, size);
    const struct dem_energy now = dem_energy(dem);
    free(contact);
    free(net);
    free(moment);
    dem_free(dem);
    packing_free(&packing);
    return fabs(now.kinetic + now.elastic + now.dashpots + now.bridges - began) / began;
}

TEST(books_at_wet_walls)
{
    const double coarse = books_at_walls(0.02), fine = books_at_walls(0.005);
    if (!(fine < 0.01 && fine < 0.3 * coarse)) // of first order
        fail_msg("missing %g, in longer steps %g", fine, coarse);
}

// ---- the rest -----------------------------------------------------------------------

// The same from nm to km.
TEST(is_scale_free)
{
    struct vector moved[2];
    for (int large = 0; large < 2; large++) {
        const double scale = large ? 4e12 : 4e-2; // 1e6 m or 1e-8 m
        const double radius[3] = {RADIUS * scale, 0.8 * RADIUS * scale, RADIUS * scale};
        struct packing packing = row_of(3, radius);
        struct dem_liquid liquid = some_liquid(BRIDGE_WILLETT_FULL);
        liquid.volume *= scale * scale * scale;
        const struct dem_setup setup = loose_setup(&packing, &liquid);
        struct dem *dem = create(&setup);
        run(dem, 200);
        moved[large] = displacement_of(dem, 2);
        moved[large].x /= RADIUS * scale;
        dem_free(dem);
        packing_free(&packing);
    }
    assert_close(moved[1].x, moved[0].x, 1e-11);
    assert_true(moved[0].x < -1e-4);
}

static void refuses(const struct packing *packing, struct dem_liquid liquid,
                    const char *why)
{
    assert_refused(loose_setup(packing, &liquid), why);
}

TEST(refuses_what_it_cannot)
{
    const double radius[2] = {RADIUS, 0.5 * RADIUS};
    struct packing packing = row_of(2, radius);
    refuses(&packing, some_liquid(BRIDGE_EXACT), "too slow");
    struct dem_liquid liquid = some_liquid(BRIDGE_SOULIE);
    liquid.volume = -1;
    refuses(&packing, liquid, "volume of bridges must be > 0");
    liquid = some_liquid(BRIDGE_SOULIE);
    liquid.contact_angle = NAN;
    refuses(&packing, liquid, "contact angle must be in");
    liquid = some_liquid(BRIDGE_SOULIE);
    liquid.wets_walls = true;
    struct dem_setup setup = loose_setup(&packing, &liquid);
    const struct dem_wall tube = {
        .shape = DEM_CYLINDER, .normal = {1, 0, 0}, .radius = RADIUS};
    setup.wall = &tube;
    setup.n_wall = 1;
    struct dem *dem;
    struct reason reason = {""};
    assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, "wider than the largest grain"));
    packing_free(&packing);
}
