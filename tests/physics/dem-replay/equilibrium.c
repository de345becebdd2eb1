// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium itself (dem-replay, engine=quasi-static) against closed forms and against
// the discrete elements brought to rest.
#include "equilibrium_scene.h"

// A row of N held at the first: pulled it stretches by F/(k^n A) a bond; pushed,
// contacts help with k/2. Loaded across, the sums over its hinges are exact: each bends
// under the moment of what is beyond it and shears.
TEST(a_row_as_its_hinges_say)
{
    enum { N = 8 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    const uint8_t fixed[N] = {1};
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    struct vector force[N] = {{0, 0, 0}}, moved[N];
    const double f = 1e-10, glue = bond_stiffness * bond_area();

    struct quasi_static *equilibrium = make_equilibrium(&setup);
    force[N - 1] = (struct vector){f, 0, 0};
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    assert_true(fabs(moved[N - 1].x / ((N - 1) * f / glue) - 1) < 1e-9);
    force[N - 1] = (struct vector){-f, 0, 0};
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    const double together = glue + contact_stiffness / 2;
    assert_true(fabs(moved[N - 1].x / (-(N - 1) * f / together) - 1) < 1e-9);
    int count;
    struct dem_contact *contact = quasi_static_contacts(equilibrium, &count);
    assert_int_equal(count, N - 1);
    for (int c = 0; c < count; c++) {
        assert_true(contact[c].particle[0] == c && contact[c].particle[1] == c + 1);
        assert_close(contact[c].overlap, f / together, 1e-9);
        assert_close(contact[c].force.x, f, 1e-9);
        assert_close(contact[c].position.x, 2 * (c + 1) * RADIUS + moved[c].x, 1e-9);
    }
    free(contact);
    struct vector pulls[N], held, turning;
    quasi_static_load(equilibrium, pulls);
    for (int i = 0; i < N; i++)
        assert_true(distance(pulls[i], force[i]) <= 1e-15 * f);
    const struct vector about = {0, -RADIUS, 0};
    quasi_static_reaction(equilibrium, about, &held, &turning);
    assert_close(held.x, f, 1e-9);
    assert_close(turning.z, -2 * RADIUS * f, 1e-9);
    quasi_static_free(equilibrium);

    setup.material.normal_stiffness = setup.material.shear_stiffness = 0;
    equilibrium = make_equilibrium(&setup);
    force[N - 1] = (struct vector){0, f, 0};
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    const double bending = bond_stiffness * M_PI / 4 * pow(radius_fraction * RADIUS, 4);
    double expected = 0;
    for (int b = 0; b < N - 1; b++) {
        const double lever = (2 * (N - 1 - b) - 1) * RADIUS; // from hinge B to the end
        expected += f * lever * lever / bending + f / glue;
    }
    assert_true(fabs(moved[N - 1].y / expected - 1) < 1e-9);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// At loads so small that grains do not turn to speak of.
TEST(a_block_as_the_discrete_elements)
{
    struct block *block = new_block();
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK], still[BLOCK], moved[BLOCK];
    load_block(force, 1e-13);
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);

    const struct dem_setup slow = cycles_of(&block->setup, 0.04);
    struct dem *dem;
    struct reason reason = {""};
    if (dem_create(&dem, &slow, &reason)) fail_msg("%s", reason.text);
    dem_set_force(dem, force);
    if (dem_run_until(dem, 1e-9, 2000000, &reason)) fail_msg("%s", reason.text);
    dem_displacements(dem, still);
    assert_true(apart(still, moved) < 1e-6);
    dem_free(dem);
    quasi_static_free(equilibrium);
    free_block(block);
}

// Every grain feels no more than the tolerance; the contacts' forces on each, added up
// here, are the load.
TEST(forces_balance)
{
    struct block *block = new_block();
    block->setup.material.friction = 0.5;
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK], sum[BLOCK];
    for (int step = 1; step <= 3; step++) {
        load_block(force, step * 1e-9);
        next_equilibrium(equilibrium, force);
        memcpy(sum, force, sizeof sum);
        int count;
        struct dem_contact *contact = quasi_static_contacts(equilibrium, &count);
        for (int c = 0; c < count; c++) {
            const int32_t *pair = contact[c].particle;
            sum[pair[0]] = subtract(sum[pair[0]], contact[c].force);
            sum[pair[1]] = add(sum[pair[1]], contact[c].force);
        }
        free(contact);
        for (int i = 0; i < BLOCK; i++)
            if (!block->fixed[i]) assert_true(norm(sum[i]) <= 2e-10 * step * 1e-9);
    }
    quasi_static_free(equilibrium);
    free_block(block);
}

// What is left where one does not look for more: [K 4.20] from the forces of contacts.
TEST(the_unbalanced_ratio)
{
    struct block *block = new_block();
    block->setup.tolerance = 0.3;
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK];
    load_block(force, 1e-9);
    next_equilibrium(equilibrium, force);
    int count;
    struct dem_contact *contact = quasi_static_contacts(equilibrium, &count);
    double carried = 0, left = 0;
    for (int c = 0; c < count; c++) {
        const int32_t *pair = contact[c].particle;
        force[pair[0]] = subtract(force[pair[0]], contact[c].force);
        force[pair[1]] = add(force[pair[1]], contact[c].force);
        carried += norm(contact[c].force);
    }
    for (int i = 0; i < BLOCK; i++)
        if (!block->fixed[i]) left += norm(force[i]);
    const double wanted = left / (BLOCK - SIDE * SIDE) / (carried / count);
    assert_close(quasi_static_unbalanced_ratio(equilibrium), wanted, 1e-6);
    free(contact);
    quasi_static_free(equilibrium);
    free_block(block);
}

// What rounding leaves when the load is gone is not measured by what it leaves in
// joints.
TEST(nothing_is_settled)
{
    struct block *block = new_block();
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK];
    load_block(force, 1e-9);
    next_equilibrium(equilibrium, force);
    const double loaded = quasi_static_unbalanced_ratio(equilibrium);
    assert_true(loaded > 0 && loaded < 1e-8);
    load_block(force, 0);
    next_equilibrium(equilibrium, force);
    assert_true(quasi_static_unbalanced_ratio(equilibrium) == 0);
    quasi_static_free(equilibrium);
    free_block(block);
}

// Of bonds in a row the one at its strength breaks, and no other: what it held leaves.
TEST(one_bond_breaks)
{
    enum { N = 5 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    const uint8_t fixed[N] = {1};
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    const double f = 1e-9;
    setup.bond.normal_strength = f / bond_area();
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[N] = {{0, 0, 0}};
    force[N - 1] = (struct vector){(1 - 1e-6) * f, 0, 0};
    int cracks, first;
    next_equilibrium(equilibrium, force);
    quasi_static_cracks(equilibrium, &cracks);
    assert_int_equal(cracks, 0);
    force[N - 1].x = f; // exactly
    next_equilibrium(equilibrium, force);
    const struct dem_crack *crack = quasi_static_cracks(equilibrium, &cracks);
    assert_int_equal(cracks, 1);
    assert_int_equal(crack[0].mode, DEM_CRACK_NORMAL);
    assert_int_equal(quasi_static_detached(equilibrium, &first), N - 1 - crack[0].bond);
    force[N - 1].x = 100 * f; // on what has left
    next_equilibrium(equilibrium, force);
    quasi_static_cracks(equilibrium, &cracks);
    assert_int_equal(cracks, 1);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// A load that would bend a row by far more than is small breaks its bond with the held
// grain. The rest leaves from where it rested before, whichever end is numbered first.
TEST(what_breaks_off_has_not_moved_far)
{
    enum { N = 5 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    const double f = 1e-12, r = radius_fraction * RADIUS;
    for (int way = 0; way < 4; way++) {
        const int held = way % 2 * (N - 1), end = N - 1 - held;
        const uint8_t fixed[N] = {[0] = held == 0, [N - 1] = held != 0};
        struct quasi_static_setup setup = setup_of(&packing, fixed);
        setup.material.friction = way / 2 * 0.5;
        setup.bond.normal_strength = 100 * f * RADIUS * r / (M_PI_4 * pow(r, 4));
        struct quasi_static *equilibrium = make_equilibrium(&setup);
        struct vector force[N] = {{0, 0, 0}}, was[N], is[N];
        force[end].y = f;
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, was);
        assert_true(was[end].y > 0);
        force[end].y = 0.2 * RADIUS / was[end].y * f;
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, is);
        int n_crack, first;
        const struct dem_crack *crack = quasi_static_cracks(equilibrium, &n_crack);
        assert_int_equal(n_crack, 1);
        assert_int_equal(crack[0].bond, held == 0 ? 0 : N - 2);
        const int a = packing.bond[crack[0].bond][0];
        const double along = fabs(crack[0].position.x - packing.position[a].x);
        assert_close(along, RADIUS, 1e-3);
        assert_true(fabs(crack[0].position.y - packing.position[a].y) < 1e-3 * RADIUS);
        assert_int_equal(quasi_static_detached(equilibrium, &first), N - 1);
        assert_memory_equal(is, was, sizeof is);
        quasi_static_free(equilibrium);
    }
    packing_free(&packing);
}

// Without a load, or under a tiny one, overlaps that push are the scale: grains of many
// sizes in a block come to rest, and a row grows by o k / (k + 2 k^n A) at each overlap
// o.
TEST(overlaps_push_without_a_load)
{
    enum { N = 4 };
    const double overlap = 1e-5 * RADIUS, glue = bond_stiffness * bond_area();
    const struct vector none[BLOCK] = {{0, 0, 0}};
    struct block *block = new_block();
    for (int i = 0; i < BLOCK; i++)
        block->packing.radius[i] *= 1 + 1e-5 * (i * 7 % 5 + 1);
    struct vector tiny[BLOCK];
    load_block(tiny, 1e-10 * contact_stiffness * overlap);
    for (int way = 0; way < 8; way++) {
        block->setup.large_displacements = way % 2;
        block->setup.increment = 0.02;
        block->setup.material.friction = way / 2 % 2 * 0.5;
        struct quasi_static *equilibrium = make_equilibrium(&block->setup);
        next_equilibrium(equilibrium, way / 4 ? tiny : none);
        int last;
        assert_int_equal(quasi_static_unconverged(equilibrium, &last), 0);
        assert_int_equal(quasi_static_instabilities(equilibrium, &last), 0);
        assert_true(quasi_static_unbalanced_ratio(equilibrium) < 1e-9);
        quasi_static_free(equilibrium);
    }
    free_block(block);

    struct packing packing = cubic_lattice(N, 1, 1, false);
    for (int i = 0; i < N; i++)
        packing.position[i].x -= i * overlap;
    const uint8_t fixed[N] = {1};
    const struct quasi_static_setup setup = setup_of(&packing, fixed);
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector moved[N];
    next_equilibrium(equilibrium, none);
    quasi_static_displacements(equilibrium, moved);
    const double each = overlap * contact_stiffness / (contact_stiffness + 2 * glue);
    for (int i = 1; i < N; i++)
        assert_close(moved[i].x, i * each, 1e-8);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// A grain pressed on the wall sinks in by F/k, as a wall is rigid [K 4.22].
TEST(a_wall_is_rigid)
{
    struct packing packing = new_packing(1, 0);
    packing.position[0] = (struct vector){RADIUS, RADIUS, RADIUS};
    packing.upper = (struct vector){2 * RADIUS, 2 * RADIUS, 2 * RADIUS};
    const uint8_t fixed[1] = {0};
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    setup.has_wall = true;
    setup.material.friction = 0.5;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    const struct vector press = {0, 0, -1e-8};
    struct vector moved;
    next_equilibrium(equilibrium, &press);
    quasi_static_displacements(equilibrium, &moved);
    assert_true(fabs(moved.z * contact_stiffness / -1e-8 - 1) < 1e-9);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// Of FORCE on the first COUNT grains, and what held ones give them.
static struct vector net_force(const struct block *block,
                               const struct quasi_static *equilibrium,
                               const struct vector *force, int count)
{
    struct vector sum = {0, 0, 0};
    for (int i = 0; i < count; i++)
        if (!block->fixed[i]) sum = add(sum, force[i]);
    int n;
    struct dem_contact *contact = quasi_static_contacts(equilibrium, &n);
    for (int c = 0; c < n; c++) {
        const int32_t *pair = contact[c].particle;
        if (block->fixed[pair[0]] == block->fixed[pair[1]]) continue;
        const double sign = block->fixed[pair[0]] ? 1 : -1; // on the one that moves
        sum = add(sum, scale(sign, contact[c].force));
    }
    free(contact);
    return sum;
}

// What the grains carry to the held ones is the load at every step: with friction, slip
// and bonds that break.
TEST(the_whole_balances)
{
    struct block *block = new_block();
    block->setup.material.friction = 0.5;
    block->setup.tolerance = 1e-8;
    block->setup.bond.normal_strength = block->setup.bond.shear_strength = 1e5;
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK];
    int first, gone = 0;
    for (int step = 1; step <= 12; step++) {
        load_block(force, step * 1e-9);
        for (int i = 0; i < BLOCK; i++)
            force[i].z = i == BLOCK - 1 ? step * 1e-9 : 0;
        next_equilibrium(equilibrium, force);
        gone = quasi_static_detached(equilibrium, &first);
        const struct vector net = net_force(block, equilibrium, force, BLOCK - gone);
        assert_true(norm(net) <= 1e-10 * step * 1e-9);
    }
    assert_int_equal(gone, 1);
    assert_int_equal(first, BLOCK - 1); // the corner that was pulled out
    quasi_static_free(equilibrium);
    free_block(block);
}

// Turned by a quarter about the vertical, loads move grains the same way turned, slip
// and all: no direction of the joints' own is left in what comes out.
TEST(a_turned_block_answers_turned)
{
    struct block *block = new_block();
    block->setup.material.friction = 0.1;
    struct quasi_static *straight = make_equilibrium(&block->setup),
                        *turned = make_equilibrium(&block->setup);
    struct vector force[BLOCK], other[BLOCK], moved[BLOCK], answer[BLOCK], back[BLOCK];
    int target[BLOCK];
    for (int i = 0; i < BLOCK; i++) {
        const int x = i % SIDE, y = i / SIDE % SIDE, z = i / (SIDE * SIDE);
        target[i] = SIDE * SIDE * z + SIDE * x + (SIDE - 1 - y);
    }
    for (int step = 1; step <= 4; step++) {
        load_block(force, step * 1e-9);
        for (int i = 0; i < BLOCK; i++)
            other[target[i]] = (struct vector){-force[i].y, force[i].x, force[i].z};
        next_equilibrium(straight, force);
        next_equilibrium(turned, other);
    }
    quasi_static_displacements(straight, moved);
    quasi_static_displacements(turned, answer);
    for (int i = 0; i < BLOCK; i++) {
        const struct vector there = answer[target[i]];
        back[i] = (struct vector){there.y, -there.x, there.z};
    }
    assert_true(apart(back, moved) < 1e-9);
    quasi_static_free(straight);
    quasi_static_free(turned);
    free_block(block);
}

// Every bond far past its strength at once: those that hold break, all are counted, and
// what hung on them leaves, whole where nothing holds it back.
TEST(every_bond_breaks)
{
    struct block *block = new_block();
    block->setup.material.friction = 0.5;
    block->setup.bond.normal_strength = block->setup.bond.shear_strength = 1e-3;
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK];
    for (int i = 0; i < BLOCK; i++) // apart, all ways
        force[i] =
            scale(1e-4, subtract(block->packing.position[i], block->packing.lower));
    next_equilibrium(equilibrium, force);
    int cracks, first;
    quasi_static_cracks(equilibrium, &cracks);
    uint8_t *intact = NEW_ARRAY(uint8_t, block->packing.n_bond);
    quasi_static_bonds_intact(equilibrium, intact);
    int broken = 0;
    for (int b = 0; b < block->packing.n_bond; b++) {
        const bool hold = block->fixed[block->packing.bond[b][0]] !=
                          block->fixed[block->packing.bond[b][1]];
        assert_false(hold && intact[b]);
        broken += !intact[b];
    }
    assert_int_equal(cracks, broken);
    assert_int_equal(quasi_static_detached(equilibrium, &first), BLOCK - SIDE * SIDE);
    next_equilibrium(equilibrium, force); // nothing is left to move
    free(intact);
    quasi_static_free(equilibrium);
    free_block(block);
}

// Bonds from a millionth to a million times as stiff as contacts: the row is pushed
// together, sheared and let go.
TEST(stiffnesses_over_twelve_decades)
{
    enum { N = 6 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    const uint8_t fixed[N] = {1};
    for (int decade = -6; decade <= 6; decade++) {
        struct quasi_static_setup setup = setup_of(&packing, fixed);
        setup.tolerance = 1e-8;
        setup.material.friction = 0.5;
        const double glue = contact_stiffness / 2 * pow(10, decade);
        setup.bond.normal_stiffness = setup.bond.shear_stiffness = glue / bond_area();
        struct quasi_static *equilibrium = make_equilibrium(&setup);
        struct vector force[N] = {{0, 0, 0}}, moved[N];
        const double f = 1e-9 * fmin(1, pow(10, decade));
        force[N - 1] = (struct vector){-f, 0.01 * f, 0};
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, moved);
        const double together = glue + contact_stiffness / 2;
        assert_true(fabs(moved[N - 1].x / (-(N - 1) * f / together) - 1) < 1e-6);
        force[N - 1] = (struct vector){0, 0, 0};
        next_equilibrium(equilibrium, force);
        quasi_static_free(equilibrium);
    }
    packing_free(&packing);
}

// A block of them, with friction: at rest, and the whole in balance.
TEST(a_block_over_twelve_decades)
{
    for (int decade = -6; decade <= 6; decade++) {
        struct block *block = new_block();
        const double glue = contact_stiffness / 2 * pow(10, decade) / bond_area();
        block->setup.bond.normal_stiffness = block->setup.bond.shear_stiffness = glue;
        block->setup.material.friction = 0.5;
        block->setup.tolerance = 1e-8;
        struct quasi_static *equilibrium = make_equilibrium(&block->setup);
        struct vector force[BLOCK];
        for (int step = 1; step <= 4; step++) {
            load_block(force, step * 1e-9 * fmin(1, pow(10, decade)));
            next_equilibrium(equilibrium, force);
            const double left = norm(net_force(block, equilibrium, force, BLOCK));
            double load = 0;
            for (int i = 0; i < BLOCK; i++)
                load += norm(force[i]);
            int grain;
            if (quasi_static_unconverged(equilibrium, &grain) || !(left < 1e-10 * load))
                fail_msg("1e%d, step %d: %g of the load", decade, step, left / load);
        }
        quasi_static_free(equilibrium);
        free_block(block);
    }
}

// A chain without bonds, loaded across, holds nothing: it leaves, and the grain that is
// held stays. So does a grain that touches no other.
TEST(a_mechanism_leaves)
{
    enum { N = 5 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    packing.n_bond = 0;
    const uint8_t fixed[N] = {1};
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    setup.material.friction = 0.5;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[N] = {{0, 0, 0}};
    int first;
    next_equilibrium(equilibrium, force);
    assert_int_equal(quasi_static_detached(equilibrium, &first), 0);
    for (int i = 1; i < N; i++)
        force[i] = (struct vector){0, 1e-9, 0};
    next_equilibrium(equilibrium, force);
    assert_int_equal(quasi_static_detached(equilibrium, &first), N - 1);
    assert_int_equal(first, 1);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// Grains 2 and 3 beside grain 1 turn it about its bond with the held one by a couple of
// 4 f R; their own bonds bend under f R. Either breaks at M r / J or M r / I
// [K 4.41, 4.42].
TEST(twist_and_bending_break)
{
    struct packing packing = new_packing(4, 3);
    const struct vector place[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, -2, 0}};
    for (int i = 0; i < 4; i++)
        packing.position[i] = scale(RADIUS, place[i]);
    for (int b = 0; b < 3; b++) {
        packing.bond[b][0] = b > 0;
        packing.bond[b][1] = b + 1;
    }
    packing.lower = (struct vector){-RADIUS, -3 * RADIUS, -RADIUS};
    packing.upper = (struct vector){3 * RADIUS, 3 * RADIUS, RADIUS};
    const uint8_t fixed[4] = {1};
    const double f = 1e-12, r = radius_fraction * RADIUS;
    for (int mode = 0; mode < 2; mode++) {
        struct quasi_static_setup setup = setup_of(&packing, fixed);
        setup.bond.normal_strength = setup.bond.shear_strength = INFINITY;
        if (mode == DEM_CRACK_SHEAR)
            setup.bond.shear_strength = 4 * f * RADIUS * r / (M_PI_2 * pow(r, 4));
        else
            setup.bond.normal_strength = f * RADIUS * r / (M_PI_4 * pow(r, 4));
        for (int over = 0; over < 2; over++) {
            struct quasi_static *equilibrium = make_equilibrium(&setup);
            const double load = f * (1 + (over ? 1e-6 : -1e-6));
            const struct vector force[4] = {[2] = {0, 0, load}, [3] = {0, 0, -load}};
            next_equilibrium(equilibrium, force);
            int n_crack;
            const struct dem_crack *crack = quasi_static_cracks(equilibrium, &n_crack);
            assert_int_equal(n_crack > 0, over);
            if (over) assert_int_equal(crack[0].mode, mode);
            if (over) assert_int_equal(crack[0].bond > 0, mode == DEM_CRACK_NORMAL);
            quasi_static_free(equilibrium);
        }
    }
    packing_free(&packing);
}
