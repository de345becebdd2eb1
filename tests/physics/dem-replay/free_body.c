// SPDX-License-Identifier: GPL-3.0-or-later
// A body that nothing holds, under forces that keep their directions: its net load is
// taken off, and it shrinks without moving or turning as one.
#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "../support_irregular.h"
#include "geometry/net_load.h"
#include "load_in_memory.h"

enum { SIDE = 4, N = SIDE * SIDE * SIDE };

static double total_of(const struct vector *force, int n)
{
    double total = 0;
    for (int i = 0; i < n; i++)
        total += norm(force[i]);
    return total;
}

static struct vector place_of(const struct packing *packing, const struct vector *moved,
                              int i)
{
    const struct vector from = subtract(packing->position[i], packing->lower);
    return moved ? add(from, moved[i]) : from;
}

// Force, and moment about the lower corner, of grains that have MOVED (NULL: not).
static struct net_load net_of(const struct packing *packing, const struct vector *moved,
                              const struct vector *force)
{
    struct net_load net = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        net.force = add(net.force, force[i]);
        net.moment = add(net.moment, cross(place_of(packing, moved, i), force[i]));
    }
    return net;
}

// Any forces, on grains of many sizes and anywhere: nothing is left of force or moment,
// and what was taken off is what there was.
TEST(nothing_is_left)
{
    for (int far = 0; far < 2; far++) {
        struct packing packing = irregular_packing(SIDE, RADIUS, false);
        const struct vector away = scale(far * 1e3 * RADIUS, (struct vector){1, -2, 3});
        packing.lower = add(packing.lower, away);
        packing.upper = add(packing.upper, away);
        for (int i = 0; i < N; i++)
            packing.position[i] = add(packing.position[i], away);
        struct vector *force = random_vectors(N, 1e-9, 3);
        const double total = total_of(force, N);
        const struct net_load before = net_of(&packing, NULL, force);
        const struct net_load off = take_off_net_load(&packing, NULL, NULL, force);
        const struct net_load after = net_of(&packing, NULL, force);
        assert_true(norm(before.force) > 1e-3 * total);
        assert_true(distance(off.force, before.force) < 1e-14 * total);
        assert_true(distance(off.moment, before.moment) < 1e-13 * total * RADIUS);
        assert_true(norm(after.force) < 1e-14 * total);
        assert_true(norm(after.moment) < 1e-13 * total * RADIUS * SIDE);
        free(force);
        packing_free(&packing);
    }
}

// Of grains on their way what is left of force and moment takes all momentum in the
// time there is, linear and angular, about where they are now; not that of one that is
// gone.
TEST(what_is_left_stops_them)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    struct vector *force = random_vectors(N, 1e-9, 3);
    struct vector *moved = random_vectors(N, RADIUS, 4);
    struct vector *velocity = random_vectors(N, 1, 5);
    struct vector *spin = random_vectors(N, 1 / RADIUS, 6);
    const struct moving_grains now = {moved, velocity, spin, 3230, 1e-6};
    const bool is_gone[N] = {[7] = true};
    for (int i = 0; i < N; i++)
        velocity[i].x += 2;
    const double total = total_of(force, N);
    const struct net_load before = net_of(&packing, moved, force);
    const struct net_load off = take_off_net_load(&packing, is_gone, &now, force);
    assert_true(distance(off.force, before.force) < 1e-14 * total);
    assert_true(distance(off.moment, before.moment) < 1e-13 * total * RADIUS);
    struct net_load left = net_of(&packing, moved, force);
    double pushes = 0;
    for (int i = 0; i < N; i++) {
        if (is_gone[i]) continue;
        const double r = packing.radius[i], mass = 3230 * 4. / 3 * M_PI * r * r * r;
        const struct vector push = scale(mass / now.time, velocity[i]);
        const struct vector turn = scale(0.4 * mass * r * r / now.time, spin[i]);
        left.force = add(left.force, push);
        left.moment = add(left.moment, cross(place_of(&packing, moved, i), push));
        left.moment = add(left.moment, turn);
        pushes += norm(push);
    }
    assert_true(norm(left.force) < 1e-14 * pushes);
    assert_true(norm(left.moment) < 1e-13 * pushes * RADIUS * SIDE);
    free(spin);
    free(velocity);
    free(moved);
    free(force);
    packing_free(&packing);
}

// Grains in a line have no inertia about it; across it, they turn.
TEST(a_row_turns_across_itself_only)
{
    struct packing packing = cubic_lattice(5, 1, 1, false);
    struct vector force[5] = {
        {0, 1e-9, 0}, {3e-9, 0, 0}, {0, 0, 0}, {0, 0, 2e-9}, {0, 0, 0}};
    take_off_net_load(&packing, NULL, NULL, force);
    const struct net_load left = net_of(&packing, NULL, force);
    assert_true(norm(left.force) < 1e-23 && norm(left.moment) < 1e-22 * RADIUS);
    packing_free(&packing);
}

TEST(of_nobody_nothing_is_taken)
{
    struct packing packing = cubic_lattice(2, 1, 1, false);
    const bool is_gone[2] = {true, true};
    struct vector force[2] = {{1e-9, 0, 0}, {0, 0, 0}};
    take_off_net_load(&packing, is_gone, NULL, force);
    assert_true(force[0].x == 1e-9 && norm(force[1]) == 0);
    packing_free(&packing);
}

// Of a box that repeats only what moves all grains one way is taken off, and what turns
// them about the one axis along which it repeats: the same wherever the box begins.
TEST(a_box_that_repeats_does_not_turn)
{
    for (int axes = 1; axes <= 2; axes++) {
        struct packing packing = irregular_packing(SIDE, RADIUS, true);
        packing.periodic[1] = axes == 2;
        struct vector *force = random_vectors(N, 1e-9, 4);
        struct vector *other = duplicate(force, N, sizeof *force);
        take_off_net_load(&packing, NULL, NULL, force);
        const double edge = packing.upper.x - packing.lower.x;
        for (int i = 0; i < N; i++) {
            double *x = &packing.position[i].x;
            *x += *x > 0.4 * edge ? -0.4 * edge : 0.6 * edge;
        }
        take_off_net_load(&packing, NULL, NULL, other);
        const double total = total_of(force, N);
        for (int i = 0; i < N; i++)
            assert_true(distance(force[i], other[i]) < 1e-13 * total);
        const double about_x = net_of(&packing, NULL, force).moment.x;
        assert_int_equal(fabs(about_x) < 1e-13 * total * RADIUS, axes == 1);
        free(force);
        free(other);
        packing_free(&packing);
    }
}

// ---- a body that shrinks ------------------------------------------------------------

static struct replay_settings settings_of(enum engine engine, enum support support)
{
    static uint8_t nothing_held[N];
    static const double full = 1;
    return (struct replay_settings){
        .material = {.density = 3230,
                     .normal_stiffness = 3e4,
                     .shear_stiffness = 3e4,
                     .damping_ratio = 0.7},
        .bond = {8e16, 8e16, INFINITY, INFINITY, 0.5858, DEM_PARALLEL_BOND},
        .held = nothing_held,
        .support = support,
        .engine = engine,
        .equilibrium_tolerance = 1e-10,
        .most_iterations = 40,
        .time_step_safety = 0.036,
        .cycles = 160000,
        .tolerance = NAN,
        .n_snapshot = 1,
        .snapshot = &full,
        .threads = 1};
}

// Displacements under FORCE in one step of the load; the caller frees them.
static struct vector *moved(const struct packing *packing, struct vector *force,
                            const struct replay_settings *settings)
{
    double none[1] = {0};
    const struct load load = {.n_time = 1,
                              .time = none,
                              .saturation = none,
                              .source = &(struct rows_in_memory){force, N},
                              .force = row_in_memory};
    struct response response = replay_or_fail(packing, &load, settings);
    struct vector *displacement =
        duplicate(response.snapshot[0].displacement, N, sizeof *displacement);
    response_free(&response);
    return displacement;
}

// Both engines shrink it alike: bonds stretch as much, whatever the body does as one.
// The load is net in force and moment, and would turn it over.
TEST(both_engines_shrink_it_alike)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    struct vector *force = shrinking_load(&packing, 1e-13);
    const struct replay_settings cycles = settings_of(ENGINE_EXPLICIT, SUPPORT_FREE);
    const struct replay_settings rest = settings_of(ENGINE_QUASI_STATIC, SUPPORT_FREE);
    struct vector *a = moved(&packing, force, &cycles);
    struct vector *b = moved(&packing, force, &rest);
    double largest = 0, off = 0;
    for (int k = 0; k < packing.n_bond; k++) {
        const int i = packing.bond[k][0], j = packing.bond[k][1];
        const struct vector along = subtract(packing.position[j], packing.position[i]);
        const double stretch = dot(along, subtract(a[j], a[i])) / norm(along);
        const double other = dot(along, subtract(b[j], b[i])) / norm(along);
        largest = fmax(largest, fabs(other));
        off = fmax(off, fabs(stretch - other));
    }
    if (!(off < 1e-6 * largest)) fail_msg("off by %g", off / largest);
    free(a);
    free(b);
    free(force);
    packing_free(&packing);
}

// The mean turn of a body of grains that moved by DISPLACEMENT, rad.
static double turn_of(const struct packing *packing, const struct vector *displacement)
{
    struct vector middle = {0, 0, 0}, sum = {0, 0, 0};
    double square = 0;
    for (int i = 0; i < N; i++)
        middle = add(middle, scale(1.0 / N, packing->position[i]));
    for (int i = 0; i < N; i++) {
        const struct vector r = subtract(packing->position[i], middle);
        sum = add(sum, cross(r, displacement[i]));
        square += dot(r, r) * 2 / 3;
    }
    return norm(sum) / square;
}

// Pressed from all sides by forces that keep their directions it is a pencil on its
// tip. A nudge turns it over if only the load at the start is made without a net one;
// what follows the grains keeps it as it is, for as long as one likes.
TEST(pressed_it_stays_as_it_is)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    struct vector *force = shrinking_load(&packing, 1e-7);
    struct replay_settings settings = settings_of(ENGINE_EXPLICIT, SUPPORT_FREE);
    struct vector *end = moved(&packing, force, &settings);
    const double held = turn_of(&packing, end);
    take_off_net_load(&packing, NULL, NULL, force);
    settings.support = SUPPORT_FIXED; // and no grain is
    struct vector *fell = moved(&packing, force, &settings);
    const double free_turn = turn_of(&packing, fell);
    if (!(held < 1e-4 && free_turn > 0.1))
        fail_msg("turned by %g, and without by %g", held, free_turn);
    free(end);
    free(fell);
    free(force);
    packing_free(&packing);
}
