// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium where grains move and turn far (dem-replay, engine=quasi-static,
// quasi_static.large_displacements) against chains integrated here, the Euler load of a
// chain in closed form, turned scenes, energy, and discrete elements brought to rest.
#include "bent_row.h"
#include "quasi_static/large/large_state.h"

// Without contacts, so that rows resist alike pushed and pulled.
static struct quasi_static_setup row_setup(const struct packing *packing,
                                           const uint8_t *fixed)
{
    struct quasi_static_setup setup = setup_of(packing, fixed);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 0;
    setup.large_displacements = true;
    setup.increment = 0.02;
    return setup;
}

// ---- a row bent far -----------------------------------------------------------------

// Where the end of the row is by equilibria, over its radius off where it should be.
static double row_error(double force, double angle, double increment)
{
    const struct row row = bend_row((struct row){.angle = angle}, force, angle, 400);
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    const uint8_t fixed[ROW] = {1};
    struct quasi_static_setup setup = row_setup(&packing, fixed);
    setup.increment = increment;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector pull[ROW] = {{0, 0, 0}}, moved[ROW];
    pull[ROW - 1] = (struct vector){force * cos(angle), force * sin(angle), 0};
    next_equilibrium(equilibrium, pull);
    quasi_static_displacements(equilibrium, moved);
    const double error = distance(moved[ROW - 1], end_of(&row)) / RADIUS;
    print_message(
        "# row: end at (%g, %g) radii, turned %g rad; error %g, %d iterations\n",
        moved[ROW - 1].x / RADIUS, moved[ROW - 1].y / RADIUS,
        equilibrium->displacement[ROW - 1].rotation.z, error,
        quasi_static_iterations(equilibrium));
    quasi_static_free(equilibrium);
    packing_free(&packing);
    return error;
}

// Its end turns by more than a right angle; the error falls with the square of the
// increments.
TEST(a_row_bent_far)
{
    const double unit = 2 * bending_stiffness() / (HINGES * HINGES * 2 * RADIUS);
    const double angle = 0.6 * M_PI;
    const double coarse = row_error(2.5 * unit, angle, 0.04);
    const double fine = row_error(2.5 * unit, angle, 0.01);
    assert_true(fine < 1e-9);
    assert_true(fine < coarse / 8);
}

// ---- buckling -----------------------------------------------------------------------

TEST(a_row_buckles)
{
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    const uint8_t fixed[ROW] = {1};
    const struct quasi_static_setup setup = row_setup(&packing, fixed);
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    const double load = buckling_load();
    struct vector push[ROW] = {{0, 0, 0}}, moved[ROW];
    push[ROW - 1].x = -2 * load;
    next_equilibrium(equilibrium, push);
    int last;
    assert_int_equal(quasi_static_instabilities(equilibrium, &last), 1);
    assert_int_equal(last, ROW - 1);
    print_message("# %.9f of the Euler load\n",
                  2 * equilibrium->large->fraction_at_instability);
    assert_true(fabs(2 * equilibrium->large->fraction_at_instability - 1) < 1e-5);
    quasi_static_displacements(equilibrium, moved);
    const struct vector at = moved[ROW - 1];
    const struct row row = buckled_row(2 * load);
    const struct vector end = end_of(&row);
    const double across = sqrt(at.y * at.y + at.z * at.z);
    const double error = hypot(at.x - end.x, across - end.y) / RADIUS;
    print_message("# buckled: end at (%g, %g) radii, error %g, %d iterations\n",
                  at.x / RADIUS, across / RADIUS, error,
                  quasi_static_iterations(equilibrium));
    assert_true(error < 5e-5);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// ---- beside discrete elements -------------------------------------------------------

// As load_block, and twisted.
static void twist_block(struct vector force[BLOCK], double size)
{
    for (int i = 0; i < BLOCK; i++) {
        const int x = i % SIDE - 1, y = i / SIDE % SIDE - 1;
        force[i] = (struct vector){size * (-x - 0.5 * y), size * (0.3 * x - 0.7 * y),
                                   0.1 * size * (1 + (i * 7) % 5)};
    }
}

static double largest_turn(const struct quasi_static *equilibrium)
{
    double most = 0;
    for (int i = 0; i < equilibrium->n; i++)
        most = fmax(most, norm(equilibrium->displacement[i].rotation));
    return most;
}

static struct quasi_static_setup block_setup(const struct packing *packing,
                                             const uint8_t *fixed)
{
    struct quasi_static_setup setup = row_setup(packing, fixed);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 300;
    return setup;
}

// Where cycles come to rest under a load that grows to FULL (n_particle) so slowly that
// they follow the way of equilibria: shear depends on the way.
static void grow_to_rest(const struct quasi_static_setup *setup,
                         const struct vector *full, int steps, struct vector *still)
{
    const bool is_point = setup->bond.kind == DEM_CONTACT_BOND;
    const int n = setup->packing->n_particle;
    struct dem_setup slow = cycles_of(setup, is_point ? 0.03 : 0.045);
    // Dashpots do not see rolling, and are at contacts only.
    slow.material.local_damping =
        is_point || !(setup->material.normal_stiffness > 0) ? 0.5 : 0;
    struct dem *dem;
    struct reason reason = {""};
    struct vector *force = NEW_ARRAY(struct vector, n);
    if (dem_create(&dem, &slow, &reason)) fail_msg("%s", reason.text);
    for (int step = 1; step <= steps; step++) {
        for (int i = 0; i < n; i++)
            force[i] = scale((double)step / steps, full[i]);
        dem_set_force(dem, force);
        if (dem_run(dem, 50, &reason)) fail_msg("%s", reason.text);
    }
    const double rest = is_point ? 1e-8 : 1e-10;
    if (dem_run_until(dem, rest, 2000000, &reason)) fail_msg("%s", reason.text);
    dem_displacements(dem, still);
    dem_free(dem);
    free(force);
}

static void cycles_to_rest(const struct quasi_static_setup *setup, double size,
                           int steps, struct vector still[BLOCK])
{
    struct vector full[BLOCK];
    twist_block(full, size);
    grow_to_rest(setup, full, steps, still);
}

// Contacts push and open, grains turn by 0.009 to 0.33 rad.
TEST(a_block_as_the_discrete_elements)
{
    const struct {
        double size, turn;
        int steps;
    } run[] = {{5e-8, 0.0089, 1000}, {2.5e-7, 0.047, 1000}, {1.25e-6, 0.33, 8000}};
    struct block *block = new_block();
    struct quasi_static_setup setup = block_setup(&block->packing, block->fixed);
    setup.increment = 0.002;
    for (size_t k = 0; k < sizeof run / sizeof *run; k++) {
        struct vector force[BLOCK], still[BLOCK], moved[BLOCK];
        struct quasi_static *equilibrium = make_equilibrium(&setup);
        twist_block(force, run[k].size);
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, moved);
        assert_true(fabs(largest_turn(equilibrium) / run[k].turn - 1) < 0.01);
        cycles_to_rest(&setup, run[k].size, run[k].steps, still);
        const double error = apart(still, moved);
        print_message("# block turned by %g rad: engines %g apart\n",
                      largest_turn(equilibrium), error);
        assert_true(error < 1e-6);
        quasi_static_free(equilibrium);
    }
    free_block(block);
}

// Contact bonds. Nothing resists rolling in cycles; what does here matters as much as
// it is of the shear stiffness, while grains have not moved so far that their turning
// like gears, which nothing then brings to rest, turns the shear forces.
TEST(contact_bonds_as_the_discrete_elements)
{
    struct block *block = new_block();
    struct quasi_static_setup setup = block_setup(&block->packing, block->fixed);
    setup.bond.kind = DEM_CONTACT_BOND;
    struct vector force[BLOCK], still[BLOCK], moved[BLOCK];
    cycles_to_rest(&setup, 2e-9, 4000, still);
    twist_block(force, 2e-9);
    for (int k = 0; k < 4; k++) {
        setup.rolling = k % 2 ? 1e-5 : 1e-3;
        setup.large_displacements = k < 2;
        struct quasi_static *equilibrium = make_equilibrium(&setup);
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, moved);
        const double error = apart(still, moved);
        print_message("# contact bonds, rolling %g: engines %g apart\n", setup.rolling,
                      error);
        if (setup.large_displacements) assert_true(error < 5 * setup.rolling);
        quasi_static_free(equilibrium);
    }
    free_block(block);
}

// A row that is bent until its end lies on a grain that was half a radius away, and
// further: contacts are found on the way.
TEST(grains_that_come_to_touch)
{
    enum { LONG = 6, N = LONG + 1 };
    struct packing packing = cubic_lattice(LONG, 1, 1, false);
    packing.n_particle = N;
    packing.position = reallocate(packing.position, N, sizeof *packing.position);
    packing.radius = reallocate(packing.radius, N, sizeof *packing.radius);
    packing.radius[LONG] = RADIUS;
    packing.position[LONG] =
        add(packing.position[LONG - 1], (struct vector){0.3 * RADIUS, 2.5 * RADIUS, 0});
    packing.upper.y += 3 * RADIUS;
    const uint8_t fixed[N] = {[0] = 1, [LONG] = 1};
    struct quasi_static_setup setup = row_setup(&packing, fixed);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 300;
    setup.increment = 0.005;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[N] = {{0, 0, 0}}, moved[N], still[N];
    force[LONG - 1].y = 1e-8;
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    int count;
    struct dem_contact *contact = quasi_static_contacts(equilibrium, &count);
    assert_int_equal(contact[count - 1].particle[1], LONG);
    assert_true(contact[count - 1].overlap > 1e-5 * RADIUS);
    free(contact);
    grow_to_rest(&setup, force, 1000, still);
    const double error =
        distance(moved[LONG - 1], still[LONG - 1]) / norm(still[LONG - 1]);
    print_message("# an end that moved %g radii: engines %g apart\n",
                  norm(moved[LONG - 1]) / RADIUS, error);
    assert_true(error < 1e-6);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// ---- snap-through -------------------------------------------------------------------

enum { BARS = 4, APEX = BARS };
static const double rise = 0.3 * RADIUS;
static const double softer = 0.002; // shear, of what bonds resist along

// A grain above four that are held, pushed down: bars of length 2 r over a half span a.
// At a height h the force is
//     P = -4 k A ((L - 2 r) sin g + softer s cos g),  L = (a^2 + h^2)^(1/2) = a / cos
//     g,
// where by the way down shear is s = integral of L dg = a (arsinh(h / a) - arsinh(h0 /
// a)).
static double half_span(void)
{
    return sqrt(4 * RADIUS * RADIUS - rise * rise);
}

static double truss_force(double h)
{
    const double a = half_span(), length = hypot(a, h);
    const double shear = a * (asinh(h / a) - asinh(rise / a));
    return -4 * bond_stiffness * bond_area() *
           ((length - 2 * RADIUS) * h + softer * shear * a) / length;
}

static double truss_slope(double h) // dP / dh
{
    const double a = half_span(), length = hypot(a, h);
    const double shear = a * (asinh(h / a) - asinh(rise / a));
    return -4 * bond_stiffness * bond_area() *
           (1 - 2 * RADIUS * a * a / pow(length, 3) +
            softer * a * (a / length - shear * h / length / length) / length);
}

// Where VALUE is 0, between where it is negative and where it is not.
static double root(double (*value)(double), double taken_off, double below, double not )
{
    for (int k = 0; k < 200; k++) {
        const double middle = 0.5 * (below + not );
        *(value(middle) < taken_off ? &below : &not ) = middle;
    }
    return below;
}

static struct packing truss(void)
{
    struct packing packing = cubic_lattice(BARS + 1, 1, 1, false);
    const double a = half_span();
    for (int i = 0; i < BARS; i++)
        packing.position[i] = (struct vector){a * (i == 0) - a * (i == 1),
                                              a * (i == 2) - a * (i == 3), 0};
    packing.position[APEX] = (struct vector){0, 0, rise};
    for (int b = 0; b < BARS; b++) {
        packing.bond[b][0] = b;
        packing.bond[b][1] = APEX;
    }
    return packing;
}

static struct quasi_static_setup truss_setup(const struct packing *packing,
                                             const uint8_t *fixed)
{
    struct quasi_static_setup setup = row_setup(packing, fixed);
    setup.bond.shear_stiffness *= softer;
    return setup;
}

// How far the apex is from HEIGHT under LOAD, over its radius; where it snapped through
// last, of the load.
static double apex_error(double load, double increment, double height, double *ended)
{
    struct packing packing = truss();
    const uint8_t fixed[BARS + 1] = {1, 1, 1, 1, 0};
    struct quasi_static_setup setup = truss_setup(&packing, fixed);
    setup.increment = increment;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[BARS + 1] = {{0, 0, 0}}, moved[BARS + 1];
    force[APEX].z = -load;
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    int last;
    *ended = quasi_static_instabilities(equilibrium, &last)
                 ? equilibrium->large->fraction_at_instability
                 : 1;
    const double error = fabs(rise + moved[APEX].z - height) / RADIUS;
    print_message("# apex at %g radii, error %g; up to %.9g of the load\n",
                  (rise + moved[APEX].z) / RADIUS, error, *ended);
    quasi_static_free(equilibrium);
    packing_free(&packing);
    return error;
}

TEST(a_truss_snaps_through)
{
    double ended;
    const double limit = root(truss_slope, 0, rise, 0);
    const double most = truss_force(limit), below = 0.99 * most, load = 1.5 * most;
    assert_true(apex_error(below, 0.02, root(truss_force, below, rise, limit), &ended) <
                5e-6);
    assert_true(ended == 1);
    const double through = root(truss_force, load, 0, -RADIUS);
    const double coarse = apex_error(load, 0.02, through, &ended);
    assert_true(fabs(1.5 * ended - 1) < 1e-5);
    const double fine = apex_error(load, 0.005, through, &ended);
    assert_true(coarse < 1e-5 && fine < coarse / 4);
}

// Cycles under a load that grows slowly swing through, and come to rest in the same
// place.
TEST(cycles_snap_through_too)
{
    const double load = 1.5 * truss_force(root(truss_slope, 0, rise, 0));
    struct packing packing = truss();
    const uint8_t fixed[BARS + 1] = {1, 1, 1, 1, 0};
    const struct quasi_static_setup setup = truss_setup(&packing, fixed);
    struct vector force[BARS + 1] = {{0, 0, 0}}, still[BARS + 1];
    force[APEX].z = -load;
    grow_to_rest(&setup, force, 1000, still);
    const double through = root(truss_force, load, 0, -RADIUS);
    const double error = fabs(rise + still[APEX].z - through) / RADIUS;
    print_message("# cycles: %g radii off\n", error);
    assert_true(error < 1e-5);
    packing_free(&packing);
}

// ---- symmetry and conservation ------------------------------------------------------

static struct vector turned(struct vector a)
{
    const struct vector axis = {2. / 7, 3. / 7, 6. / 7};
    const double angle = 1;
    return add(scale(cos(angle), a), add(scale(sin(angle), cross(axis, a)),
                                         scale((1 - cos(angle)) * dot(axis, a), axis)));
}

static void find_block(const struct block *block, bool is_turned, double friction,
                       struct vector moved[BLOCK])
{
    struct quasi_static_setup setup = block_setup(&block->packing, block->fixed);
    setup.material.friction = friction;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[BLOCK];
    for (int step = 1; step <= 4; step++) {
        twist_block(force, step * 3e-7);
        for (int i = 0; i < BLOCK && is_turned; i++)
            force[i] = turned(force[i]);
        next_equilibrium(equilibrium, force);
    }
    assert_true(largest_turn(equilibrium) > 0.2);
    int count, last;
    assert_int_equal(quasi_static_unconverged(equilibrium, &last), 0);
    free(quasi_static_contacts(equilibrium, &count));
    quasi_static_displacements(equilibrium, moved);
    quasi_static_free(equilibrium);
}

TEST(a_turned_scene_gives_the_same)
{
    for (int k = 0; k < 2; k++) {
        const double friction = 0.3 * k;
        struct block *block = new_block();
        struct vector moved[BLOCK], expected[BLOCK];
        find_block(block, false, friction, expected);
        for (int i = 0; i < BLOCK; i++) {
            expected[i] = turned(expected[i]);
            block->packing.position[i] = turned(block->packing.position[i]);
        }
        find_block(block, true, friction, moved);
        print_message("# turned by 1 rad, friction %g: %g apart\n", friction,
                      apart(moved, expected));
        assert_true(apart(moved, expected) < 1e-9);
        free_block(block);
    }
}

static double stored(const struct quasi_static *equilibrium)
{
    double energy = 0;
    for (int j = 0; j < equilibrium->n_pair; j++)
        for (int k = 0; k < COMPONENTS; k++)
            energy +=
                0.5 * equilibrium->response[j].load[k] * equilibrium->deformation[j][k];
    return energy * equilibrium->stiffness * pow(equilibrium->length, 2);
}

// By how much the work of a load that grows in STEPS differs from what is stored, which
// is given: F u(1) less the integral of F u, by Simpson's rule.
static double work_not_stored(int steps, double *energy)
{
    struct block *block = new_block();
    struct quasi_static_setup setup =
        row_setup(&block->packing, block->fixed); // bonds alone are smooth
    setup.increment = 0.1;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector full[BLOCK], force[BLOCK], moved[BLOCK];
    twist_block(full, 1.2e-6);
    double work = 0;
    for (int step = 1; step <= steps; step++) {
        for (int i = 0; i < BLOCK; i++)
            force[i] = scale((double)step / steps, full[i]);
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, moved);
        const double weight = step == steps ? 1 - 1. / 3 / steps
                              : step % 2    ? -4. / 3 / steps
                                            : -2. / 3 / steps;
        for (int i = 0; i < BLOCK; i++)
            work += weight * dot(full[i], moved[i]);
    }
    *energy = stored(equilibrium);
    print_message("# %d steps, turned by %g: stored %.9g J, work %g of it more\n",
                  steps, largest_turn(equilibrium), *energy, work / *energy - 1);
    quasi_static_free(equilibrium);
    free_block(block);
    return work - *energy;
}

// The midpoint rule's error falls with the square of the increments, to nothing.
TEST(work_is_stored)
{
    double energy;
    const double coarse = work_not_stored(32, &energy);
    const double fine = work_not_stored(64, &energy);
    print_message("# extrapolated: %g\n", (4 * fine - coarse) / 3 / energy);
    assert_true(fabs(4 * fine - coarse) / 3 < 1e-8 * energy);
    assert_true(fabs(fine) < fabs(coarse) / 3.5);
}
