// SPDX-License-Identifier: GPL-3.0-or-later
// Where throats lie beside grains: in diagrams of unequal grains, in walls, flat and
// round, in boxes that repeat and below auxiliary grains, with all cells and without
// those that walls would cut.
#include "force-protocol/pendular_rings.h"
#include "wedge_scene.h"

#include <stdlib.h>

// ---- one wedge ----------------------------------------------------------------------

static double power(const struct packing *packing, int grain, struct vector apart)
{
    const double radius = packing->radius[grain];
    return dot(apart, apart) - radius * radius;
}

static void assert_zero(double value)
{
    if (!(fabs(value) < 1e-9)) fail_msg("got %g, wanted 0", value);
}

static void assert_equal(struct vector got, struct vector wanted)
{
    assert_zero(distance(got, wanted));
}

// Grains are where they are, in one repetition of the box or another.
static void check_places(const struct sectors *sectors, const struct sector *sector)
{
    const struct packing *packing = &sectors->network->packing;
    struct vector there[2] = {sector->centre, sector->across};
    const int grain[2] = {sector->grain, sector->beyond};
    for (int k = 0; k < 2; k++) {
        if (grain[k] < 0) continue;
        if (sectors->layer) there[k].y = packing->position[grain[k]].y;
        assert_zero(norm(nearest(packing, packing->position[grain[k]], there[k])));
    }
    assert_equal(there[1], sector->beyond < 0 ? sector->foot : there[1]);
}

// [K 3.2] On the line between the grains, where both have the same power.
static void check_foot(const struct sectors *sectors, const struct sector *sector)
{
    const struct packing *packing = &sectors->network->packing;
    const struct vector apart = subtract(sector->across, sector->centre);
    const struct vector here = subtract(sector->foot, sector->centre);
    const struct vector there = subtract(sector->foot, sector->across);
    if (sectors->layer) {
        assert_equal(sector->foot, scale(0.5, add(sector->from, sector->to)));
    } else if (sector->beyond < 0) {
        const int wall = -1 - sector->beyond;
        if (wall >= WALL_OUTER) {
            const double height = height_above(packing, sector->centre);
            assert_zero(height_above(packing, sector->foot));
            assert_zero(distance(sector->foot, sector->centre) - fabs(height));
            return;
        }
        struct vector wanted = sector->centre;
        set_component(&wanted, wall / 2,
                      wall % 2 ? component(packing->upper, wall / 2) : 0);
        assert_equal(sector->foot, wanted);
    } else {
        assert_zero(norm(cross(here, apart)));
        assert_zero(power(packing, sector->grain, here) -
                    power(packing, sector->beyond, there));
    }
}

// Both grains have the same power along the throat, and no grain has less.
static void check_throat(const struct sectors *sectors, const struct sector *sector)
{
    const struct packing *packing = &sectors->network->packing;
    const struct vector at[2] = {sector->from, sector->to};
    for (int k = 0; k < 2; k++) {
        const double own =
            power(packing, sector->grain, subtract(at[k], sector->centre));
        if (sector->beyond >= 0)
            assert_zero(
                own - power(packing, sector->beyond, subtract(at[k], sector->across)));
        for (int j = 0; j < packing->n_particle; j++) {
            struct vector centre = packing->position[j];
            if (sectors->layer) centre.y = at[k].y;
            assert_true(power(packing, j, nearest(packing, centre, at[k])) >
                        own - 1e-9);
        }
    }
    const struct vector along = subtract(sector->to, sector->from), y = {0, 1, 0};
    const struct vector outwards = subtract(sector->foot, sector->centre);
    assert_true(norm(along) > 0);
    if (sectors->layer) assert_true(dot(cross(along, y), outwards) > 0);
}

// ---- the wedges of one throat -------------------------------------------------------

// From A's grain the throat runs as it does, the other way, in B from its own.
static bool run_opposite(const struct sector *a, struct vector from_a,
                         const struct sector *b, struct vector from_b)
{
    return distance(subtract(a->from, from_a), subtract(b->to, from_b)) < 1e-9 &&
           distance(subtract(a->to, from_a), subtract(b->from, from_b)) < 1e-9;
}

// What the grain beyond sees of it is the mirror image.
static bool are_mates(const struct sector *a, const struct sector *b, bool is_layer)
{
    return a->grain == b->beyond && a->beyond == b->grain &&
           (is_layer || a->face == b->face) &&
           run_opposite(a, a->centre, b, b->across) &&
           run_opposite(a, a->across, b, b->centre) &&
           run_opposite(a, a->foot, b, b->foot);
}

// Grains follow one another around a throat: in space each has the throat in two of its
// faces, whose loops run along it in opposite directions.
static void check_around(const struct sectors *sectors, int n)
{
    for (int a = 0; a < n; a++) {
        const struct sector *sector = &sectors->sector[a];
        int mates = 0, others = 0;
        for (int b = 0; b < n; b++) {
            const struct sector *other = &sectors->sector[b];
            mates += are_mates(sector, other, sectors->layer);
            if (b == a || other->grain != sector->grain) continue;
            assert_true(run_opposite(sector, sector->centre, other, other->centre));
            others++;
        }
        assert_int_equal(mates, sector->beyond >= 0);
        assert_int_equal(others, !sectors->layer);
    }
}

static bool lies_in(const struct network *network, int throat, int wall)
{
    const struct packing *packing = &network->packing;
    const int32_t *ends = network->throat_nodes[throat];
    const struct vector at[2] = {network->node_position[ends[0]],
                                 network->node_position[ends[1]]};
    if (wall >= WALL_OUTER) {
        const int own = packing->body->within ? WALL_OUTER : WALL_INNER;
        return packing->n_body > 0 && wall == own &&
               fabs(height_above(packing, at[0])) < 1e-9 &&
               fabs(height_above(packing, at[1])) < 1e-9;
    }
    const double level = wall % 2 ? component(packing->upper, wall / 2) : 0;
    return !packing->periodic[wall / 2] &&
           fabs(component(at[0], wall / 2) - level) < 1e-9 &&
           fabs(component(at[1], wall / 2) - level) < 1e-9;
}

// Bits of the walls in which both ends of the throat lie; below auxiliary grains, which
// are all at the upper side, also that of this one. Grains around it go from wall to
// wall.
static void check_surface(const struct sectors *sectors, int throat, int n)
{
    const struct network *network = sectors->network;
    int count = 0, beyond = 0;
    bool below = false;
    if (network->throat_kind[throat] != THROAT_NETWORK)
        return; // between auxiliary ones
    for (int k = 0; k < n; k++)
        below |= is_auxiliary(&network->packing, sectors->sector[k].grain);
    for (int wall = 0; wall <= WALL_INNER; wall++) {
        if (sectors->layer && wall / 2 == 1) continue;
        const bool lies = lies_in(network, throat, wall);
        const bool faces = below && wall == 5;
        assert_int_equal(sectors->surface[throat] >> wall & 1, lies || faces);
        count += lies;
    }
    for (int k = 0; k < n; k++) {
        const int wall = -1 - sectors->sector[k].beyond;
        beyond += wall >= 0;
        if (!sectors->layer && wall >= 0)
            assert_true(lies_in(sectors->network, throat, wall));
    }
    assert_int_equal(beyond, count == 0 ? 0 : sectors->layer ? 1 : 2);
}

// ---- all of them --------------------------------------------------------------------

static void check_all(const struct scene *scene, uint64_t seed, bool is_turned)
{
    struct network network = diagram_of(scene, seed);
    if (is_turned) turn_loops(&network);
    struct sectors sectors;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason)) fail_msg("%s", reason.text);
    int count = 0, found = 0;
    for (int t = 0; t < network.n_throat; t++) {
        const int n = sectors_at(&sectors, t);
        for (int k = 0; k < n; k++) {
            assert_int_equal(sectors.sector[k].throat, t);
            check_places(&sectors, &sectors.sector[k]);
            check_foot(&sectors, &sectors.sector[k]);
            check_throat(&sectors, &sectors.sector[k]);
            found += sectors.sector[k].face < 0;
        }
        check_around(&sectors, n);
        check_surface(&sectors, t, n);
        count += n;
    }
    assert_true(count > 200);
    assert_true(scene->boundary == BOUNDARY_TRUNCATE ? found == 0 : found > 20);
    sectors_free(&sectors);
    network_free(&network);
}

TEST(wedges_lie_where_powers_are_equal)
{
    for (int s = 0; s < N_SCENE; s++)
        for (uint64_t seed = 1; seed <= (scenes[s].layer ? 5 : 1); seed++)
            for (int turned = 0; turned < 2; turned++)
                check_all(&scenes[s], seed, turned);
}

// Where cells were left out no throat lies in a wall, however near in metres.
TEST(walls_are_as_far_in_nanometres)
{
    struct network network = diagram_of(&scenes[2], 1);
    resize(&network, 0x1p-30);
    struct sectors sectors;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason)) fail_msg("%s", reason.text);
    for (int t = 0; t < network.n_throat; t++)
        assert_int_equal(sectors.surface[t], 0);
    sectors_free(&sectors);
    network_free(&network);
}

// The solid angle of the triangle A B C from the origin (Van Oosterom, Strackee).
static double solid_angle(struct vector a, struct vector b, struct vector c)
{
    const double size[3] = {norm(a), norm(b), norm(c)};
    const double beneath = size[0] * size[1] * size[2] + dot(a, b) * size[2] +
                           dot(b, c) * size[0] + dot(c, a) * size[1];
    return 2 * atan2(dot(a, cross(b, c)), beneath);
}

// Counter-clockwise from outside, whichever way loops run: cells fill the box, and each
// surrounds its grain.
static void check_closed(const struct scene *scene, bool is_turned)
{
    struct network network = diagram_of(scene, 1);
    if (is_turned) turn_loops(&network);
    struct sectors sectors;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason)) fail_msg("%s", reason.text);
    double volume = 0;
    double *angle = NEW_ARRAY(double, network.packing.n_particle);
    for (int t = 0; t < network.n_throat; t++)
        for (int k = sectors_at(&sectors, t); k-- > 0;) {
            const struct sector *w = &sectors.sector[k];
            const struct vector foot = subtract(w->foot, w->centre);
            const struct vector from = subtract(w->from, w->centre);
            const struct vector to = subtract(w->to, w->centre);
            volume += dot(foot, cross(from, to)) / 6;
            angle[w->grain] += solid_angle(foot, from, to);
        }
    const struct vector edge = network.packing.upper;
    if (network.packing.n_body == 0) assert_zero(volume - edge.x * edge.y * edge.z);
    for (int i = 0; i < network.packing.n_particle; i++)
        assert_zero(angle[i] - 4 * M_PI);
    free(angle);
    sectors_free(&sectors);
    network_free(&network);
}

TEST(wedges_close_around_grains)
{
    for (int s = 0; s < N_SCENE; s++)
        for (int turned = 0; turned < 2; turned++)
            if (!scenes[s].layer && scenes[s].boundary == BOUNDARY_TRUNCATE)
                check_closed(&scenes[s], turned);
}

// In the end each ring is whole, also where the line between two grains passes beside
// their face; none is left at walls and at auxiliary grains.
static void check_rings(const struct scene *scene)
{
    const struct ring_law law = {
        .rule = RING_VOLUME, .volume = 1, .surface_tension = 1};
    struct network network = diagram_of(scene, 1);
    struct packing *packing = &network.packing;
    struct sectors sectors;
    struct pendular_rings rings;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason) ||
        find_pendular_rings(&sectors, &law, &rings, &reason))
        fail_msg("%s", reason.text);
    struct vector *left = NEW_ARRAY(struct vector, packing->n_particle);
    for (int k = 0; k < rings.patches.n; k++) {
        struct vector *sum = &left[rings.patches.patch[k].particle];
        *sum = add(*sum, rings.patches.patch[k].pull);
    }
    int count = 0;
    double largest = 0;
    for (int face = 0; face < network.n_face; face++) {
        const int32_t *grain = network.face_particles[face];
        if (grain[1] < 0 || is_auxiliary(packing, grain[0]) ||
            is_auxiliary(packing, grain[1]))
            continue;
        const struct vector apart =
            subtract(second_grain(&network, face), packing->position[grain[0]]);
        const double radius[2] = {packing->radius[grain[0]], packing->radius[grain[1]]};
        double volume, force;
        if (solve_ring(radius, norm(apart) - radius[0] - radius[1], &law, &volume,
                       &force, &reason))
            fail_msg("%s", reason.text);
        const struct vector ring = scale(force / norm(apart), apart);
        left[grain[0]] = subtract(left[grain[0]], ring);
        left[grain[1]] = add(left[grain[1]], ring);
        count += force != 0;
        largest = fmax(largest, fabs(force));
    }
    for (int i = 0; i < packing->n_particle; i++)
        assert_zero(norm(left[i]));
    assert_int_equal(rings.count, count);
    assert_zero(rings.largest - largest);
    assert_true(count > 50);
    free(left);
    patches_free(&rings.patches);
    sectors_free(&sectors);
    network_free(&network);
}

TEST(rings_are_whole_in_the_end)
{
    for (int s = 0; s < N_SCENE; s++)
        if (!scenes[s].layer && scenes[s].boundary == BOUNDARY_TRUNCATE)
            check_rings(&scenes[s]);
}

// In a layer each throat is the face between two grains, and leaves their ring.
static void check_rings_of_layer(const struct scene *scene)
{
    const struct ring_law law = {
        .rule = RING_VOLUME, .volume = 1, .surface_tension = 1};
    struct network network = diagram_of(scene, 1);
    const struct packing *packing = &network.packing;
    struct sectors sectors;
    struct pendular_rings rings;
    struct reason reason;
    if (sectors_find(&network, &sectors, &reason) ||
        find_pendular_rings(&sectors, &law, &rings, &reason))
        fail_msg("%s", reason.text);
    int count = 0;
    for (int k = 0; k < rings.patches.n; k++) {
        const struct patch *patch = &rings.patches.patch[k];
        const int n = sectors_at(&sectors, patch->throat);
        const struct sector *sector = sectors.sector;
        if (n > 1 && sector->grain != patch->particle) sector++;
        assert_int_equal(sector->grain, patch->particle);
        double volume, force = 0;
        const struct vector apart = subtract(sector->across, sector->centre);
        if (n > 1 && !is_auxiliary(packing, sector->grain) &&
            !is_auxiliary(packing, sector->beyond)) {
            const double radius[2] = {packing->radius[sector->grain],
                                      packing->radius[sector->beyond]};
            if (solve_ring(radius, norm(apart) - radius[0] - radius[1], &law, &volume,
                           &force, &reason))
                fail_msg("%s", reason.text);
        }
        assert_equal(patch->pull, scale(force / norm(apart), apart));
        count += force != 0;
    }
    assert_int_equal(count, 2 * rings.count);
    assert_true(count > 60);
    patches_free(&rings.patches);
    sectors_free(&sectors);
    network_free(&network);
}

TEST(throats_of_layers_leave_rings)
{
    for (int s = 0; s < N_SCENE; s++)
        if (scenes[s].layer) check_rings_of_layer(&scenes[s]);
}
