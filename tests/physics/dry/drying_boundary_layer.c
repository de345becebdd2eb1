// SPDX-License-Identifier: GPL-3.0-or-later
// The finite-volume scheme of the boundary layer: K's areas on the cubic lattice [K
// 3.3.5, Fig. 3.44], no area lost or won anywhere, and lateral diffusion over stripes
// that has a closed form.
#include "../../test.h"
#include "dry/gas/boundary_layer.h"
#include "dry/gas/nested_dissection_order.h"
#include "dry/gas/vapour.h"

#include "../support_lattice.h"
#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

#include <gsl/gsl_linalg.h>

static const double spacing = 5e-7;

static struct boundary_layer make(const struct network *network, int wall,
                                  const struct boundary_form *form)
{
    struct boundary_layer layer;
    struct reason reason = {""};
    const enum status status =
        boundary_layer_init(network, wall, spacing, 10.0, form, &layer, &reason);
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

TEST(lattice_has_the_areas_of_the_paper)
{
    struct network network = lattice_network(4, 5, 6, spacing);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        struct boundary_layer layer =
            make(&network, wall, &(struct boundary_form){.layers = 0});
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

// A vertical throat below each of N places (in spacings) on a face of SIZE by SIZE.
static struct network tubes(const double (*place)[2], int n, double size)
{
    struct network network = {.n_node = 2 * n, .n_throat = n};
    network.packing.upper = scale(spacing, (struct vector){size, size, 1});
    network.packing.periodic[0] = network.packing.periodic[1] = 1;
    network.node_position = NEW_ARRAY(struct vector, network.n_node);
    network.node_walls = NEW_ARRAY(uint8_t, network.n_node);
    network.throat_nodes = allocate((size_t)n, sizeof *network.throat_nodes);
    network.throat_radius = NEW_ARRAY(double, n);
    network.throat_length = NEW_ARRAY(double, n);
    network.throat_kind = NEW_ARRAY(uint8_t, n);
    network.face_offset = NEW_ARRAY(int64_t, 1);
    for (int i = 0; i < n; i++) {
        const struct vector top = {place[i][0], place[i][1], 1};
        network.node_position[2 * i] = scale(spacing, top);
        network.node_position[2 * i + 1] =
            scale(spacing, (struct vector){top.x, top.y, 0});
        network.node_walls[2 * i] = WALL_Z_UPPER;
        network.node_walls[2 * i + 1] = WALL_Z_LOWER;
        network.throat_nodes[i][0] = 2 * i;
        network.throat_nodes[i][1] = 2 * i + 1;
        network.throat_radius[i] = 0.2 * spacing;
        network.throat_length[i] = spacing;
    }
    return network;
}

enum { N_PLACE = 400 };

// Uneven: some places far apart, some NEAR of that, many in one line.
static struct network random_tubes(uint64_t seed, double size, double near)
{
    double place[N_PLACE][2];
    uint64_t random = seed;
    for (int i = 0; i < N_PLACE; i++) {
        const double apart = i % 7 ? size : near * size;
        place[i][0] = apart * next_random(&random);
        place[i][1] = i % 5 ? apart * next_random(&random) : 0.25 * size;
    }
    return tubes(place, N_PLACE, size);
}

TEST(areas_sum_to_the_face)
{
    for (uint64_t seed = 1; seed <= 20; seed++)
        for (int repeats = 0; repeats < 4; repeats++) {
            struct network network = random_tubes(seed, 20, 1e-7);
            network.packing.periodic[0] = (repeats & 1) != 0;
            network.packing.periodic[1] = (repeats & 2) != 0;
            // The face is what the network spans: let it be the box.
            network.node_position[0] = (struct vector){0, 0, spacing};
            network.node_position[2] = scale(spacing, (struct vector){20, 20, 1});
            struct boundary_layer layer =
                make(&network, 5, &(struct boundary_form){.layers = 1});
            assert_true(fabs(total_area(&layer) / 400 - 1) < 1e-12);
            boundary_layer_free(&layer);
            network_free(&network);
        }
}

// Sampled by brute force: what part of the face is nearest to each node.
TEST(areas_are_those_nearest)
{
    enum { SAMPLES = 200000 };
    const double size = 20;
    struct network network = random_tubes(3, size, 1e-7);
    struct boundary_layer layer =
        make(&network, 5, &(struct boundary_form){.layers = 1});
    double *count = NEW_ARRAY(double, layer.n_exposed);
    uint64_t random = 9;
    for (int s = 0; s < SAMPLES; s++) {
        const double x = size * next_random(&random), y = size * next_random(&random);
        double least = INFINITY;
        int nearest = 0;
        for (int i = 0; i < layer.n_exposed; i++) {
            const struct vector at = network.node_position[layer.exposed[i]];
            const double dx = remainder(at.x / spacing - x, size);
            const double dy = remainder(at.y / spacing - y, size);
            const double square = dx * dx + dy * dy;
            if (square < least) {
                least = square;
                nearest = i;
            }
        }
        count[nearest]++;
    }
    double chi2 = 0;
    int classes = 0;
    for (int i = 0; i < layer.n_exposed; i++) {
        const double expected = layer.area[i] / (size * size) * SAMPLES;
        if (expected < 10) continue;
        chi2 += (count[i] - expected) * (count[i] - expected) / expected;
        classes++;
    }
    assert_true(classes > 200);
    assert_true(fabs(chi2 - classes) < 5 * sqrt(2.0 * classes));
    free(count);
    boundary_layer_free(&layer);
    network_free(&network);
}

// A field linear along the face brings each inner column as much as it takes, and two
// fields linear in x and y drive sum(conductance dx^2) = volume of the level.
TEST(linear_fields_are_exact)
{
    const double size = 20;
    struct network network = random_tubes(5, size, 1e-2);
    struct boundary_layer layer =
        make(&network, 5, &(struct boundary_form){.layers = 1});
    struct balance {
        double x, y;
    } *net = allocate((size_t)layer.n_exposed, sizeof *net), energy = {0};
    for (int k = 0; k < layer.n_lateral; k++) {
        const double conductance = layer.lateral_conductance[k] / layer.spacing;
        struct vector at[2];
        for (int end = 0; end < 2; end++)
            at[end] = network.node_position[layer.exposed[layer.lateral[k][end]]];
        const double dx = remainder((at[1].x - at[0].x) / spacing, size);
        const double dy = remainder((at[1].y - at[0].y) / spacing, size);
        for (int end = 0; end < 2; end++) {
            struct balance *here = &net[layer.lateral[k][end]];
            here->x += (end ? -1 : 1) * conductance * dx;
            here->y += (end ? -1 : 1) * conductance * dy;
        }
        energy.x += conductance * dx * dx;
        energy.y += conductance * dy * dy;
    }
    for (int i = 0; i < layer.n_exposed; i++)
        assert_true(hypot(net[i].x, net[i].y) < 1e-11);
    assert_true(fabs(energy.x / (size * size) - 1) < 1e-12);
    assert_true(fabs(energy.y / (size * size) - 1) < 1e-12);
    free(net);
    boundary_layer_free(&layer);
    network_free(&network);
}

// Takes from the network the faces on WALL whose grains DROP marks.
static void drop_faces(struct network *network, int wall, const bool *drop)
{
    int n = 0;
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        if (side[1] == -1 - wall && drop[side[0]]) continue;
        for (int k = 0; k < 4; k++)
            network->face_nodes[4 * n + k] = network->face_nodes[4 * f + k];
        for (int k = 0; k < 2; k++)
            network->face_particles[n][k] = side[k];
        n++;
        network->face_offset[n] = 4 * n;
    }
    network->n_face = n;
}

// Where something is cut out, the open surface is what the wall's faces cover.
TEST(holes_have_no_area)
{
    for (int wall = 4; wall < 6; wall++) { // seen from inside and from outside
        struct network network = lattice_network(6, 6, 3, spacing);
        const int floor = wall == 4 ? 0 : 25; // 5 by 5 grains each
        bool drop[50] = {0};
        drop[floor + 12] = drop[floor + 4] = true; // the middle square and a corner
        drop_faces(&network, wall, drop);
        struct boundary_layer layer =
            make(&network, wall, &(struct boundary_form){.layers = 0});
        double total = 0;
        for (int i = 0; i < layer.n_exposed; i++)
            total += layer.area[i];
        assert_int_equal(layer.n_exposed, 35); // without the corner's own node
        assert_true(fabs(total - 23) < 1e-13);
        // About the middle square three quarters each, and half of each link.
        for (int k = 0; k < 4; k++)
            assert_true(fabs(layer.area[(int[]){13, 14, 19, 20}[k]] - 0.75) < 1e-14);
        for (int k = 0; k < layer.n_lateral; k++) {
            const int *link = layer.lateral[k];
            const bool beside = link[0] == 13 && (link[1] == 14 || link[1] == 19);
            if (beside) assert_true(fabs(layer.lateral_conductance[k] - 0.5) < 1e-14);
        }
        boundary_layer_free(&layer);
        network_free(&network);
    }
}

// Whether the square between x and x + 1, y and y + 1 of the upper wall is there.
static bool has_square(const bool *drop, int x, int y)
{
    return !drop[25 + (y + 5) % 5 * 5 + (x + 5) % 5];
}

// A node has a quarter of each square at it, a link half of each beside it.
static void check_squares(const struct boundary_layer *layer, const bool *drop)
{
    for (int i = 0; i < layer->n_exposed; i++) {
        const int x = (layer->exposed[i] - 72) % 6, y = (layer->exposed[i] - 72) / 6;
        double area = 0;
        for (int k = 0; k < 4; k++)
            area += has_square(drop, x - k % 2, y - k / 2) ? 0.25 : 0;
        assert_true(fabs(layer->area[i] - area) < 1e-14);
    }
    for (int k = 0; k < layer->n_lateral; k++) {
        const int a = layer->exposed[layer->lateral[k][0]] - 72;
        const int b = layer->exposed[layer->lateral[k][1]] - 72;
        const int x = abs(a % 6 - b % 6) == 1 ? a % 6 < b % 6 ? a % 6 : b % 6 : 4;
        const int y = abs(a / 6 - b / 6) == 1 ? a / 6 < b / 6 ? a / 6 : b / 6 : 4;
        const double width =
            a / 6 == b / 6
                ? (has_square(drop, x, a / 6) + has_square(drop, x, a / 6 - 1)) / 2.0
                : (has_square(drop, a % 6, y) + has_square(drop, a % 6 - 1, y)) / 2.0;
        assert_true(fabs(layer->lateral_width[k] - width) < 1e-14);
    }
}

// Holes narrower than half of the box and wider, and those that lead around it.
TEST(holes_in_a_face_that_repeats)
{
    for (int size = 0; size < 24; size++) {
        const int wide = size % 5 + 1, high = size / 5 + 1;
        struct network network = lattice_network(6, 6, 3, spacing);
        network.packing.periodic[0] = 1;
        network.packing.periodic[1] = 1;
        bool drop[50] = {0};
        for (int k = 0; k < wide * high; k++)
            drop[25 + (2 + k / wide) % 5 * 5 + (1 + k % wide) % 5] = true;
        drop_faces(&network, 5, drop);
        struct boundary_layer layer =
            make(&network, 5, &(struct boundary_form){.layers = 0});
        assert_true(fabs(total_area(&layer) - (25 - wide * high)) < 1e-13);
        check_squares(&layer, drop);
        boundary_layer_free(&layer);
        network_free(&network);
    }
}

// Nodes without liquid throats have no column, and their area goes to those nearest.
TEST(only_nodes_with_liquid_have_columns)
{
    struct network network = lattice_network(6, 6, 3, spacing);
    for (int t = 0; t < network.n_throat; t++)
        for (int end = 0; end < 2; end++)
            if (network.throat_nodes[t][end] == 72) // a corner of the upper wall
                network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    struct boundary_layer layer =
        make(&network, 5, &(struct boundary_form){.layers = 0});
    assert_int_equal(layer.n_exposed, 35);
    assert_true(fabs(total_area(&layer) / 25 - 1) < 1e-14);
    assert_int_equal(layer.exposed[0], 73); // beside it: half of its quarter more
    assert_true(fabs(layer.area[0] - 0.625) < 1e-14);
    boundary_layer_free(&layer);
    network_free(&network);
}

TEST(outermost_of_nodes_in_one_column)
{
    const double place[5][2] = {{1, 1}, {1, 3}, {3, 1}, {3, 3}, {3, 3}};
    struct network network = tubes(place, 5, 4);
    network.node_position[6].z -= 0.25 * spacing; // behind the fifth
    struct boundary_layer layer =
        make(&network, 5, &(struct boundary_form){.layers = 0});
    assert_int_equal(layer.n_exposed, 4);
    assert_int_equal(layer.exposed[3], 8);
    for (int i = 0; i < 4; i++)
        assert_true(fabs(layer.area[i] - 4) < 1e-13);
    boundary_layer_free(&layer);
    network_free(&network);
}

// Columns on those nodes of the surface where a throat of the boundary layer begins.
TEST(auxiliary_feet)
{
    struct network network = lattice_network(5, 5, 4, spacing);
    const struct boundary_form form = {.feet = FEET_AUXILIARY};
    struct boundary_layer layer;
    struct reason reason = {""};
    assert_int_equal(
        boundary_layer_init(&network, 5, spacing, 10, &form, &layer, &reason),
        STATUS_BAD_DATA);
    boundary_layer_free(&layer);
    for (int t = 0; t < network.n_throat; t++) { // what is above the third level
        const struct vector end = network.node_position[network.throat_nodes[t][1]];
        if (end.z > 2.5 * spacing) network.throat_kind[t] = THROAT_BOUNDARY_LAYER;
    }
    layer = make(&network, 5, &form);
    assert_int_equal(layer.n_exposed, 25);
    assert_true(fabs(total_area(&layer) / 16 - 1) < 1e-14);
    for (int i = 0; i < 25; i++)
        assert_int_equal(layer.exposed[i], 50 + i);
    boundary_layer_free(&layer);
    network_free(&network);
}

// ---- stripes ------------------------------------------------------------------------

// COLUMNS tubes side by side, half of them so narrow that they dry at once. Then vapour
// rises over stripes, one wet and one dry in each period of the box.
static struct network striped(int columns, double size)
{
    double(*place)[2] = allocate((size_t)columns, sizeof *place);
    for (int i = 0; i < columns; i++) {
        place[i][0] = (i + 0.5) * size / columns;
        place[i][1] = 0;
    }
    struct network network = tubes(place, columns, size);
    for (int i = columns / 2; i < columns; i++)
        network.throat_radius[i] = 1e-7 * spacing;
    free(place);
    return network;
}

// The rate over stripes, of that of a surface all wet, under a layer one period thick.
static double striped_rate(int columns, bool lumped)
{
    const double size = 1;
    struct network network = striped(columns, size);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    conditions.mass_transfer = conditions.diffusivity / (size * spacing);
    conditions.layers = columns;
    conditions.lumped = lumped;
    struct drying_history history = dry_and_check(&network, &conditions);
    int step = 0; // when the last narrow tube has dried
    for (int e = 0; e < columns / 2; e++)
        while (history.time[step] < history.event_time[e])
            step++;
    assert_true(history.saturation[step] > 0.999);
    const double rate = history.rate[step] / history.rate[0];
    drying_history_free(&history);
    network_free(&network);
    return rate;
}

// Far above stripes that are wet over the share f of each period P, the layer seems
// thicker by P/pi ln(1/sin(pi f/2)): Laplace's equation as in Philip (1972), whose
// layer has no end; at one period it is off by exp(-4 pi).
TEST(lateral_diffusion_over_stripes)
{
    const double expected = 1 / (1 + log(M_SQRT2) / M_PI);
    double before = 0, error_before = 0;
    for (int columns = 8; columns <= 64; columns *= 2) {
        const double rate = striped_rate(columns, false);
        const double error = fabs(rate / expected - 1);
        if (before > 0) {
            assert_in_range((int)(100 * error_before / error), 180, 220); // order 1
            assert_true(fabs((2 * rate - before) / expected - 1) < 0.1 * error);
        }
        before = rate;
        error_before = error;
    }
    assert_true(error_before < 5e-3);
}

TEST(lumped_transfer_knows_no_neighbours)
{
    assert_true(fabs(striped_rate(16, true) - 0.5) < 1e-12);
}

// ---- against one matrix of all nodes ------------------------------------------------

static int foot_is_wet(int i)
{
    return i % 3 == 0;
}

// The link that is part of MATRIX, or where one end (-1) is wet or the air (-2) of the
// right side.
static void add_link(gsl_matrix *matrix, gsl_vector *right, int a, int b,
                     double conductance)
{
    const int end[2] = {a, b};
    for (int k = 0; k < 2; k++) {
        if (end[k] < 0) continue;
        const size_t i = (size_t)end[k];
        *gsl_matrix_ptr(matrix, i, i) += conductance;
        if (end[1 - k] >= 0)
            *gsl_matrix_ptr(matrix, i, (size_t)end[1 - k]) -= conductance;
        if (end[1 - k] == -2) *gsl_vector_ptr(right, i) += conductance;
    }
}

// (n_exposed levels) The potential: 0 at wet feet, 1 in the air.
static gsl_vector *solve_at_once(const struct boundary_layer *layer)
{
    const int n = layer->n_exposed, levels = layer->layers;
    const size_t size = (size_t)(n * levels);
    gsl_matrix *matrix = gsl_matrix_calloc(size, size);
    gsl_vector *right = gsl_vector_calloc(size);
#define SITE(level, i) ((level) == 0 && foot_is_wet(i) ? -1 : (level)*n + (i))
    for (int level = 0; level < levels; level++) {
        for (int i = 0; i < n; i++)
            add_link(matrix, right, SITE(level, i),
                     level + 1 < levels ? SITE(level + 1, i) : -2,
                     layer->area[i] / layer->spacing);
        for (int k = 0; k < layer->n_lateral; k++) {
            const int *column = layer->lateral[k];
            add_link(matrix, right, SITE(level, column[0]), SITE(level, column[1]),
                     layer->lateral_conductance[k] * (level == 0 ? 0.5 : 1));
        }
    }
#undef SITE
    for (int i = 0; i < n; i++)
        if (foot_is_wet(i)) gsl_matrix_set(matrix, (size_t)i, (size_t)i, 1);
    gsl_linalg_cholesky_decomp1(matrix);
    gsl_linalg_cholesky_svx(matrix, right);
    gsl_matrix_free(matrix);
    return right;
}

// Wide layers are eliminated column by column, narrow ones level by level.
TEST(columns_and_levels_are_eliminated)
{
    for (int wide = 0; wide < 2; wide++) {
        struct network network = wide ? lattice_network(14, 15, 1, spacing)
                                      : lattice_network(3, 4, 1, spacing);
        struct boundary_layer layer =
            make(&network, 5, &(struct boundary_form){.layers = wide ? 4 : 20});
        struct vapour vapour = vapour_init(&network, spacing, 0, &layer, 0, 0);
        for (int i = 0; i < layer.n_exposed; i++)
            if (!foot_is_wet(i)) vapour_dry_node(&vapour, layer.exposed[i]);
        gsl_vector *potential = solve_at_once(&layer);
        double rate = 0;
        for (int i = 0; i < layer.n_exposed; i++) {
            const size_t below = (size_t)((layer.layers - 1) * layer.n_exposed + i);
            rate +=
                layer.area[i] / layer.spacing * (1 - gsl_vector_get(potential, below));
        }
        assert_true(fabs(vapour_rate(&vapour) / rate - 1) < 1e-12);
        gsl_vector_free(potential);
        vapour_free(&vapour);
        boundary_layer_free(&layer);
        network_free(&network);
    }
}

// The row of columns in the middle comes last, and without it two halves are left.
TEST(last_columns_part_the_others)
{
    enum { EDGE = 16, COLUMNS = EDGE * EDGE };
    struct network network = lattice_network(EDGE, EDGE, 1, spacing);
    struct boundary_layer layer = make(&network, 5, &(struct boundary_form){0});
    assert_int_equal(layer.n_exposed, COLUMNS);
    int *order = nested_dissection_order(&network, &layer);
    int place[COLUMNS], parent[COLUMNS];
    for (int i = 0; i < COLUMNS; i++) {
        place[i] = -1;
        parent[i] = i;
    }
    for (int k = 0; k < COLUMNS; k++) {
        assert_int_equal(place[order[k]], -1);
        place[order[k]] = k;
    }
    for (int k = 0; k < layer.n_lateral; k++) {
        const int a = layer.lateral[k][0], b = layer.lateral[k][1];
        if (place[a] < COLUMNS - EDGE && place[b] < COLUMNS - EDGE)
            unite_sets(parent, a, b);
    }
    int n_part = 0;
    for (int k = 0; k < COLUMNS - EDGE; k++)
        n_part += parent[order[k]] == order[k];
    assert_int_equal(n_part, 2);
    free(order);
    boundary_layer_free(&layer);
    network_free(&network);
}
