// SPDX-License-Identifier: GPL-3.0-or-later
// What each throat does to the grains around it, also those whose cells were left out:
// pairs in balance, contact lines, menisci and rings in closed form.
#include "basics/memory.h"
#include "bridges/bridges.h"
#include "force-protocol/balance.h"
#include "force-protocol/pendular_rings.h"
#include "force_scene.h"
#include "tessellate/diagram.h"

#include <string.h>

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

TEST(a_throat_is_felt_by_all_grains_around_it)
{
    struct network network = cell_among_six(0);
    struct patches patches = patches_of(&network, FORM_FACES);
    assert_int_equal(patches.n, 36);
    assert_true(size(sum_of(&patches, 0)) < 1e-15);
    // Two quarters of its faces, though the grains beyond are not alike [K 3.2].
    for (int k = 0; k < patches.n; k++)
        if (patches.patch[k].particle == 0)
            assert_true(fabs(norm(patches.patch[k].pull) - sqrt(2) / 4) < 1e-15);
        else
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

TEST(pairs_are_in_balance)
{
    struct network network = cell_among_six(0.7);
    struct patches patches = patches_of(&network, FORM_FACES);
    check_pairs(&network, &patches);
    patches_free(&patches);
    network_free(&network);
}

static struct patches balanced_patches_of(const struct network *network, enum form form)
{
    struct sectors sectors;
    struct patches patches;
    struct reason reason;
    double change;
    assert_int_equal(sectors_find(network, &sectors, &reason), STATUS_OK);
    assert_int_equal(
        find_balanced_patches(&sectors, form, true, &patches, &change, &reason),
        STATUS_OK);
    assert_true(form == FORM_FACES ? change < 1e-15 : change > 0.01 && change < 1);
    sectors_free(&sectors);
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
TEST(balance_changes_as_little_as_it_takes)
{
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

TEST(contact_lines_pull_in_pairs)
{
    struct network network = cell_among_six(0.3);
    struct sectors sectors;
    struct reason reason;
    assert_int_equal(sectors_find(&network, &sectors, &reason), STATUS_OK);
    struct patches lines = find_contact_lines(&sectors);
    assert_int_equal(lines.n, 36);
    for (int t = 0; t < network.n_throat; t++)
        check_contact_line(&network, &lines, 0, t);
    patches_free(&lines);
    sectors_free(&sectors);
    network_free(&network);
}

// Turning the scene turns the pulls.
TEST(pulls_turn_with_the_scene)
{
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

TEST(patches_and_menisci_are_in_balance)
{
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

// ---- rings --------------------------------------------------------------------------

static const struct ring_law law = {
    .rule = RING_VOLUME, .volume = 0.5, .surface_tension = 1, .contact_angle = 0.2};

// The ring of grain A, force and direction, towards B.
static struct vector ring_towards(const struct packing *packing, int a, int b)
{
    const struct vector apart = subtract(packing->position[b], packing->position[a]);
    const double ra = packing->radius[a], rb = packing->radius[b];
    const struct bridge bridge = {.radius = {ra, rb},
                                  .contact_angle = {0.2, 0.2},
                                  .surface_tension = 1,
                                  .volume = 0.5 * pow(2 * ra * rb / (ra + rb), 3)};
    struct bridge_state ring;
    struct reason reason;
    assert_int_equal(bridge_solve(&bridge, norm(apart) - ra - rb, &ring, &reason),
                     STATUS_OK);
    return scale(ring.force / norm(apart), apart);
}

// Of a full turn around the line from A to B, seen from where powers are equal on it.
static double angle_of(const struct network *network, int throat, int a, int b)
{
    const struct packing *packing = &network->packing;
    const struct vector apart = subtract(packing->position[b], packing->position[a]);
    const double more = pow(packing->radius[a], 2) - pow(packing->radius[b], 2);
    const double share = 0.5 + 0.5 * more / dot(apart, apart);
    const struct vector foot = add(packing->position[a], scale(share, apart));
    const int32_t *ends = network->throat_nodes[throat];
    const struct vector from = subtract(network->node_position[ends[0]], foot);
    const struct vector to = subtract(network->node_position[ends[1]], foot);
    return acos(dot(from, to) / norm(from) / norm(to)) / (2 * M_PI);
}

// Each throat leaves the part of a ring that it faces: a quarter of the cell's own.
TEST(throats_leave_their_part_of_rings)
{
    struct network network = cell_among_six(0.3);
    struct sectors sectors;
    struct pendular_rings rings;
    struct reason reason;
    double largest = 0;
    assert_int_equal(sectors_find(&network, &sectors, &reason), STATUS_OK);
    assert_int_equal(find_pendular_rings(&sectors, &law, &rings, &reason), STATUS_OK);
    assert_int_equal(rings.patches.n, 36);
    for (int k = 0; k < 36; k++) {
        const struct patch *patch = &rings.patches.patch[k];
        const int a = patch->particle;
        struct vector wanted = {0, 0, 0};
        for (int l = 0; l < 36; l++) {
            const int b = rings.patches.patch[l].particle;
            if (rings.patches.patch[l].throat != patch->throat || b == a) continue;
            const struct vector ring = ring_towards(&network.packing, a, b);
            const double share = angle_of(&network, patch->throat, a, b);
            if (a == 0 || b == 0) assert_true(fabs(share - 0.25) < 1e-12);
            wanted = add(wanted, scale(share, ring));
            largest = fmax(largest, norm(ring));
        }
        assert_true(norm(wanted) > 0 && distance(patch->pull, wanted) < 1e-9);
    }
    assert_true(fabs(rings.largest - largest) < 1e-9);
    assert_int_equal(rings.count, 6 + 12);
    patches_free(&rings.patches);
    sectors_free(&sectors);
    network_free(&network);
}

// Grains in a row that overlap, so that all rings but those of other radii are alike.
TEST(each_pair_in_a_row_has_its_own_ring)
{
    static const double radii[][4] = {
        {0.2, 0.3, 0.3, 0.3}, {0.3, 0.3, 0.3, 0.2}, {0.3, 0.3, 0.3, 0.4}};
    for (int row = 0; row < 3; row++) {
        struct vector position[4];
        double radius[4];
        for (int i = 0; i < 4; i++) {
            position[i] = (struct vector){0.5, 0.5, 0.3 + 0.45 * i};
            radius[i] = radii[row][i];
        }
        const struct packing packing = {.n_particle = 4,
                                        .position = position,
                                        .radius = radius,
                                        .upper = {1, 1, 2}};
        const struct tessellation how = {.power = true};
        struct tessellation_report report;
        struct network network;
        struct sectors sectors;
        struct pendular_rings rings;
        struct reason reason;
        if (tessellate(&packing, &how, &network, &report, &reason) ||
            sectors_find(&network, &sectors, &reason) ||
            find_pendular_rings(&sectors, &law, &rings, &reason))
            fail_msg("%s", reason.text);
        double below = 0;
        for (int i = 0; i < 4; i++) {
            double volume, above = 0;
            if (i < 3 && solve_ring(&radius[i], 0, &law, &volume, &above, &reason))
                fail_msg("%s", reason.text);
            const struct vector pull = {0, 0, above - below};
            assert_true(distance(sum_of(&rings.patches, i), pull) < 1e-9);
            below = above;
        }
        assert_int_equal(rings.count, 3);
        patches_free(&rings.patches);
        sectors_free(&sectors);
        network_free(&network);
    }
}

// A bridge that is none; the first pair by radii is named, its lower grain first.
TEST(what_is_no_bridge_is_refused)
{
    struct network network = cell_among_six(0);
    struct ring_law bad = law;
    bad.contact_angle = 4;
    struct sectors sectors;
    struct pendular_rings rings;
    struct reason reason;
    assert_int_equal(sectors_find(&network, &sectors, &reason), STATUS_OK);
    assert_int_equal(find_pendular_rings(&sectors, &bad, &rings, &reason),
                     STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, "ring between grains 0 and 1: "));
    assert_int_equal(rings.patches.n, 0);
    sectors_free(&sectors);
    network_free(&network);
}
