// SPDX-License-Identifier: GPL-3.0-or-later
// The volume that each facet sweeps per time, less that swept of the grains' sectors
// in it [C 5]. A facet between three grains moves as the plane through their centres:
// the normal velocity at barycentric coordinates (a, b) is linear, so
//     swept = area (v_0 + v_1 + v_2) / 3
//             - sum over grains of (a (v_j - v_k) + b (v_l - v_k)),
// with a and b from the first moment of each sector, 2/3 R^3 sin(angle / 2) along its
// bisector. Rigid motion of a grain along the normal sweeps no fluid of its own
// sector, which is why only differences appear. At walls the facet stays perpendicular
// to the wall; upper walls move with the strain rate of the box. Where the box repeats,
// the second pore of a throat may lie IMAGE boxes away, which move as a whole with the
// strain: seen from there the facet sweeps less by area . (rate image edge).
#include "pore_volume_rate.h"

#include "basics/memory.h"
#include "facet.h"

struct motion {
    struct corner corner[3];
    struct vector velocity[3]; // of grains
    struct vector normal;      // of the facet, of unit length
    double area;
};

// First moment of a grain's sector between two directions, about the grain's centre.
static struct vector sector_moment(double radius, struct vector u, struct vector v)
{
    const struct vector along =
        add(scale(1 / norm(u), u), scale(1 / norm(v), v)); // |along| = 2 cos(angle/2)
    const double angle = atan2(norm(cross(u, v)), dot(u, v));
    const double size = norm(along);
    if (!(size > 0)) return (struct vector){0, 0, 0};
    return scale(2.0 / 3 * radius * radius * radius * sin(angle / 2) / size, along);
}

// Three grains: the facet stays a triangle. Relative to a grain's sector it rotates
// about the grain's centre.
static double swept_triangle(const struct motion *motion)
{
    double mean = 0, solid = 0;
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3, l = (k + 2) % 3;
        const struct vector at = motion->corner[k].at;
        const struct vector u = subtract(motion->corner[j].at, at),
                            v = subtract(motion->corner[l].at, at);
        const struct vector moment = sector_moment(motion->corner[k].radius, u, v);
        const double a = dot(cross(moment, v), motion->normal) / (2 * motion->area);
        const double b = dot(cross(u, moment), motion->normal) / (2 * motion->area);
        const double here = dot(motion->velocity[k], motion->normal);
        mean += here / 3;
        solid += a * (dot(motion->velocity[j], motion->normal) - here) +
                 b * (dot(motion->velocity[l], motion->normal) - here);
    }
    return motion->area * mean - solid;
}

// Two grains and wall K: the facet stays perpendicular to the wall.
static double swept_at_wall(const struct motion *motion, int k)
{
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const struct corner *wall = &motion->corner[k];
    const struct vector from = motion->corner[i].at, to = motion->corner[j].at;
    const struct vector step = subtract(to, from);
    const struct vector along =
        subtract(step, scale(dot(step, wall->normal), wall->normal));
    const double length = norm(along);
    const double h = wall->plane - dot(wall->normal, from),
                 g = wall->plane - dot(wall->normal, to);
    const double v = dot(motion->velocity[i], motion->normal),
                 w = dot(motion->velocity[j], motion->normal);
    const struct vector moment =
        add(sector_moment(motion->corner[i].radius, step, wall->normal),
            sector_moment(motion->corner[j].radius, scale(-1, step), wall->normal));
    const double solid = dot(moment, along) / (length * length) * (w - v);
    return length * (v * h / 3 + (v * g + w * h) / 6 + w * g / 3) - solid;
}

static double swept_by(const struct motion *motion)
{
    int walls = 0, wall = 0, grain = 0;
    for (int k = 0; k < 3; k++) {
        const bool is_wall = motion->corner[k].radius <= 0;
        walls += is_wall;
        *(is_wall ? &wall : &grain) = k;
    }
    if (!(motion->area > 0)) return 0;
    if (walls == 0) return swept_triangle(motion);
    if (walls == 1) return swept_at_wall(motion, wall);
    return motion->area * dot(motion->velocity[grain], motion->normal);
}

static struct vector stretched(const struct grains *grains, struct vector velocity,
                               struct image image, struct vector rate)
{
    return add(velocity, (struct vector){rate.x * image.along[0] * grains->box.x,
                                         rate.y * image.along[1] * grains->box.y,
                                         rate.z * image.along[2] * grains->box.z});
}

static int facet_between(const struct pore_cell *cell, const struct throat *throat)
{
    for (int k = 0; k < 4; k++)
        if (cell->neighbour[k] == throat->cell[1] &&
            same_image(cell->neighbour_image[k], throat->image) &&
            cell->corner[facet_corner[k][0]] == throat->corner[0] &&
            cell->corner[facet_corner[k][1]] == throat->corner[1] &&
            cell->corner[facet_corner[k][2]] == throat->corner[2])
            return k;
    return 0;
}

static struct motion motion_of(const struct grains *grains,
                               const struct pore_cell *cell,
                               const struct throat *throat,
                               const struct vector *velocity, struct vector rate)
{
    struct motion motion = {.area = norm(throat->area)};
    const int facet = facet_between(cell, throat);
    for (int k = 0; k < 3; k++) {
        const int place = facet_corner[facet][k];
        motion.corner[k] = facet_corner_of(grains, cell, facet, k);
        if (cell->corner[place] >= 0)
            motion.velocity[k] = stretched(grains, velocity[cell->corner[place]],
                                           cell->corner_image[place], rate);
    }
    if (motion.area > 0) motion.normal = scale(1 / motion.area, throat->area);
    return motion;
}

// The volume swept by the walls that close the cell at one end of a throat; their area
// is that of the facet along the wall's normal (forces.c).
static double swept_wall(const struct grains *grains, const struct pore_cell *cell,
                         const struct throat *throat, int end, struct vector rate)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const int32_t corner = cell->corner[k];
        const int wall = -1 - corner, axis = wall / 2;
        if (corner >= 0 || corner == throat->corner[0] || corner == throat->corner[1] ||
            corner == throat->corner[2] || wall % 2 == 0)
            continue; // lower walls stand still
        const double area = component(throat->area, axis) * (end == 0 ? -1 : 1);
        sum += area * component(rate, axis) * component(grains->box, axis);
    }
    return sum;
}

double *opening_rates(const struct grains *grains, const struct cells *cells,
                      const struct throats *throats, const struct vector *velocity,
                      struct vector rate)
{
    double *opening = NEW_ARRAY(double, cells->n_pore);
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        const struct pore_cell *cell[2] = {&cells->cell[throat->cell[0]],
                                           &cells->cell[throat->cell[1]]};
        const struct motion motion = motion_of(grains, cell[0], throat, velocity, rate);
        const double swept = swept_by(&motion);
        const double carried = dot(
            throat->area, stretched(grains, (struct vector){0}, throat->image, rate));
        for (int end = 0; end < 2; end++)
            opening[cell[end]->pore] +=
                (end == 0 ? swept : carried - swept) +
                swept_wall(grains, cell[end], throat, end, rate);
    }
    return opening;
}
