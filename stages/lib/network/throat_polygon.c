// SPDX-License-Identifier: GPL-3.0-or-later
// From the faces around a throat to the polygon of its grains. With c_i, c_j the grains
// of a face (a wall's "centre" is the foot of the grain's on it), a the first node, and
// faces turned so that their loops lead along the throat:
//     2 polygon t = sum over faces (c_i - a) x (c_j - a)
// (without what is across walls),
// which gives the direction t of the throat from the grains: that of a throat shorter
// than rounding of its nodes too. With n the unit vector from c_i to c_j,
//     s   = (c_i - a) . (n x t)    how far the line c_i c_j is from the throat's,
//     x_i = (a - c_i) . n,  x_j = |c_j - c_i| - x_i,
// a face adds atan2(s, x_i) to the angle at grain i, and the same at j. s is below 0
// where the throat passes beyond that line; areas and angles of such faces count
// negative, so that the polygon stays whole.
//
// Two grains overlap by the lens on both sides of the line at
//     x = (d^2 + r_i^2 - r_j^2) / (2 d)   from c_i.
//
// Feet on a round wall lie in no plane with a throat along it, which is a chord: seen
// from one of its ends, direction and area would not be those from the other. So of
// these throats a is the middle.
#include "network/throat_polygon.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

// One face as the throat sees it: its two sides relative to a place on the throat.
struct seen_face {
    struct vector centre[2]; // of a wall: the foot of the grain's
    int32_t grain[2];        // of the packing; a wall below 0
    double radius[2];        // 0: not a grain of the body
    bool wall;               // one of them is a wall
    bool body;               // that of a body: perhaps round
};

// From FROM_FIRST of the way along the throat.
static struct seen_face seen_face(const struct network *network,
                                  const struct throat_sides *sides, int throat,
                                  int64_t k, double from_first)
{
    const struct packing *packing = &network->packing;
    const struct throat_side side = throat_side(network, sides, throat, k);
    const struct vector from =
        add(side.first, scale(from_first, subtract(side.second, side.first)));
    const int face = sides->face[k];
    const int32_t *grain = network->face_particles[face];
    const struct vector first = packing->position[grain[0]];
    const bool wall = grain[1] < 0;
    const struct vector second = wall ? nearest_on_wall(packing, -1 - grain[1], first)
                                      : second_grain(network, face);
    const int turned = !side.forward;
    struct seen_face seen = {.wall = wall, .body = wall && -1 - grain[1] >= WALL_OUTER};
    seen.centre[turned] = subtract(first, from);
    seen.centre[!turned] = subtract(second, from);
    for (int end = 0; end < 2; end++) {
        seen.grain[end ^ turned] = grain[end];
        if (grain[end] >= 0 && !is_auxiliary(packing, grain[end]))
            seen.radius[end ^ turned] = packing->radius[grain[end]];
    }
    return seen;
}

static struct vector without(struct vector part, struct vector of)
{
    const double square = dot(part, part);
    return square > 0 ? subtract(of, scale(dot(of, part) / square, part)) : of;
}

// The direction of the throat. The edge that closes a polygon along a wall lies in that
// wall, as the throat does: what it lacks is across the wall, where a throat in it does
// not lead. A round wall has another normal at each foot: its mean counts.
static struct vector direction(const struct seen_face *face, int count)
{
    struct vector twice = {0}, mean = {0};
    for (int k = 0; k < count; k++)
        twice = add(twice, cross(face[k].centre[0], face[k].centre[1]));
    for (int k = 0; k < count; k++) {
        if (!face[k].wall) continue;
        const struct vector to = subtract(face[k].centre[1], face[k].centre[0]);
        const double side = face[k].radius[0] > 0 ? 1 : -1, apart = norm(to);
        if (!face[k].body)
            twice = without(to, twice);
        else if (apart > 0)
            mean = add(mean, scale(side / apart, to));
    }
    twice = without(mean, twice);
    const double size = norm(twice);
    return size > 0 ? scale(1 / size, twice) : twice;
}

// A unit vector across the unit vector ALONG.
static struct vector any_across(struct vector along)
{
    const double x = fabs(along.x), y = fabs(along.y), z = fabs(along.z);
    const struct vector far = {x <= y && x <= z, y < x && y <= z, z < x && z < y};
    const struct vector across = cross(along, far);
    const double size = norm(across);
    return size > 0 ? scale(1 / size, across) : across;
}

struct throat_polygon throat_polygon_init(int most)
{
    return (struct throat_polygon){
        .section = {.grain = NEW_ARRAY(struct section_grain, 2 * most),
                    .overlap = NEW_ARRAY(struct section_overlap, most),
                    .gap = NEW_ARRAY(struct section_gap, most)},
        .face = NEW_ARRAY(struct seen_face, most),
        .centre = NEW_ARRAY(struct vector, 2 * most),
        .number = NEW_ARRAY(int32_t, 2 * most)};
}

void throat_polygon_free(struct throat_polygon *polygon)
{
    free(polygon->section.grain);
    free(polygon->section.overlap);
    free(polygon->section.gap);
    free(polygon->face);
    free(polygon->centre);
    free(polygon->number);
}

// Adds ANGLE to the grain of END of FACE, which may be there from another face: that of
// the same number and, of its images, at the same place. Another grain may have its
// centre within it. Returns its number in the section.
static int add_angle(struct throat_polygon *polygon, const struct seen_face *face,
                     int end, struct vector along, double angle)
{
    struct open_section *section = &polygon->section;
    const struct vector centre = face->centre[end];
    const double radius = face->radius[end], height = dot(centre, along);
    int k = 0;
    while (k < section->n_grain && !(polygon->number[k] == face->grain[end] &&
                                     distance(polygon->centre[k], centre) < radius))
        k++;
    if (k == section->n_grain) {
        const struct vector across = subtract(centre, scale(height, along));
        section->grain[k] = (struct section_grain){
            0,
            radius,
            height,
            norm(across),
            {dot(across, polygon->axis[0]), dot(across, polygon->axis[1])}};
        polygon->number[section->n_grain] = face->grain[end];
        polygon->centre[section->n_grain++] = centre;
    }
    section->grain[k].angle += angle;
    return k;
}

// What the two grains of FACE cover twice, or one of them beyond its own side. Along a
// round wall two grains are not quite equally high: the mean counts.
static void add_overlap(struct throat_polygon *polygon, const struct seen_face *face,
                        struct vector along, double apart, const double x[2])
{
    struct open_section *section = &polygon->section;
    const double *r = face->radius;
    const bool pair = r[0] > 0 && r[1] > 0;
    const int grain = r[1] > 0 && !pair;
    if (!(pair ? r[0] + r[1] > apart : r[grain] > x[grain])) return;
    const double share = pair && polygon->from_first > 0 ? 0.5 : 0;
    const struct vector other = subtract(face->centre[!grain], face->centre[grain]);
    const double chord = (apart + (r[0] - r[1]) * ((r[0] + r[1]) / apart)) / 2;
    section->overlap[section->n_overlap++] = (struct section_overlap){
        {pair ? chord : x[0], pair ? apart - chord : x[1]},
        {r[0], r[1]},
        dot(face->centre[grain], along) + share * dot(other, along)};
}

static void add_face(struct throat_polygon *polygon, const struct seen_face *face,
                     struct vector along)
{
    struct open_section *section = &polygon->section;
    const struct vector to = subtract(face->centre[1], face->centre[0]);
    const double apart = norm(to);
    if (!(apart > 0)) return;
    const struct vector n = scale(1 / apart, to);
    const double s = dot(face->centre[0], cross(n, along));
    const double x[2] = {-dot(face->centre[0], n), apart + dot(face->centre[0], n)};
    int grain[2] = {-1, -1};
    for (int end = 0; end < 2; end++) {
        const double radius = face->radius[end];
        if (!(radius > 0)) continue;
        section->area += s * x[end] / 2;
        grain[end] = add_angle(polygon, face, end, along, atan2(s, x[end]));
        if (face->wall)
            section->wall +=
                fmax(0, s - sqrt(fmax(0, radius * radius - apart * apart)));
    }
    add_overlap(polygon, face, along, apart, x);
    const int first = grain[0] < 0;
    if (grain[first] >= 0)
        section->gap[section->n_gap++] = (struct section_gap){
            {grain[first], grain[!first]}, grain[!first] < 0 ? x[first] : apart};
}

// Where along THROAT its faces are seen from, of the way from its first node.
static double seen_from(const struct network *network, int throat)
{
    const int32_t *ends = network->throat_nodes[throat];
    const unsigned walls = network->node_walls[ends[0]] & network->node_walls[ends[1]];
    return walls & (1u << WALL_OUTER | 1u << WALL_INNER) ? 0.5 : 0;
}

// Heights, so far from where the faces are seen from, AWAY from the first node.
static void raise_heights(struct open_section *section, double away)
{
    for (int k = 0; k < section->n_grain; k++)
        section->grain[k].height += away;
    for (int k = 0; k < section->n_overlap; k++)
        section->overlap[k].height += away;
}

void throat_polygon_fill(struct throat_polygon *polygon, const struct network *network,
                         const struct throat_sides *sides, int throat)
{
    const int64_t begin = sides->offset[throat];
    const int count = (int)(sides->offset[throat + 1] - begin);
    polygon->from_first = seen_from(network, throat);
    for (int k = 0; k < count; k++)
        polygon->face[k] =
            seen_face(network, sides, throat, begin + k, polygon->from_first);
    struct open_section *section = &polygon->section;
    section->n_grain = section->n_overlap = section->n_gap = 0;
    section->wall = section->area = 0;
    const struct vector along = direction(polygon->face, count);
    section->length = fmax(0, dot(along_throat(network, throat), along));
    polygon->axis[0] = any_across(along);
    polygon->axis[1] = cross(along, polygon->axis[0]);
    for (int k = 0; k < count; k++)
        add_face(polygon, &polygon->face[k], along);
    raise_heights(section, polygon->from_first * section->length);
}
