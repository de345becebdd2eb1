// SPDX-License-Identifier: GPL-3.0-or-later
// The facet as the polygon of an open section (network/open_section.h). With n its unit
// normal, grain k stands at
//     height = (its centre - first centre) . n,
//     reach  = its distance from the line through the first centre along n,
// and has the angle of the facet at its corner. At a wall the polygon ends: it is a
// trapezium or a rectangle. What two grains, or a grain and a wall, cover twice is
// added back:
//     d = distance of the centres,   chord = (d^2 + r_i^2 - r_j^2) / (2 d)  from i.
#include "facet.h"

#include <math.h>

static void add_grain(const struct corner corner[3], int k, struct vector from,
                      const struct vector axis[3], struct open_section *section)
{
    const struct vector at = corner[k].at, away = subtract(at, from);
    const struct vector u = towards(at, &corner[(k + 1) % 3]);
    const struct vector v = towards(at, &corner[(k + 2) % 3]);
    const double across[2] = {dot(away, axis[0]), dot(away, axis[1])};
    section->grain[section->n_grain++] =
        (struct section_grain){.angle = atan2(norm(cross(u, v)), dot(u, v)),
                               .radius = corner[k].radius,
                               .height = dot(away, axis[2]),
                               .reach = hypot(across[0], across[1]),
                               .across = {across[0], across[1]}};
}

// How two grains, or a grain and a wall, overlap on the side from corner I to corner J.
static void add_overlap(const struct corner *i, const struct corner *j, double height,
                        struct open_section *section)
{
    if (is_wall(i) && is_wall(j)) return;
    const struct corner *grain = is_wall(i) ? j : i, *other = is_wall(i) ? i : j;
    const double r = grain->radius, s = other->radius;
    const double apart =
        is_wall(other) ? depth(other, grain->at) : distance(grain->at, other->at);
    if (!(r + s > apart)) return;
    const double chord =
        is_wall(other) ? apart : (apart + (r - s) * ((r + s) / apart)) / 2;
    section->overlap[section->n_overlap++] =
        (struct section_overlap){{chord, apart - chord}, {r, s}, height};
}

// The length of WALL in the facet that no grain covers; I and J are its other corners.
static double open_rim(const struct corner *wall, const struct corner *i,
                       const struct corner *j)
{
    const struct corner *pair[2] = {i, j};
    double rim = is_wall(i)   ? depth(i, j->at)
                 : is_wall(j) ? depth(j, i->at)
                              : norm(cross(subtract(j->at, i->at), wall->normal));
    for (int k = 0; k < 2; k++) {
        if (is_wall(pair[k])) continue;
        const double r = pair[k]->radius, deep = depth(wall, pair[k]->at);
        rim -= sqrt(fmax(0, r * r - deep * deep));
    }
    return fmax(0, rim);
}

struct throat_shape facet_section_shape(const struct corner corner[3],
                                        struct vector area, struct vector from,
                                        struct vector to, bool walls_resist)
{
    struct section_grain grain[3];
    struct section_overlap overlap[3];
    struct open_section section = {.area = norm(area),
                                   .length = distance(from, to),
                                   .grain = grain,
                                   .overlap = overlap};
    const struct vector normal = scale(1 / section.area, area);
    int first = 0;
    while (is_wall(&corner[first]))
        first++;
    const struct vector side = towards(corner[first].at, &corner[(first + 1) % 3]);
    const struct vector along = scale(1 / norm(side), side);
    const struct vector axis[3] = {along, cross(normal, along), normal};
    const double height = dot(subtract(corner[first].at, from), normal);
    for (int k = 0; k < 3; k++) {
        const struct corner *next = &corner[(k + 1) % 3], *last = &corner[(k + 2) % 3];
        add_overlap(&corner[k], next, height, &section);
        if (!is_wall(&corner[k]))
            add_grain(corner, k, from, axis, &section);
        else if (walls_resist)
            section.wall += open_rim(&corner[k], next, last);
    }
    return section_shape(&section);
}
