// SPDX-License-Identifier: GPL-3.0-or-later
#include "patches.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

// theta times the unit normal of the plane through the arc from direction A to
// direction B. For unit vectors theta is the angle; small angles keep their digits.
static struct vector arc(struct vector a, struct vector b)
{
    const struct vector normal = cross(a, b);
    const double sine = norm(normal);
    if (sine == 0) return (struct vector){0};
    return scale(atan2(sine, dot(a, b)) / sine, normal);
}

// The integral of the unit normal over the spherical triangle A B C, counter-clockwise
// from outside. The cone below it is closed, so the integral is minus that over its
// three flat sides, which are sectors of area theta/2.
static struct vector triangle_normal(struct vector a, struct vector b, struct vector c)
{
    return scale(0.5, add(arc(a, b), add(arc(b, c), arc(c, a))));
}

static struct vector direction(struct vector from, struct vector to)
{
    const struct vector apart = subtract(to, from);
    return scale(1 / norm(apart), apart);
}

// Where the line between the two sides of a face crosses it. Between grains that is the
// point of equal power, the middle for equal radii.
static struct vector foot_of_face(const struct network *network, int face)
{
    const struct packing *packing = &network->packing;
    const int i = network->face_particles[face][0],
              j = network->face_particles[face][1];
    const struct vector foot = packing->position[i];
    if (j < 0) return nearest_on_wall(packing, -1 - j, foot);
    const struct vector apart = subtract(second_grain(network, face), foot);
    const double ri = packing->radius[i], rj = packing->radius[j];
    const double share =
        0.5 + 0.5 * (ri - rj) * (ri + rj) / dot(apart, apart); // [K 3.2]
    return add(foot, scale(share, apart));
}

// The grain on SIDE of the face, in the repetition of the box where the first one is.
static struct vector centre_of(const struct network *network, int face, int side)
{
    return side ? second_grain(network, face)
                : network->packing.position[network->face_particles[face][0]];
}

// From the grain on SIDE towards what lies behind the face. Not towards the foot: a
// grain whose centre another one has engulfed lies beyond its own face.
static struct vector outwards(const struct network *network, int face, int side)
{
    const bool is_wall = network->face_particles[face][1] < 0;
    return subtract(is_wall ? foot_of_face(network, face)
                            : centre_of(network, face, !side),
                    centre_of(network, face, side));
}

// The patches one face gives the grain on one of its sides, a triangle a throat,
// written to PATCHES. Turned around when the loop runs clockwise seen from that grain's
// outside. False when the grain's centre is on the face: there is no direction to it.
static bool fan(const struct network *network, int face, int side, const int *throats,
                struct patch *patches)
{
    const int64_t begin = network->face_offset[face];
    const int count = (int)(network->face_offset[face + 1] - begin);
    const int grain = network->face_particles[face][side];
    const struct vector centre = centre_of(network, face, side);
    const struct vector foot = direction(centre, foot_of_face(network, face));
    struct vector sum = {0};
    for (int k = 0; k < count; k++) {
        const struct vector a = direction(centre, face_corner(network, begin + k));
        const struct vector b =
            direction(centre, face_corner(network, begin + (k + 1) % count));
        patches[k] = (struct patch){throats[k], grain, triangle_normal(foot, a, b)};
        sum = add(sum, patches[k].normal);
    }
    const double sign = dot(sum, outwards(network, face, side)) < 0 ? -1 : 1;
    for (int k = 0; k < count; k++)
        patches[k].normal = scale(sign, patches[k].normal);
    return isfinite(dot(sum, foot));
}

// The patches of a grain of a layer, whose cell FACE is: lunes between the half planes
// through its axis, along y, and the two ends of each throat [K 3.21]. The arc from A
// to B in the plane has the integral (B - A) turned by a right angle, and across the
// plane a sphere adds a factor of pi/2.
static bool slice(const struct network *network, int face, const int *throats,
                  struct patch *patches)
{
    const int64_t begin = network->face_offset[face];
    const int count = (int)(network->face_offset[face + 1] - begin);
    struct vector centre = centre_of(network, face, 0);
    centre.y = network->node_position[network->face_nodes[begin]].y; // staggered
    double area = 0;
    for (int k = 0; k < count; k++) {
        const struct vector from = face_corner(network, begin + k);
        const struct vector to = face_corner(network, begin + (k + 1) % count);
        const struct vector apart =
            subtract(direction(centre, to), direction(centre, from));
        area += cross(subtract(from, centre), subtract(to, centre)).y;
        patches[k] =
            (struct patch){throats[k], network->face_particles[face][0],
                           scale(M_PI / 2, cross(apart, (struct vector){.y = 1}))};
    }
    for (int k = 0; k < count && area < 0; k++)
        patches[k].normal = scale(-1, patches[k].normal);
    return isfinite(patches[0].normal.x) && area != 0;
}

static int compare_patches(const void *a, const void *b)
{
    const struct patch *first = a, *second = b;
    if (first->particle != second->particle)
        return first->particle < second->particle ? -1 : 1;
    return (first->throat > second->throat) - (first->throat < second->throat);
}

// One patch a throat and grain, out of the two triangles.
static int unite(struct patch *patches, int count)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        struct patch *last = kept ? &patches[kept - 1] : NULL;
        if (last && !compare_patches(last, &patches[k]))
            last->normal = add(last->normal, patches[k].normal);
        else
            patches[kept++] = patches[k];
    }
    return kept;
}

static enum status find_throats(const struct network *network,
                                const struct incidence *incidence, int face,
                                int *throats, struct reason *reason)
{
    const int32_t *loop = network->face_nodes + network->face_offset[face];
    const int count =
        (int)(network->face_offset[face + 1] - network->face_offset[face]);
    if (network->face_particles[face][0] < 0)
        return refuse(
            reason, STATUS_BAD_DATA,
            "/faces/particles: row %d: the first side must be a grain, got %d", face,
            network->face_particles[face][0]);
    for (int k = 0; k < count; k++) {
        const int next = (k + 1) % count;
        throats[k] = face_throat(network, incidence, face, k);
        if (throats[k] < 0)
            return refuse(reason, STATUS_BAD_DATA,
                          "/faces/nodes: face %d: no throat between nodes %d and %d",
                          face, loop[k], loop[next]);
    }
    return STATUS_OK;
}

enum status check_closed(const struct patch *patches, int count, struct reason *reason)
{
    static const double rounding = 1e-6; // of a whole sphere, 4 pi
    struct vector sum = {0};
    for (int k = 0; k < count; k++) {
        sum = add(sum, patches[k].normal);
        const int32_t grain = patches[k].particle;
        if (k + 1 < count && patches[k + 1].particle == grain) continue;
        if (norm(sum) > rounding)
            return refuse(reason, STATUS_BAD_DATA,
                          "/faces/particles: the cell of grain %d is open: tessellate "
                          "with boundary=truncate",
                          grain);
        sum = (struct vector){0};
    }
    return STATUS_OK;
}

enum status find_patches(const struct network *network, struct patch **patches,
                         int *count, struct reason *reason)
{
    const size_t n_face_node = (size_t)network->face_offset[network->n_face];
    struct incidence incidence = network_incidence(network);
    int *throats = NEW_ARRAY(int, n_face_node);
    const bool layer = is_layer(network);
    enum status status = STATUS_OK;
    *patches = NEW_ARRAY(struct patch, 2 * n_face_node);
    *count = 0;
    for (int face = 0; face < network->n_face && !status; face++) {
        status = find_throats(network, &incidence, face, throats, reason);
        for (int side = 0; side < 2 && !status; side++) {
            const int grain = network->face_particles[face][side];
            if (grain < 0) continue;
            if (!(layer ? slice(network, face, throats, *patches + *count)
                        : fan(network, face, side, throats, *patches + *count)))
                status = refuse(reason, STATUS_BAD_DATA,
                                "/faces/nodes: face %d: meets the centre of grain %d",
                                face, grain);
            *count +=
                (int)(network->face_offset[face + 1] - network->face_offset[face]);
        }
    }
    if (*count) qsort(*patches, (size_t)*count, sizeof **patches, compare_patches);
    *count = unite(*patches, *count);
    free(throats);
    incidence_free(&incidence);
    if (status) free(*patches);
    return status;
}

int drop_patches_in_walls(const struct network *network, unsigned walls,
                          struct patch *patches, int count)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        const int32_t *ends = network->throat_nodes[patches[k].throat];
        const unsigned common =
            network->node_walls[ends[0]] & network->node_walls[ends[1]];
        if (!(common & walls)) patches[kept++] = patches[k];
    }
    return kept;
}
