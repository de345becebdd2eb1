// SPDX-License-Identifier: GPL-3.0-or-later
// The finite-volume scheme of the boundary layer: K's areas on the cubic lattice [K
// 3.3.5], and no area lost or won where the surface is irregular.
#include "basics/memory.h"
#include "dry/boundary_layer.h"
#include "support_lattice.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include <cmocka.h>

static const double spacing = 5e-7;

static struct boundary_layer make(const struct network *network, int wall,
                                  double length)
{
    struct boundary_layer layer;
    struct reason reason = {""};
    const enum status status =
        boundary_layer_make(network, wall, length, 10.0, 0, &layer, &reason);
    if (status) fail_msg("%s", reason.text);
    return layer;
}

static double total_area(const struct boundary_layer *layer)
{
    double total = 0;
    for (int i = 0; i < layer->n_exposed; i++) {
        assert_true(layer->area[i] > 0);
        total += layer->area[i];
    }
    return total;
}

static int walls_at(const struct network *network, int node)
{
    return __builtin_popcount(network->node_walls[node]);
}

static void test_lattice_has_the_areas_of_the_paper(void **state)
{
    (void)state;
    struct network network = lattice_network(4, 5, 6, spacing);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        struct boundary_layer layer = make(&network, wall, spacing);
        assert_int_equal(layer.layers, 10);
        for (int i = 0; i < layer.n_exposed; i++) { // on 1, 2 or 3 walls
            const double area = ldexp(1, 1 - walls_at(&network, layer.exposed[i]));
            assert_true(fabs(layer.area[i] - area) < 1e-14);
        }
        for (int k = 0; k < layer.n_lateral; k++) {
            const int a = layer.exposed[layer.lateral[k][0]];
            const int b = layer.exposed[layer.lateral[k][1]];
            const int common = network.node_walls[a] & network.node_walls[b];
            const double conductance =
                __builtin_popcount((unsigned)common) == 1 ? 1 : 0.5;
            assert_true(fabs(layer.lateral_conductance[k] - conductance) < 1e-14);
        }
        const int n[3] = {4, 5, 6};
        const int m = n[(wall / 2 + 1) % 3], l = n[(wall / 2 + 2) % 3];
        assert_int_equal(layer.n_exposed, m * l);
        assert_int_equal(layer.n_lateral, m * (l - 1) + l * (m - 1));
        boundary_layer_free(&layer);
    }
    network_free(&network);
}

// Wall nodes shifted within the wall, so far that some feet lie outside their faces.
static void test_irregular_surface_keeps_the_area_of_the_wall(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct network network = lattice_network(6, 7, 3, spacing);
        uint64_t random = seed;
        for (int g = 0; g < network.packing.n_particle; g++) {
            network.packing.position[g].x += (next_random(&random) - 0.5) * spacing;
            network.packing.position[g].y += (next_random(&random) - 0.5) * spacing;
        }
        for (int i = 0; i < network.n_node; i++)
            for (int axis = 0; axis < 2; axis++)
                if (!(network.node_walls[i] & 3 << 2 * axis)) {
                    const double shift = 0.4 * (next_random(&random) - 0.5) * spacing;
                    struct vector *node = &network.node_position[i];
                    set_component(node, axis, component(*node, axis) + shift);
                }
        struct boundary_layer layer = make(&network, 5, spacing);
        assert_true(fabs(total_area(&layer) / 30 - 1) < 1e-13);
        boundary_layer_free(&layer);
        network_free(&network);
    }
}

// Where no throat reaches a node, what its faces give it goes to the others on them; a
// face with none gives to all.
static void test_area_of_nodes_that_are_not_exposed_is_shared(void **state)
{
    (void)state;
    struct network network = lattice_network(6, 6, 3, spacing);
    const int hidden[5] = {14, 15, 20, 21, 0}; // the middle square and a corner
    for (int t = 0; t < network.n_throat; t++)
        for (int end = 0; end < 2; end++)
            for (int k = 0; k < 5; k++)
                if (network.throat_nodes[t][end] == 72 + hidden[k])
                    network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    struct boundary_layer layer = make(&network, 5, spacing);
    assert_int_equal(layer.n_exposed, 31);
    assert_true(fabs(total_area(&layer) / 25 - 1) < 1e-14);
    // Node 7, inside the corner square, gets a third of the corner's quarter, a quarter
    // of each of two whole squares, a third of the one that has lost a node, and of the
    // square without exposed nodes its share.
    const double own = 0.25 + 0.25 / 3 + 0.5 + 0.25 + 0.25 / 3;
    for (int i = 0; i < layer.n_exposed; i++)
        if (layer.exposed[i] == 72 + 7)
            assert_true(fabs(layer.area[i] - own * 25 / 24) < 1e-13);
    boundary_layer_free(&layer);
    network_free(&network);
}

// Where the box repeats, faces that cross its end are whole.
static void test_periodic_faces_are_whole(void **state)
{
    (void)state;
    struct network network = lattice_network(5, 5, 3, spacing);
    struct boundary_layer before = make(&network, 4, spacing);
    const double width = 4 * spacing;
    for (int axis = 0; axis < 2; axis++)
        network.packing.periodic[axis] = 1;
    const int64_t n_corner = network.face_offset[network.n_face];
    network.face_node_image = NEW_ARRAY(struct image, n_corner);
    for (int64_t k = 0; k < n_corner; k++) { // as if the box began elsewhere
        const struct vector node = network.node_position[network.face_nodes[k]];
        network.face_node_image[k].along[0] = node.x > 2.2 * spacing;
        network.face_node_image[k].along[1] = node.y > 1.2 * spacing;
    }
    for (int i = 0; i < network.n_node; i++) {
        struct vector *node = &network.node_position[i];
        node->x -= node->x > 2.2 * spacing ? width : 0;
        node->y -= node->y > 1.2 * spacing ? width : 0;
    }
    struct boundary_layer after = make(&network, 4, spacing);
    assert_int_equal(before.n_lateral, after.n_lateral);
    for (int i = 0; i < before.n_exposed; i++)
        assert_true(fabs(before.area[i] - after.area[i]) < 1e-13);
    for (int k = 0; k < before.n_lateral; k++)
        assert_true(fabs(before.lateral_conductance[k] - after.lateral_conductance[k]) <
                    1e-13);
    boundary_layer_free(&before);
    boundary_layer_free(&after);
    network_free(&network);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lattice_has_the_areas_of_the_paper),
        cmocka_unit_test(test_irregular_surface_keeps_the_area_of_the_wall),
        cmocka_unit_test(test_area_of_nodes_that_are_not_exposed_is_shared),
        cmocka_unit_test(test_periodic_faces_are_whole)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
