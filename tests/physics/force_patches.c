// SPDX-License-Identifier: GPL-3.0-or-later
// The patches of a grain's surface that face its throats, in a cubic cell.
#include "../test.h"
#include "basics/memory.h"
#include "force-protocol/balance.h"
#include "force-protocol/patches.h"
#include "support_lattice.h"

#include <stdlib.h>
#include <string.h>

// Sums of the absolute errors of what should vanish.
static double size(struct vector a)
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

static struct vector sum_of(const struct patches *patches, int grain)
{
    struct vector sum = {0};
    for (int k = patches->begin[grain]; k < patches->begin[grain + 1]; k++)
        sum = add(sum, patches->patch[k].pull);
    return sum;
}

static struct patches patches_of(const struct network *network, enum form form)
{
    struct wedges wedges;
    struct reason reason;
    assert_int_equal(wedges_find(network, &wedges, &reason), STATUS_OK);
    struct patches patches = find_patches(&wedges, form);
    assert_int_equal(check_patches(&patches, &reason), STATUS_OK);
    wedges_free(&wedges);
    return patches;
}

// By symmetry a cube's twelve patches are alike; each points at its throat, and the
// arcs around one add up to arccos(1/sqrt 3). Of the cube's faces a throat has a
// quarter of each of two.
static void cube_has_twelve_equal_patches(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, 1); // R = 1/2
    const double length[] = {[FORM_SOLID_ANGLE] = acos(1 / sqrt(3)) / 4,
                             [FORM_FACES] = sqrt(2) / 4,
                             [FORM_CENTRES] = 0.25};
    for (enum form form = FORM_SOLID_ANGLE; form <= FORM_CENTRES; form++) {
        struct patches patches = patches_of(&network, form);
        assert_int_equal(patches.n, 12);
        assert_true(size(sum_of(&patches, 0)) < 1e-14 / 4);
        for (int k = 0; k < patches.n; k++) {
            const int32_t *ends = network.throat_nodes[patches.patch[k].throat];
            const struct vector middle =
                scale(0.5, add(network.node_position[ends[0]],
                               network.node_position[ends[1]]));
            const struct vector towards = subtract(middle, network.packing.position[0]);
            const struct vector pull = patches.patch[k].pull;
            assert_true(fabs(norm(pull) - length[form]) < 1e-15);
            assert_true(size(cross(pull, towards)) < 1e-15);
            assert_true(dot(pull, towards) > 0);
        }
        patches_free(&patches);
    }
    network_free(&network);
}

static void move_nodes(struct network *network, uint64_t *seed)
{
    for (int i = 0; i < network->n_node; i++)
        for (int axis = 0; axis < 3; axis++)
            set_component(&network->node_position[i], axis,
                          component(network->node_position[i], axis) +
                              0.3 * (next_random(seed) - 0.5));
}

// Nodes moved at random, faces no longer flat: the patches still close around the
// grain.
static void patches_close_around_any_cell(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int trial = 0; trial < 100; trial++) {
        struct network network = lattice_network(2, 2, 2, 1);
        move_nodes(&network, &seed);
        for (enum form form = FORM_SOLID_ANGLE; form <= FORM_FACES; form++) {
            struct patches patches = patches_of(&network, form);
            assert_true(size(sum_of(&patches, 0)) < 1e-14 / 4);
            patches_free(&patches);
        }
        network_free(&network);
    }
}

// The same cell seen in nanometres and in kilometres, by powers of two: the same bits.
static void patches_do_not_depend_on_scale(void **state)
{
    (void)state;
    struct network small = lattice_network(2, 2, 2, 0x1p-30);
    struct network large = lattice_network(2, 2, 2, 0x1p10);
    for (enum form form = FORM_SOLID_ANGLE; form <= FORM_CENTRES; form++) {
        struct patches of_small = patches_of(&small, form);
        struct patches of_large = patches_of(&large, form);
        assert_int_equal(of_small.n, of_large.n);
        for (int k = 0; k < of_small.n; k++)
            assert_true(size(subtract(scale(0x1p80, of_small.patch[k].pull),
                                      of_large.patch[k].pull)) == 0);
        patches_free(&of_small);
        patches_free(&of_large);
    }
    network_free(&small);
    network_free(&large);
}

static void add_face(struct network *network, int first, int second,
                     const int32_t loop[4])
{
    const int64_t end = network->face_offset[network->n_face];
    const size_t n = (size_t)network->n_face + 1;
    network->face_nodes =
        reallocate(network->face_nodes, (size_t)end + 4, sizeof *network->face_nodes);
    memcpy(network->face_nodes + end, loop, 4 * sizeof *loop);
    network->face_offset =
        reallocate(network->face_offset, n + 1, sizeof *network->face_offset);
    network->face_offset[n] = end + 4;
    network->face_particles =
        reallocate(network->face_particles, n, sizeof *network->face_particles);
    network->face_particles[n - 1][0] = first;
    network->face_particles[n - 1][1] = second;
    network->n_face++;
}

// Two cubes, one above the other, and the face between them.
static struct network two_cells(void)
{
    struct network network = lattice_network(2, 2, 3, 1);
    add_face(&network, 0, 1, (int32_t[]){4, 5, 7, 6});
    return network;
}

// A power cell need not hold its own grain: engulfed by a large neighbour, the grain
// lies beyond the face between them. Its patches still close around it, as do the
// neighbour's.
static void patches_close_around_an_engulfed_grain(void **state)
{
    (void)state;
    struct network network = two_cells();
    struct packing *packing = &network.packing;
    packing->position[0] = (struct vector){0.5, 0.5, 1.05}; // just above its cell
    packing->position[1] = (struct vector){0.5, 0.5, 1.3};
    packing->radius[0] = 0.1;
    packing->radius[1] = sqrt(0.01 + 0.25 * 0.25 + 2 * 0.25 * 0.05); // plane at z = 1
    for (enum form form = FORM_SOLID_ANGLE; form <= FORM_FACES; form++) {
        struct patches patches = patches_of(&network, form);
        assert_true(size(sum_of(&patches, 0)) < 1e-14);
        assert_true(size(sum_of(&patches, 1)) < 1e-14);
        patches_free(&patches);
    }
    network_free(&network);
}

// With its centre in the face itself, there is no direction to the foot, and none is
// needed.
static void patches_close_around_a_grain_in_its_face(void **state)
{
    (void)state;
    struct network network = two_cells();
    network.packing.position[0].z = 1;
    network.packing.position[1].z = 1.5;
    network.packing.radius[0] = 0.25;
    network.packing.radius[1] = sqrt(0.0625 + 0.25);
    struct patches patches = patches_of(&network, FORM_SOLID_ANGLE);
    assert_true(size(sum_of(&patches, 0)) < 1e-14);
    patches_free(&patches);
    network_free(&network);
}

// ---- cells left out
// -------------------------------------------------------------------

// A cube among six grains whose cells were left out: twelve throats, six faces. Turned
// by ANGLE around a slanting axis. Unequal grains, each face where powers are equal.
static struct vector rotated(struct vector a, double angle)
{
    const struct vector axis = scale(1 / sqrt(14), (struct vector){1, 2, 3});
    return add(add(scale(cos(angle), a), scale(sin(angle), cross(axis, a))),
               scale((1 - cos(angle)) * dot(axis, a), axis));
}

static struct network cell_among_six(double angle)
{
    struct network network = lattice_network(2, 2, 2, 1);
    struct packing *packing = &network.packing;
    const struct vector middle = packing->position[0];
    packing->n_particle = 7;
    packing->position = reallocate(packing->position, 7, sizeof *packing->position);
    packing->radius = reallocate(packing->radius, 7, sizeof *packing->radius);
    packing->radius[0] = 0.4;
    for (int f = 0; f < network.n_face; f++) {
        const int wall = -1 - network.face_particles[f][1];
        const double apart = 1.1 + 0.1 * wall;
        struct vector away = {0};
        set_component(&away, wall / 2, wall % 2 ? apart : -apart);
        packing->position[1 + wall] = add(middle, away);
        // power at 1/2 from the first: (1/2)^2 - r0^2 = (apart - 1/2)^2 - r^2
        packing->radius[1 + wall] = sqrt((apart - 0.5) * (apart - 0.5) - 0.25 + 0.16);
        network.face_particles[f][1] = 1 + wall;
    }
    for (int i = 0; i < 7; i++)
        packing->position[i] = rotated(packing->position[i], angle);
    for (int i = 0; i < network.n_node; i++) {
        network.node_position[i] = rotated(network.node_position[i], angle);
        network.node_walls[i] = 0;
    }
    return network;
}

static void a_throat_is_felt_by_all_grains_around_it(void **state)
{
    (void)state;
    struct network network = cell_among_six(0);
    struct patches patches = patches_of(&network, FORM_FACES);
    assert_int_equal(patches.n, 36);
    assert_true(size(sum_of(&patches, 0)) < 1e-15);
    for (int k = 0; k < patches.n; k++)
        assert_true(norm(patches.patch[k].pull) > 0.1);
    patches_free(&patches);
    network_free(&network);
}

// Each throat alone leaves grains as a whole at rest: forces and moments.
static void check_pairs(const struct network *network, const struct patches *patches)
{
    for (int t = 0; t < network->n_throat; t++) {
        struct vector force = {0}, moment = {0};
        for (int k = 0; k < patches->n; k++) {
            const struct patch *patch = &patches->patch[k];
            if (patch->throat != t) continue;
            force = add(force, patch->pull);
            moment = add(
                moment, cross(network->packing.position[patch->particle], patch->pull));
        }
        assert_true(size(force) < 1e-15);
        assert_true(size(moment) < 2e-15);
    }
}

static void pairs_are_in_balance(void **state)
{
    (void)state;
    struct network network = cell_among_six(0.7);
    struct patches patches = patches_of(&network, FORM_FACES);
    check_pairs(&network, &patches);
    patches_free(&patches);
    network_free(&network);
}

static struct patches balanced_patches_of(const struct network *network, enum form form)
{
    struct wedges wedges;
    struct patches patches;
    struct reason reason;
    double change;
    assert_int_equal(wedges_find(network, &wedges, &reason), STATUS_OK);
    assert_int_equal(find_balanced_patches(&wedges, form, &patches, &change, &reason),
                     STATUS_OK);
    assert_true(form == FORM_FACES ? change < 1e-15 : change > 0.01 && change < 1);
    wedges_free(&wedges);
    return patches;
}

static double product(const struct patches *a, const struct patches *b)
{
    assert_int_equal(a->n, b->n);
    double sum = 0;
    for (int k = 0; k < a->n; k++)
        sum += dot(a->patch[k].pull, b->patch[k].pull);
    return sum;
}

// What balance changes is orthogonal to all pulls in balance, so nothing nearer to the
// form is one. Unequal grains, one closed cell.
static void balance_changes_as_little_as_it_takes(void **state)
{
    (void)state;
    struct network network = cell_among_six(0.7);
    struct patches form[3], balanced[3];
    for (enum form f = FORM_SOLID_ANGLE; f <= FORM_CENTRES; f++) {
        form[f] = patches_of(&network, f);
        balanced[f] = balanced_patches_of(&network, f);
        check_pairs(&network, &balanced[f]);
        if (f != FORM_CENTRES) assert_true(size(sum_of(&balanced[f], 0)) < 1e-15);
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            assert_true(fabs(product(&balanced[b], &form[a]) -
                             product(&balanced[b], &balanced[a])) < 1e-14);
    for (int f = 0; f < 3; f++) {
        patches_free(&form[f]);
        patches_free(&balanced[f]);
    }
    network_free(&network);
}

// The contact line in full: unit vectors around the throat, over the arc in each
// grain's cell, by the trapezoidal rule.
static void check_contact_line(const struct network *network,
                               const struct patches *lines, int grain, int throat)
{
    const int n = 20000;
    const int32_t *ends = network->throat_nodes[throat];
    const struct vector from = network->node_position[ends[0]];
    const struct vector along = subtract(network->node_position[ends[1]], from);
    const struct vector centre = network->packing.position[grain];
    struct vector across = subtract(from, centre);
    across = subtract(across, scale(dot(across, along) / dot(along, along), along));
    const struct vector u = scale(1 / norm(across), across);
    const struct vector v = scale(1 / norm(along), cross(along, u));
    struct vector sum = {0};
    for (int k = 0; k < n; k++) { // the quarter around the direction to the grain
        const double a = M_PI / 4 * ((2 * k + 1.0) / n - 1);
        const struct vector inwards = add(scale(cos(a), u), scale(sin(a), v));
        sum = add(sum, scale(M_PI / 2 / n, inwards));
    }
    for (int k = lines->begin[grain]; k < lines->begin[grain + 1]; k++)
        if (lines->patch[k].throat == throat)
            assert_true(size(subtract(lines->patch[k].pull, sum)) < 1e-8);
}

static void contact_lines_pull_in_pairs(void **state)
{
    (void)state;
    struct network network = cell_among_six(0.3);
    struct wedges wedges;
    struct reason reason;
    assert_int_equal(wedges_find(&network, &wedges, &reason), STATUS_OK);
    struct patches lines = find_contact_lines(&wedges);
    assert_int_equal(lines.n, 36);
    for (int t = 0; t < network.n_throat; t++)
        check_contact_line(&network, &lines, 0, t);
    patches_free(&lines);
    wedges_free(&wedges);
    network_free(&network);
}

// Turning the scene turns the pulls.
static void pulls_turn_with_the_scene(void **state)
{
    (void)state;
    struct network straight = cell_among_six(0), slanting = cell_among_six(1.1);
    for (enum form form = FORM_SOLID_ANGLE; form <= FORM_CENTRES; form++) {
        struct patches one = patches_of(&straight, form);
        struct patches other = patches_of(&slanting, form);
        assert_int_equal(one.n, other.n);
        for (int k = 0; k < one.n; k++)
            assert_true(size(subtract(rotated(one.patch[k].pull, 1.1),
                                      other.patch[k].pull)) < 1e-14);
        patches_free(&one);
        patches_free(&other);
    }
    network_free(&straight);
    network_free(&slanting);
}

// Suction on the patches and the pull of the menisci that end the liquid of one throat
// are what FORM_FACES has: in the plane through two grains and an end of the throat the
// liquid has an opening, the triangle between them less the sectors of the grains. All
// openings of a throat, and its patches, close around its liquid.
static struct vector openings(const struct network *network, int throat, int a, int b)
{
    const struct vector *centre = network->packing.position;
    struct vector sum = {0};
    for (int end = 0; end < 2; end++) {
        const struct vector node =
            network->node_position[network->throat_nodes[throat][end]];
        const struct vector side[3] = {centre[a], centre[b], node};
        struct vector area =
            scale(0.5, cross(subtract(side[1], side[0]), subtract(side[2], side[0])));
        const double open = norm(area);
        double sectors = 0;
        for (int k = 0; k < 2; k++) {
            const struct vector to = subtract(side[!k], side[k]);
            const struct vector up = subtract(side[2], side[k]);
            const double radius = network->packing.radius[k ? b : a];
            sectors += 0.5 * radius * radius * atan2(norm(cross(to, up)), dot(to, up));
        }
        // towards the other end, from where liquid pulls the meniscus
        const struct vector other =
            network->node_position[network->throat_nodes[throat][!end]];
        if (dot(area, subtract(other, node)) < 0) area = scale(-1, area);
        sum = add(sum, scale((open - sectors) / open, area));
    }
    return sum;
}

static void patches_and_menisci_are_in_balance(void **state)
{
    (void)state;
    struct network network = cell_among_six(0.4);
    struct patches patches = patches_of(&network, FORM_SOLID_ANGLE);
    for (int t = 0; t < network.n_throat; t++) {
        struct vector sum = {0};
        int around[3], n = 0;
        for (int k = 0; k < patches.n; k++) {
            if (patches.patch[k].throat != t) continue;
            sum = add(sum, patches.patch[k].pull);
            assert_true(n < 3);
            around[n++] = patches.patch[k].particle;
        }
        assert_int_equal(n, 3);
        for (int k = 0; k < 3; k++)
            sum = add(sum, openings(&network, t, around[k], around[(k + 1) % 3]));
        assert_true(size(sum) < 1e-14);
    }
    patches_free(&patches);
    network_free(&network);
}

// ---- what is refused
// ------------------------------------------------------------------

static void is_refused(struct network *network, const char *why)
{
    struct wedges wedges;
    struct reason reason;
    assert_int_equal(wedges_find(network, &wedges, &reason), STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, why));
    wedges_free(&wedges);
    network_free(network);
}

static void broken_cells_are_refused(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, 1);
    network.n_throat--; // between nodes 6 and 7
    is_refused(&network, "no throat between nodes 6 and 7");
    network = two_cells();
    network.face_particles[network.n_face - 1][1] = -6; // one grain is open there
    is_refused(&network, "is open at throat");
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_has_twelve_equal_patches),
        cmocka_unit_test(patches_close_around_any_cell),
        cmocka_unit_test(patches_do_not_depend_on_scale),
        cmocka_unit_test(patches_close_around_an_engulfed_grain),
        cmocka_unit_test(patches_close_around_a_grain_in_its_face),
        cmocka_unit_test(a_throat_is_felt_by_all_grains_around_it),
        cmocka_unit_test(pairs_are_in_balance),
        cmocka_unit_test(balance_changes_as_little_as_it_takes),
        cmocka_unit_test(contact_lines_pull_in_pairs),
        cmocka_unit_test(pulls_turn_with_the_scene),
        cmocka_unit_test(patches_and_menisci_are_in_balance),
        cmocka_unit_test(broken_cells_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
