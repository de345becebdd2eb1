// SPDX-License-Identifier: GPL-3.0-or-later
// The patches of a grain's surface that face its throats, in a cubic cell.
#include "basics/memory.h"
#include "force_scene.h"

#include <string.h>

// By symmetry a cube's twelve patches are alike; each points at its throat, and the
// arcs around one add up to arccos(1/sqrt 3). Of the cube's faces a throat has a
// quarter of each of two.
TEST(cube_has_twelve_equal_patches)
{
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
TEST(patches_close_around_any_cell)
{
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
TEST(patches_do_not_depend_on_scale)
{
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
TEST(patches_close_around_an_engulfed_grain)
{
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
TEST(patches_close_around_a_grain_in_its_face)
{
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

// ---- what is refused ----------------------------------------------------------------

static void is_refused(struct network *network, const char *why)
{
    struct sectors sectors;
    struct reason reason;
    assert_int_equal(sectors_find(network, &sectors, &reason), STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, why));
    sectors_free(&sectors);
    network_free(network);
}

TEST(broken_cells_are_refused)
{
    struct network network = lattice_network(2, 2, 2, 1);
    network.n_throat--; // between nodes 6 and 7
    is_refused(&network, "no throat between nodes 6 and 7");
    network = two_cells();
    network.face_particles[network.n_face - 1][1] = -6; // one grain is open there
    is_refused(&network, "is open at throat");
}
