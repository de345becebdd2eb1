// SPDX-License-Identifier: GPL-3.0-or-later
// Slip in equilibrium (dem-replay, engine=quasi-static) against closed forms: a grain
// sheared to and fro, a row drawn through what holds it by friction, a block on a
// slope.
#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "quasi_static/contact_pair.h"

static const double stiffness = 3e4; // N/m, of a grain: half of it at a contact
static const double overlap = 1e-6;  // of the radius
static const double friction = 0.5;
static const double glue = 40; // N/m of a bond, along and across
static const double radius_fraction = 0.5858;

static struct quasi_static *make(const struct packing *packing, const uint8_t *fixed,
                                 bool has_wall, double strength)
{
    const double per_area = glue / (M_PI * pow(radius_fraction * RADIUS, 2));
    const struct quasi_static_setup setup = {
        .packing = packing,
        .fixed = fixed,
        .has_wall = has_wall,
        .material = {.normal_stiffness = stiffness,
                     .shear_stiffness = stiffness,
                     .friction = friction},
        .bond = {.normal_stiffness = per_area,
                 .shear_stiffness = per_area,
                 .normal_strength = strength,
                 .shear_strength = strength,
                 .radius_fraction = radius_fraction},
        .tolerance = 1e-10,
        .most_iterations = 40};
    return make_equilibrium(&setup);
}

static void find(struct quasi_static *equilibrium, const struct vector *force,
                 struct vector *moved)
{
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
}

// Rows of three along x, the outer ones held and pressed on the middle one; LENGTH of
// them along y. Bonds between those that KEEP says.
static struct packing pressed_rows(int length, uint8_t *fixed,
                                   bool (*keep)(const int32_t pair[2]))
{
    struct packing packing = cubic_lattice(3, length, 1, false);
    int kept = 0;
    for (int i = 0; i < packing.n_particle; i++) {
        fixed[i] = i % 3 != 1;
        packing.position[i].x += (1 - i % 3) * overlap * RADIUS;
    }
    for (int b = 0; b < packing.n_bond; b++)
        if (keep(packing.bond[b]))
            memcpy(packing.bond[kept++], packing.bond[b], sizeof packing.bond[b]);
    packing.n_bond = kept;
    return packing;
}

static bool across(const int32_t pair[2])
{
    return pair[0] / 3 == pair[1] / 3;
}

static bool along(const int32_t pair[2])
{
    return pair[0] % 3 == 1 && pair[1] % 3 == 1;
}

static double grip(void) // N that both contacts of a grain hold
{
    return 2 * friction * stiffness / 2 * overlap * RADIUS;
}

// A grain between two, bonded to them, under a load across that comes and goes: a
// spring beside one that slides. Its two springs, as its shear spring's end, follow the
// load; to and fro, any way across, in steps of any size.
TEST(a_loop_of_hysteresis)
{
    uint8_t fixed[3];
    struct packing packing = pressed_rows(1, fixed, across);
    struct quasi_static *equilibrium = make(&packing, fixed, false, INFINITY);
    const double course[] = {0.5, 0.9, 1.7, 3, 2.2, 1, -0.3, -1.1, -3, -1, 0, 2, 3};
    const struct vector way = {0, 0.6, -0.8};
    const double stuck = stiffness, bonds = 2 * glue; // both contacts, both bonds
    double slid = 0;                                  // where the springs are free, m
    for (size_t k = 0; k < sizeof course / sizeof *course; k++) {
        const double load = course[k] * grip();
        double expected = (load + stuck * slid) / (stuck + bonds);
        if (fabs(stuck * (expected - slid)) > grip()) {
            const double pull = copysign(grip(), expected - slid);
            expected = (load - pull) / bonds;
            slid = expected - pull / stuck;
        }
        struct vector moved[3], force[3] = {{0, 0, 0}};
        force[1] = scale(load, way);
        find(equilibrium, force, moved);
        assert_true(norm(subtract(moved[1], scale(expected, way))) <
                    1e-9 * 2 * grip() / bonds);
    }
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// A grain bonded over gaps to held ones on both sides and pushed over a gap against a
// third, with a load across: the contact that closes carries next to nothing across
// under this load, nor as it lasts (nothing where rest is found at once, not by a way
// in time as here). What it grows by goes through both bonds, and through the contact
// as far as their twist lets the grain turn. docs/equilibrium.md says so.
TEST(a_contact_that_closes)
{
    const uint8_t fixed[4] = {1, 0, 1, 1};
    struct packing packing = new_packing(4, 2);
    const double gap = 1e-3 * RADIUS, aside = 2.01 * RADIUS, contact = stiffness / 2;
    packing.position[0].x = -aside;
    packing.position[2].x = aside;
    packing.position[3].z = 2 * RADIUS + gap;
    packing.bond[0][1] = packing.bond[1][0] = 1;
    packing.bond[1][1] = 2;
    packing.lower = (struct vector){-aside, -aside, -aside};
    packing.upper = (struct vector){aside, aside, aside};
    struct quasi_static *equilibrium = make(&packing, fixed, false, INFINITY);
    const double pushed = 4 * glue * gap, load = 1e-3 * pushed, course[] = {1, 1, 1.1};
    const double lever = contact / (glue * pow(radius_fraction, 2));
    double first = 0;
    for (int k = 0; k < 3; k++) {
        struct vector moved[4], force[4] = {{0, 0, 0}};
        force[1] = (struct vector){0, course[k] * load, pushed};
        find(equilibrium, force, moved);
        const double more = (course[k] - 1) * load / (2 * glue + contact / (1 + lever));
        if (k == 0) first = moved[1].y;
        assert_close(moved[1].z, (pushed + contact * gap) / (2 * glue + contact), 1e-9);
        assert_close(first, load / (2 * glue), 0.01); // 0.85 of it if it stuck
        assert_within(moved[1].y - first, more, 1e-9 * first + 0.005 * more);
    }
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

enum { ROW = 12 };

// Moves of a row under PULL at its end of which the last SLID slide: each is held by
// twice a contact's spring or, sliding, by GRIP; bonds between them.
static void row_that_slides(double pull, int slid, double move[ROW])
{
    double diagonal[ROW], right[ROW] = {0};
    right[ROW - 1] = pull;
    for (int i = 0; i < ROW; i++) {
        diagonal[i] = (i > 0 ? glue : 0) + (i < ROW - 1 ? glue : 0);
        if (i < ROW - slid)
            diagonal[i] += stiffness;
        else
            right[i] -= grip();
    }
    for (int i = 1; i < ROW; i++) {
        const double share = -glue / diagonal[i - 1];
        diagonal[i] += share * glue;
        right[i] -= share * right[i - 1];
    }
    for (int i = ROW - 1; i >= 0; i--)
        move[i] = (right[i] + (i < ROW - 1 ? glue * move[i + 1] : 0)) / diagonal[i];
}

// Drawn at its end a row slides from there on, as far as what has not slid yet holds:
// the front is where the elastic rest carries just what a grain's contacts can.
TEST(a_front_of_slip)
{
    uint8_t fixed[3 * ROW];
    struct packing packing = pressed_rows(ROW, fixed, along);
    struct quasi_static *equilibrium = make(&packing, fixed, false, INFINITY);
    int slid = 0;
    for (double pull = 0.7; pull < ROW - 1; pull += 0.7) {
        double expected[ROW];
        struct vector moved[3 * ROW], force[3 * ROW] = {{0, 0, 0}};
        row_that_slides(pull * grip(), slid, expected);
        while (stiffness * expected[ROW - 1 - slid] > grip())
            row_that_slides(pull * grip(), ++slid, expected);
        force[3 * (ROW - 1) + 1].y = pull * grip();
        find(equilibrium, force, moved);
        for (int i = 0; i < ROW; i++)
            assert_true(fabs(moved[3 * i + 1].y - expected[i]) <
                        1e-8 * expected[ROW - 1]);
    }
    assert_true(slid > ROW / 2);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// A block of bonded grains on the wall holds on a slope less steep than its friction,
// however its weight is borne, and finds no rest on a steeper one.
TEST(a_block_on_a_slope)
{
    enum { N = 18 };
    struct packing packing = cubic_lattice(3, 3, 2, false);
    const uint8_t fixed[N] = {0};
    const double weight = 1e-8;
    for (int steep = 0; steep < 2; steep++) {
        const double slope = (steep ? 1.02 : 0.98) * friction;
        struct quasi_static *equilibrium = make(&packing, fixed, true, INFINITY);
        struct vector force[N], moved[N];
        int last;
        for (int part = 1; part <= 4; part++) {
            for (int i = 0; i < N; i++)
                force[i] = (struct vector){0.25 * part * slope * weight, 0, -weight};
            find(equilibrium, force, moved);
        }
        assert_int_equal(quasi_static_unconverged(equilibrium, &last), steep);
        quasi_static_free(equilibrium);
    }
    packing_free(&packing);
}

// Where its bonds break as it slides, a load is without rest once, not once a bond.
TEST(a_load_is_without_rest_once)
{
    enum { N = 18, LOADS = 3 };
    struct packing packing = cubic_lattice(3, 3, 2, false);
    const uint8_t fixed[N] = {0};
    struct quasi_static *equilibrium = make(&packing, fixed, true, 1e-3);
    struct vector force[N], moved[N];
    int last, cracks;
    for (int i = 0; i < N; i++)
        force[i] = (struct vector){1.5 * friction * 1e-8, 0, -1e-8};
    for (int load = 1; load <= LOADS; load++) {
        find(equilibrium, force, moved);
        assert_true(quasi_static_unconverged(equilibrium, &last) <= load);
    }
    quasi_static_cracks(equilibrium, &cracks);
    assert_true(quasi_static_unconverged(equilibrium, &last) > 0 && cracks > 1);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

enum { SIDE = 3, HIGH = 4, BLOCK = SIDE * SIDE * HIGH };

// Grains numbered from the other end, so joints in the other order, move alike where
// contacts slip and grains part.
TEST(any_order_of_joints)
{
    struct packing straight = cubic_lattice(SIDE, SIDE, HIGH, false);
    struct packing reversed = cubic_lattice(SIDE, SIDE, HIGH, false);
    uint8_t fixed[2][BLOCK];
    for (int i = 0; i < BLOCK; i++) {
        fixed[0][i] = fixed[1][BLOCK - 1 - i] = i < SIDE * SIDE;
        reversed.position[BLOCK - 1 - i] = straight.position[i];
    }
    for (int b = 0; b < straight.n_bond; b++)
        for (int end = 0; end < 2; end++)
            reversed.bond[straight.n_bond - 1 - b][end] =
                BLOCK - 1 - straight.bond[b][1 - end];
    struct quasi_static *one = make(&straight, fixed[0], false, INFINITY);
    struct quasi_static *other = make(&reversed, fixed[1], false, INFINITY);
    for (int step = 1; step <= 8; step++) {
        struct vector force[2][BLOCK], moved[2][BLOCK];
        double apart = 0, size = 0;
        for (int i = 0; i < BLOCK; i++) {
            const int x = i % SIDE - 1, y = i / SIDE % SIDE - 1;
            const double f = step * 1e-9 * (1 + 0.1 * ((i * 7) % 5));
            force[0][i] = force[1][BLOCK - 1 - i] =
                (struct vector){-f * x + 0.3 * f, -0.7 * f * y, -0.2 * f};
        }
        find(one, force[0], moved[0]);
        find(other, force[1], moved[1]);
        for (int i = 0; i < BLOCK; i++) {
            apart = fmax(apart, distance(moved[0][i], moved[1][BLOCK - 1 - i]));
            size = fmax(size, norm(moved[0][i]));
        }
        assert_true(apart < 1e-8 * size);
    }
    quasi_static_free(one);
    quasi_static_free(other);
    packing_free(&straight);
    packing_free(&reversed);
}

// Judged by a thousandth of its springs a contact does what it does, where they pulled
// so before: a solution is the same. One that was open slides, the way its spring lies,
// where it does so by itself.
TEST(slip_that_is_judged_softly)
{
    struct contact_pair pair = {
        .normal_stiffness = 1,
        .shear_stiffness = 0.8,
        .friction = friction,
        .contact = {.state = CONTACT_STICKING, .anchor = {0.1, -0.2}}};
    enum contact_state seen[4] = {0};
    for (int k = 0; k < 12; k++) {
        const double deformation[COMPONENTS] = {0.1 - 0.2 * (k % 4), 0.04 * k,
                                                -0.05 * (k / 2)};
        const struct pair_response whole = pair_respond(&pair, deformation);
        struct augmented_state augmented = {
            .stiffness_ratio = 1e-3,
            .shear_force = {whole.load[1], whole.load[2]},
            .overlap = fmax(0, -deformation[NORMAL])};
        const struct pair_response soft =
            pair_respond_augmented(&pair, deformation, &augmented);
        assert_int_equal(soft.contact.state, whole.contact.state);
        for (int l = 0; l < 3; l++)
            assert_true(fabs(soft.load[l] - whole.load[l]) <= 1e-12);
        seen[whole.contact.state]++;
    }
    assert_true(seen[CONTACT_OPEN] && seen[CONTACT_STICKING] && seen[CONTACT_SLIPPING]);
    const double pressed[COMPONENTS] = {-1, 0.1 + 0.6, -0.2 + 0.8};
    assert_int_equal(pair_respond(&pair, pressed).contact.state, CONTACT_SLIPPING);
    const struct augmented_state opened = {.stiffness_ratio = 0.01};
    const struct pair_response soft = pair_respond_augmented(&pair, pressed, &opened);
    assert_int_equal(soft.contact.state, CONTACT_SLIPPING);
    assert_true(fabs(soft.load[1] - 0.6 * friction) <= 1e-12);
    assert_true(fabs(soft.load[2] - 0.8 * friction) <= 1e-12);
}
