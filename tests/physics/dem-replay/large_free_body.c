// SPDX-License-Identifier: GPL-3.0-or-later
// A body that nothing holds and whose grains move far (dem-replay, support=free,
// quasi_static.large_displacements): beside one held where that holds nothing, the
// Euler load of half a row, scenes turned and elsewhere, and cycles.
#include "../support_irregular.h"
#include "bent_row.h"
#include "geometry/net_load.h"
#include "quasi_static/large/large_state.h"

#include "basics/memory.h"

static const uint8_t nothing_held[BLOCK];

static struct quasi_static_setup free_setup(const struct packing *packing)
{
    struct quasi_static_setup setup = setup_of(packing, nothing_held);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 300;
    setup.large_displacements = setup.is_free = true;
    setup.increment = 0.02;
    return setup;
}

// From the middle of the block, radii.
static struct vector place_in(const struct packing *packing, int i)
{
    const struct vector middle = scale(0.5, add(packing->lower, packing->upper));
    return scale(1 / RADIUS, subtract(packing->position[i], middle));
}

// Pressed from all sides, twisted, and pulled away with a net force and moment.
static void load_free(const struct packing *packing, double size, struct vector *force)
{
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector r = place_in(packing, i);
        force[i] = (struct vector){size * (-r.x - 0.3 * r.y + 0.2),
                                   size * (0.2 * r.x - 0.7 * r.y + 0.1 * r.z),
                                   0.1 * size * (1 + (i * 7) % 5)};
    }
}

static struct vector *solve(const struct quasi_static_setup *setup,
                            const struct vector *force)
{
    struct quasi_static *equilibrium = make_equilibrium(setup);
    struct vector *moved = NEW_ARRAY(struct vector, setup->packing->n_particle);
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    quasi_static_free(equilibrium);
    return moved;
}

// By how much a bond along WAY gets longer, without differences of lengths.
static double longer(struct vector way, struct vector by, bool is_large)
{
    if (!is_large) return dot(way, by) / norm(way);
    return dot(by, add(add(way, way), by)) / (norm(add(way, by)) + norm(way));
}

// How far apart that is in MOVED and OTHER, of the most.
static double lengths_apart(const struct packing *packing, bool is_large,
                            const struct vector *moved, const struct vector *other)
{
    double most = 0, off = 0;
    for (int b = 0; b < packing->n_bond; b++) {
        const int i = packing->bond[b][0], j = packing->bond[b][1];
        const struct vector way = subtract(packing->position[j], packing->position[i]);
        const double one = longer(way, subtract(moved[j], moved[i]), is_large);
        const double two = longer(way, subtract(other[j], other[i]), is_large);
        most = fmax(most, fabs(one));
        off = fmax(off, fabs(one - two));
    }
    return off / most;
}

// ---- held or not --------------------------------------------------------------------

enum { CUBE = SIDE * SIDE * SIDE, CENTRE = CUBE / 2 };

// Symmetric to three planes, so that the grain in the middle stays and does not turn.
static void press_unevenly(const struct packing *packing, double size,
                           struct vector force[CUBE])
{
    for (int i = 0; i < CUBE; i++) {
        const struct vector r = place_in(packing, i);
        force[i] = (struct vector){size * r.x * (1 - 0.2 * r.y * r.y),
                                   0.6 * size * r.y * (1 - 0.1 * r.z * r.z),
                                   -0.3 * size * r.z * (1 - 0.15 * r.x * r.x)};
    }
}

TEST(held_or_not)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
    const uint8_t middle[CUBE] = {[CENTRE] = 1};
    for (int is_large = 0; is_large < 2; is_large++) {
        struct quasi_static_setup setup = free_setup(&packing), held = setup;
        held.is_free = false;
        held.fixed = middle;
        setup.large_displacements = held.large_displacements = is_large;
        struct vector force[CUBE];
        load_free(&packing, 1e-10, force);
        take_off_net_load(&packing, NULL, NULL, force);
        if (is_large) press_unevenly(&packing, 3e-6, force);
        struct vector *one = solve(&setup, force), *other = solve(&held, force);
        double most = 0, off = 0;
        for (int i = 0; i < CUBE; i++) {
            most = fmax(most, norm(other[i]));
            off = fmax(off, distance(one[i], other[i]));
        }
        const double stretched = lengths_apart(&packing, is_large, one, other);
        print_message("# moved by %g radii: lengths %g apart from held\n",
                      most / RADIUS, stretched);
        assert_true(stretched < 1e-9);
        assert_true(!is_large || off < 1e-8 * most);
        free(one);
        free(other);
    }
    packing_free(&packing);
}

// Forces in balance: what there is left to hold is nothing; displacements small or not.
TEST(a_little_as_small_displacements)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, HIGH, false);
    struct quasi_static_setup setup = free_setup(&packing);
    struct vector force[BLOCK];
    load_free(&packing, 1e-12, force);
    struct vector *large = solve(&setup, force);
    setup.large_displacements = false;
    struct vector *small = solve(&setup, force);
    const double off = lengths_apart(&packing, false, large, small);
    print_message("# large and small displacements: %g apart\n", off);
    assert_true(off < 1e-6);
    free(large);
    free(small);
    packing_free(&packing);
}

// ---- a row pushed at both ends ------------------------------------------------------

// Its middle stays, so that it buckles as half of it does that is held there.
TEST(a_row_buckles_as_its_half)
{
    enum { WHOLE = 2 * HINGES + 1 };
    struct packing packing = cubic_lattice(WHOLE, 1, 1, false);
    struct quasi_static_setup setup = free_setup(&packing);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 0;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector push[WHOLE] = {{0, 0, 0}}, moved[WHOLE];
    push[0].x = 2 * buckling_load();
    push[WHOLE - 1].x = -push[0].x;
    next_equilibrium(equilibrium, push);
    int last;
    assert_int_equal(quasi_static_instabilities(equilibrium, &last), 1);
    quasi_static_displacements(equilibrium, moved);
    const struct row half = buckled_row(push[0].x);
    const struct vector end = end_of(&half);
    const double load = 2 * equilibrium->large->fraction_at_instability;
    double most = 0;
    for (int at = 0; at <= WHOLE - 1; at += WHOLE - 1) {
        const struct vector way = subtract(moved[at], moved[HINGES]);
        const double across = sqrt(way.y * way.y + way.z * way.z);
        most = fmax(most, hypot(fabs(way.x) - fabs(end.x), across - fabs(end.y)));
    }
    print_message("# free row: %.9f of the Euler load of half, ends %g radii off\n",
                  load, most / RADIUS);
    assert_true(fabs(load - 1) < 1e-5);
    assert_true(most < 5e-5 * RADIUS);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// ---- symmetry -----------------------------------------------------------------------

// The load comes in two steps, with friction, and goes again without.
static struct vector *come_and_go(const struct packing *packing, double friction,
                                  const struct vector *force, struct vector *back)
{
    struct quasi_static_setup setup = free_setup(packing);
    setup.material.friction = friction;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector *moved = NEW_ARRAY(struct vector, BLOCK), part[BLOCK];
    for (int step = 1; step <= 2; step++) {
        for (int i = 0; i < BLOCK; i++)
            part[i] = scale(0.5 * step, force[i]);
        next_equilibrium(equilibrium, part);
    }
    quasi_static_displacements(equilibrium, moved);
    const struct net_load off = quasi_static_load(equilibrium, part);
    struct vector net = {0, 0, 0}, moment = {0, 0, 0};
    double total = 0;
    for (int i = 0; i < BLOCK; i++) {
        net = add(net, part[i]);
        moment = add(moment, cross(add(packing->position[i], moved[i]), part[i]));
        total += norm(part[i]);
    }
    assert_true(friction == 0 || norm(off.force) > 0.01 * total);
    assert_true(norm(net) < 1e-14 * total && norm(moment) < 1e-13 * total * RADIUS);
    for (int i = 0; i < BLOCK; i++)
        part[i] = (struct vector){0, 0, 0};
    next_equilibrium(equilibrium, part);
    quasi_static_displacements(equilibrium, back);
    quasi_static_free(equilibrium);
    return moved;
}

static double largest(const struct vector *moved)
{
    double most = 0;
    for (int i = 0; i < BLOCK; i++)
        most = fmax(most, norm(moved[i]));
    return most;
}

TEST(a_scene_turned_and_elsewhere)
{
    const struct vector axis = {2, 3, 6}, away = {40 * RADIUS, -7 * RADIUS, 0};
    for (int k = 0; k < 2; k++) {
        struct packing packing = cubic_lattice(SIDE, SIDE, HIGH, false);
        struct vector force[BLOCK], back[BLOCK];
        load_free(&packing, 2e-6, force);
        if (!k) take_off_net_load(&packing, NULL, NULL, force);
        struct vector *expected = come_and_go(&packing, 0.3 * k, force, back);
        print_message("# friction %g: moved by %g radii, back to %g\n", 0.3 * k,
                      largest(expected) / RADIUS, largest(back) / RADIUS);
        assert_true(k || largest(back) < 2e-6 * largest(expected));
        struct packing there = turned_packing(&packing, axis, 1, NULL);
        for (int i = 0; i < BLOCK; i++) {
            there.position[i] = add(there.position[i], away);
            force[i] = turned(force[i], axis, 1);
            expected[i] = turned(expected[i], axis, 1);
        }
        there.lower = add(there.lower, away);
        there.upper = add(there.upper, away);
        struct vector *moved = come_and_go(&there, 0.3 * k, force, back);
        print_message("# turned by 1 rad: %g apart\n", apart(moved, expected));
        assert_true(apart(moved, expected) < 1e-8);
        free(expected);
        free(moved);
        packing_free(&packing);
        packing_free(&there);
    }
}

// ---- beside cycles ------------------------------------------------------------------

enum { EVERY = 16 };

// FORCE less what would move the grains as one, where they are and as they go.
static void take_off(const struct quasi_static_setup *setup, struct dem *dem,
                     const struct vector *full, double share)
{
    struct vector moved[BLOCK], velocity[BLOCK], spin[BLOCK], force[BLOCK];
    dem_displacements(dem, moved);
    dem_velocities(dem, velocity);
    dem_spins(dem, spin);
    for (int i = 0; i < BLOCK; i++)
        force[i] = scale(share, full[i]);
    const struct moving_grains now = {moved, velocity, spin, 3230,
                                      EVERY * dem_time_step(dem)};
    take_off_net_load(setup->packing, NULL, &now, force);
    dem_set_force(dem, force);
}

static void cycles_to_rest(const struct quasi_static_setup *setup,
                           const struct vector *full, struct vector still[BLOCK])
{
    const struct dem_setup slow = cycles_of(setup, 0.045);
    struct dem *dem;
    struct reason reason = {""};
    if (dem_create(&dem, &slow, &reason)) fail_msg("%s", reason.text);
    const int rising = 4000, most = 20000;
    for (int k = 0; k < most; k++) {
        take_off(setup, dem, full, fmin(1, (k + 1.) / rising));
        if (dem_run(dem, EVERY, &reason)) fail_msg("%s", reason.text);
    }
    dem_displacements(dem, still);
    dem_free(dem);
}

// As one, by masses, of grains that have moved: rad.
static struct vector mean_turn(const struct packing *packing,
                               const struct vector moved[BLOCK])
{
    const struct whole start = whole_of(packing, NULL, NULL);
    struct vector sum = {0, 0, 0};
    for (int i = 0; i < BLOCK; i++)
        sum = add(sum, scale(whole_mass(&start, i) / start.length,
                             cross(whole_place(&start, i), moved[i])));
    return whole_turn(&start, sum);
}

// Cycles have no angular momentum, and yet turn a little as a body changes its shape:
// as if forces turned the other way.
TEST(cycles_shrink_it_as_far)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, HIGH, false);
    struct quasi_static_setup setup = free_setup(&packing);
    setup.increment = 0.005;
    struct vector force[BLOCK], still[BLOCK];
    load_free(&packing, 1e-6, force);
    cycles_to_rest(&setup, force, still);
    struct vector *moved = solve(&setup, force);
    const struct vector turn =
        subtract(mean_turn(&packing, still), mean_turn(&packing, moved));
    const double off = lengths_apart(&packing, true, moved, still);
    print_message("# engines: lengths %g apart; cycles turn by %g rad\n", off,
                  norm(turn));
    free(moved);
    for (int i = 0; i < BLOCK; i++)
        force[i] = turned(force[i], turn, -norm(turn));
    moved = solve(&setup, force);
    const double still_off = lengths_apart(&packing, true, moved, still);
    print_message("# engines, forces turned: lengths %g apart\n", still_off);
    assert_true(norm(turn) < 1e-4 && off < 1e-4 && still_off < 2e-6);
    free(moved);
    packing_free(&packing);
}
