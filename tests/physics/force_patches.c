// SPDX-License-Identifier: GPL-3.0-or-later
// The patches of a grain's surface that face its throats, in a cubic cell.
#include "basics/memory.h"
#include "force-protocol/patches.h"
#include "support_lattice.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
// after the four above
#include <cmocka.h>

// Sums of the absolute errors of what should vanish.
static double size(struct vector a)
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

static struct vector sum_of(const struct patch *patches, int count)
{
    struct vector sum = {0};
    for (int k = 0; k < count; k++)
        sum = add(sum, patches[k].normal);
    return sum;
}

static struct patch *patches_of(const struct network *network, int *count)
{
    struct patch *patches;
    struct reason reason;
    assert_int_equal(find_patches(network, &patches, count, &reason), STATUS_OK);
    return patches;
}

// By symmetry a cube's twelve patches are alike; each points at its throat, and the
// arcs around one add up to arccos(1/sqrt 3).
static void cube_has_twelve_equal_patches(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, 1);
    int count;
    struct patch *patches = patches_of(&network, &count);
    assert_int_equal(count, 12);
    assert_true(size(sum_of(patches, count)) < 1e-14);
    for (int k = 0; k < count; k++) {
        const int32_t *ends = network.throat_nodes[patches[k].throat];
        const struct vector middle = scale(
            0.5, add(network.node_position[ends[0]], network.node_position[ends[1]]));
        const struct vector towards = subtract(middle, network.packing.position[0]);
        assert_true(fabs(norm(patches[k].normal) - acos(1 / sqrt(3))) < 1e-15);
        assert_true(size(cross(patches[k].normal, towards)) < 1e-15);
        assert_true(dot(patches[k].normal, towards) > 0);
    }
    free(patches);
    network_free(&network);
}

// Nodes moved at random, faces no longer flat: the patches still close around the
// grain.
static void patches_close_around_any_cell(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int trial = 0; trial < 100; trial++) {
        struct network network = lattice_network(2, 2, 2, 1);
        for (int i = 0; i < network.n_node; i++)
            for (int axis = 0; axis < 3; axis++)
                set_component(&network.node_position[i], axis,
                              component(network.node_position[i], axis) +
                                  0.3 * (next_random(&seed) - 0.5));
        int count;
        struct patch *patches = patches_of(&network, &count);
        assert_true(size(sum_of(patches, count)) < 1e-14);
        free(patches);
        network_free(&network);
    }
}

// The same cell seen in nanometres and in kilometres, by powers of two: the same bits.
static void patches_do_not_depend_on_scale(void **state)
{
    (void)state;
    int count, again;
    struct network small = lattice_network(2, 2, 2, 0x1p-30);
    struct network large = lattice_network(2, 2, 2, 0x1p10);
    struct patch *of_small = patches_of(&small, &count);
    struct patch *of_large = patches_of(&large, &again);
    assert_int_equal(count, again);
    for (int k = 0; k < count; k++)
        assert_true(size(subtract(of_small[k].normal, of_large[k].normal)) == 0);
    free(of_small);
    free(of_large);
    network_free(&small);
    network_free(&large);
}

// A power cell need not hold its own grain: engulfed by a large neighbour, the grain
// lies beyond the face between them. Its patches still close around it.
static void patches_close_around_an_engulfed_grain(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, 1);
    struct packing *packing = &network.packing;
    packing->n_particle = 2;
    packing->position = reallocate(packing->position, 2, sizeof *packing->position);
    packing->radius = reallocate(packing->radius, 2, sizeof *packing->radius);
    packing->position[0] = (struct vector){0.5, 0.5, 1.05}; // just above its cell
    packing->position[1] = (struct vector){0.5, 0.5, 1.3};
    packing->radius[0] = 0.1;
    packing->radius[1] = sqrt(0.01 + 0.25 * 0.25 + 2 * 0.25 * 0.05); // plane at z = 1
    for (int face = 0; face < network.n_face; face++)
        if (network.face_particles[face][1] == -6) network.face_particles[face][1] = 1;
    int count;
    struct patch *patches = patches_of(&network, &count);
    struct vector sum = {0};
    for (int k = 0; k < count; k++)
        if (patches[k].particle == 0) sum = add(sum, patches[k].normal);
    assert_true(size(sum) < 1e-14);
    free(patches);
    network_free(&network);
}

static void a_loop_without_its_throat_is_refused(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, 1);
    network.n_throat--;
    struct patch *patches;
    int count;
    struct reason reason;
    assert_int_equal(find_patches(&network, &patches, &count, &reason),
                     STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, "no throat between nodes"));
    network_free(&network);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_has_twelve_equal_patches),
        cmocka_unit_test(patches_close_around_any_cell),
        cmocka_unit_test(patches_do_not_depend_on_scale),
        cmocka_unit_test(patches_close_around_an_engulfed_grain),
        cmocka_unit_test(a_loop_without_its_throat_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
