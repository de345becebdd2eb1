// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness in units of `stiffness`, lengths in units of `length`:
//     contact of two grains in series k/2, with the wall k [K 4.22];
//     parallel bond of radius R = radius_fraction min(r_i, r_j), A = pi R^2, I = A
//     R^2/4, J = A R^2/2: normal k^n A, shear k^s A, torsion k^s J, bending k^n I
//     [K 4.32-4.39]; contact bond: the springs of the contact, and against torsion and
//     bending `rolling` times the shear stiffness times both arms.
//
// Pairs in this order: bonds as listed, then near grains without a bond, then grains
// near the bottom wall. The order fixes that of all sums.
#include "make_contact_pairs.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <stdlib.h>

// The tangents are any two: from the axis of coordinates that is most across n, so that
// the cross product is well away from 0.
static void find_axes(struct contact_pair *pair, struct vector separation)
{
    struct vector *axis = pair->axis;
    axis[0] = scale(1 / norm(separation), separation);
    const double x = fabs(axis[0].x), y = fabs(axis[0].y), z = fabs(axis[0].z);
    const struct vector least = x <= y && x <= z ? (struct vector){1, 0, 0}
                                : y <= z         ? (struct vector){0, 1, 0}
                                                 : (struct vector){0, 0, 1};
    const struct vector across = cross(axis[0], least);
    axis[1] = scale(1 / norm(across), across);
    axis[2] = cross(axis[0], axis[1]);
}

// Overlaps within the rounding of coordinates are none, as in the engine [K 4.8].
static double overlap_of(const struct contact_pair_setup *setup, double overlap)
{
    const struct packing *packing = setup->packing;
    double largest = 0;
    for (int axis = 0; axis < 3; axis++)
        largest = fmax(largest, fmax(fabs(component(packing->lower, axis)),
                                     fabs(component(packing->upper, axis))));
    return fabs(overlap) <= 16 * 0x1p-53 * largest / setup->length ? 0 : overlap;
}

// [K 4.22], FRACTION of the stiffness of a grain.
static struct contact_pair in_contact(const struct contact_pair_setup *setup,
                                      struct contact_pair pair, double fraction)
{
    const struct dem_material *material = setup->material;
    pair.friction = material->friction;
    pair.normal_stiffness = fraction * material->normal_stiffness / setup->stiffness;
    if (pair.friction > 0)
        pair.shear_stiffness = fraction * material->shear_stiffness / setup->stiffness;
    pair.contact.state = pair.overlap >= 0 ? CONTACT_STICKING : CONTACT_OPEN;
    return pair;
}

// The contact point lies halfway into the overlap [K 4.9]; arms are those of the start
// also where an overlap does not push.
struct contact_pair grain_pair(const struct contact_pair_setup *setup, int i, int j,
                               struct vector separation)
{
    const struct packing *packing = setup->packing;
    const double r[2] = {packing->radius[i] / setup->length,
                         packing->radius[j] / setup->length};
    struct contact_pair pair = {.grain = {i, j}, .bond = -1};
    find_axes(&pair, separation);
    pair.overlap = overlap_of(setup, r[0] + r[1] - norm(separation) / setup->length);
    for (int end = 0; end < 2; end++)
        pair.arm[end] = r[end] - 0.5 * pair.overlap;
    if (setup->unstressed) pair.overlap = fmin(pair.overlap, 0);
    return in_contact(setup, pair, 0.5); // two grains in series
}

struct contact_pair wall_pair(const struct contact_pair_setup *setup, int i)
{
    const struct packing *packing = setup->packing;
    const double radius = packing->radius[i] / setup->length;
    const double height = (packing->position[i].z - packing->lower.z) / setup->length;
    struct contact_pair pair = {.grain = {i, -1}, .bond = -1};
    find_axes(&pair, (struct vector){0, 0, -1});
    pair.overlap = overlap_of(setup, radius - height);
    pair.arm[0] = radius - 0.5 * pair.overlap; // as in the engine
    if (setup->unstressed) pair.overlap = fmin(pair.overlap, 0);
    return in_contact(setup, pair, 1);
}

// The contact itself is open as long as the bond holds. Grains that only such bonds
// join could turn about each other as gears do: `rolling` resists that.
static void bond_at_point(const struct contact_pair_setup *setup,
                          struct contact_pair *pair, int bond)
{
    pair->bond = bond;
    pair->is_bonded = pair->is_point = true;
    pair->bond_stiffness[NORMAL] = pair->normal_stiffness;
    for (int k = 0; k < 2; k++)
        pair->bond_stiffness[SHEAR + k] =
            0.5 * setup->material->shear_stiffness / setup->stiffness;
    for (int k = TORSION; k < COMPONENTS; k++)
        pair->bond_stiffness[k] =
            setup->rolling * pair->bond_stiffness[SHEAR] * pair->arm[0] * pair->arm[1];
    pair->free_stretch = pair->overlap;
    pair->overlap = -INFINITY;
    pair->contact.state = CONTACT_OPEN;
}

// Stiffness per area times A, and I / A = R^2/4, J / A = R^2/2.
static void bond_in_parallel(const struct contact_pair_setup *setup,
                             struct contact_pair *pair, int bond)
{
    const double *radius = setup->packing->radius;
    const double smaller = fmin(radius[pair->grain[0]], radius[pair->grain[1]]);
    const double r = setup->bond->radius_fraction * smaller / setup->length;
    const double per_area = setup->length * setup->length / setup->stiffness;
    const double along = setup->bond->normal_stiffness * per_area;
    const double across = setup->bond->shear_stiffness * per_area;
    const double area = M_PI * r * r;
    pair->bond = bond;
    pair->is_bonded = true;
    pair->bond_radius = r;
    pair->moments_left_out = setup->bond->moments_left_out;
    const double twist = r * r / 2, bend = r * r / 4; // J / A, I / A
    const double stiffness[COMPONENTS] = {along,          across,       across,
                                          across * twist, along * bend, along * bend};
    for (int k = 0; k < COMPONENTS; k++)
        pair->bond_stiffness[k] = stiffness[k] * area;
}

struct pair_list {
    struct contact_pair *pair;
    int count, capacity;
};

static void append(struct pair_list *list, struct contact_pair pair)
{
    GROW_ARRAY(list->pair, list->count, list->capacity);
    list->pair[list->count++] = pair;
}

static void add_bonds(const struct contact_pair_setup *setup, struct pair_list *list)
{
    const struct packing *packing = setup->packing;
    for (int b = 0; b < packing->n_bond; b++) {
        const int i = packing->bond[b][0], j = packing->bond[b][1];
        struct contact_pair pair =
            grain_pair(setup, i, j, nearest_image(packing, i, j));
        if (setup->bond->kind == DEM_CONTACT_BOND)
            bond_at_point(setup, &pair, b);
        else
            bond_in_parallel(setup, &pair, b);
        append(list, pair);
    }
}

// From the centre, m: its surface, and as far again as it may move.
static double reach_of(const struct contact_pair_setup *setup, int i)
{
    const double radius = setup->packing->radius[i];
    return radius + SEARCH_RANGE * fmax(radius, setup->length);
}

// Bonded grains are pairs already. Both lists are sorted alike.
static void add_near(const struct contact_pair_setup *setup, struct pair_list *list)
{
    const struct packing *packing = setup->packing;
    int32_t(*bonded)[2] =
        duplicate(packing->bond, (size_t)packing->n_bond, sizeof *bonded);
    if (packing->n_bond > 0)
        qsort(bonded, (size_t)packing->n_bond, sizeof *bonded, compare_pairs);
    double *reach = NEW_ARRAY(double, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        reach[i] = reach_of(setup, i);
    int n_near;
    int32_t(*near)[2] = reaching_pairs(packing, reach, &n_near);
    free(reach);
    for (int k = 0; k < n_near; k++) {
        if (packing->n_bond > 0 && bsearch(near[k], bonded, (size_t)packing->n_bond,
                                           sizeof *bonded, compare_pairs))
            continue;
        append(list, grain_pair(setup, near[k][0], near[k][1],
                                nearest_image(packing, near[k][0], near[k][1])));
    }
    free(near);
    free(bonded);
}

// The wall is the lower side of the box along z, as for the engine in time steps.
static void add_wall(const struct contact_pair_setup *setup, struct pair_list *list)
{
    const struct packing *packing = setup->packing;
    for (int i = 0; i < packing->n_particle; i++) {
        const double height = packing->position[i].z - packing->lower.z;
        if (height <= reach_of(setup, i)) append(list, wall_pair(setup, i));
    }
}

struct contact_pair *make_contact_pairs(const struct contact_pair_setup *setup,
                                        int *count)
{
    struct pair_list list = {0};
    add_bonds(setup, &list);
    add_near(setup, &list);
    if (setup->has_wall) add_wall(setup, &list);
    *count = list.count;
    return list.pair;
}
