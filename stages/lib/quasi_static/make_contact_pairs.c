// SPDX-License-Identifier: GPL-3.0-or-later
#include "make_contact_pairs.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <stdlib.h>

static void find_axes(struct joint *joint, struct vector separation)
{
    struct vector *axis = joint->axis;
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
static double overlap_of(const struct joint_setup *setup, double overlap)
{
    const struct packing *packing = setup->packing;
    double furthest = 0;
    for (int axis = 0; axis < 3; axis++)
        furthest = fmax(furthest, fmax(fabs(component(packing->lower, axis)),
                                       fabs(component(packing->upper, axis))));
    return fabs(overlap) <= 16 * 0x1p-53 * furthest / setup->length ? 0 : overlap;
}

// [K 4.22], SHARE of the stiffness of a grain.
static struct joint in_contact(const struct joint_setup *setup, struct joint joint,
                               double share)
{
    const struct dem_material *material = setup->material;
    joint.friction = material->friction;
    joint.contact_along = share * material->normal_stiffness / setup->stiffness;
    if (joint.friction > 0)
        joint.contact_across = share * material->shear_stiffness / setup->stiffness;
    joint.contact.touch = joint.overlap >= 0 ? TOUCH_STICKS : TOUCH_NONE;
    return joint;
}

struct joint contact_joint(const struct joint_setup *setup, int i, int j,
                           struct vector separation)
{
    const struct packing *packing = setup->packing;
    const double r[2] = {packing->radius[i] / setup->length,
                         packing->radius[j] / setup->length};
    struct joint joint = {.grain = {i, j}, .bond = -1};
    find_axes(&joint, separation);
    joint.overlap = overlap_of(setup, r[0] + r[1] - norm(separation) / setup->length);
    for (int end = 0; end < 2; end++)
        joint.arm[end] = r[end] - 0.5 * joint.overlap;
    if (setup->unstressed) joint.overlap = fmin(joint.overlap, 0);
    return in_contact(setup, joint, 0.5); // two grains in series
}

struct joint wall_joint(const struct joint_setup *setup, int i)
{
    const struct packing *packing = setup->packing;
    const double radius = packing->radius[i] / setup->length;
    const double height = (packing->position[i].z - packing->lower.z) / setup->length;
    struct joint joint = {.grain = {i, -1}, .bond = -1};
    find_axes(&joint, (struct vector){0, 0, -1});
    joint.overlap = overlap_of(setup, radius - height);
    joint.arm[0] = radius - 0.5 * joint.overlap; // as in the engine
    if (setup->unstressed) joint.overlap = fmin(joint.overlap, 0);
    return in_contact(setup, joint, 1);
}

// The contact's own springs [K 4.2], which as long as it holds nothing else joins.
// Grains that only such points join turn about each other as gears do, and nothing says
// how far: something must resist that.
static void point_joint(const struct joint_setup *setup, struct joint *joint, int bond)
{
    joint->bond = bond;
    joint->is_bonded = joint->is_point = true;
    joint->bond_stiffness[STRAIN_ALONG] = joint->contact_along;
    for (int k = 0; k < 2; k++)
        joint->bond_stiffness[STRAIN_ACROSS + k] =
            0.5 * setup->material->shear_stiffness / setup->stiffness;
    for (int k = STRAIN_TWIST; k < STRAINS; k++)
        joint->bond_stiffness[k] = setup->rolling *
                                   joint->bond_stiffness[STRAIN_ACROSS] *
                                   joint->arm[0] * joint->arm[1];
    joint->point_overlap = joint->overlap;
    joint->overlap = -INFINITY;
    joint->contact.touch = TOUCH_NONE;
}

static void bond_joint(const struct joint_setup *setup, struct joint *joint, int bond)
{
    const double *radius = setup->packing->radius;
    const double smaller = fmin(radius[joint->grain[0]], radius[joint->grain[1]]);
    const double r = setup->bond->radius_fraction * smaller / setup->length;
    const double per_area = setup->length * setup->length / setup->stiffness;
    const double along = setup->bond->normal_stiffness * per_area;
    const double across = setup->bond->shear_stiffness * per_area;
    const double area = M_PI * r * r;
    joint->bond = bond;
    joint->is_bonded = true;
    joint->bond_radius = r;
    joint->moments_left_out = setup->bond->moments_left_out;
    const double twist = r * r / 2, bend = r * r / 4; // J / A, I / A
    const double stiffness[STRAINS] = {along,          across,       across,
                                       across * twist, along * bend, along * bend};
    for (int k = 0; k < STRAINS; k++)
        joint->bond_stiffness[k] = stiffness[k] * area;
}

struct joint_list {
    struct joint *joint;
    int count, capacity;
};

static void append(struct joint_list *list, struct joint joint)
{
    GROW_ARRAY(list->joint, list->count, list->capacity);
    list->joint[list->count++] = joint;
}

static void add_bonds(const struct joint_setup *setup, struct joint_list *list)
{
    const struct packing *packing = setup->packing;
    for (int b = 0; b < packing->n_bond; b++) {
        const int i = packing->bond[b][0], j = packing->bond[b][1];
        struct joint joint = contact_joint(setup, i, j, nearest_image(packing, i, j));
        if (setup->bond->kind == DEM_CONTACT_BOND)
            point_joint(setup, &joint, b);
        else
            bond_joint(setup, &joint, b);
        append(list, joint);
    }
}

static void add_near(const struct joint_setup *setup, struct joint_list *list)
{
    const struct packing *packing = setup->packing;
    int32_t(*bonded)[2] =
        duplicate(packing->bond, (size_t)packing->n_bond, sizeof *bonded);
    if (packing->n_bond > 0)
        qsort(bonded, (size_t)packing->n_bond, sizeof *bonded, compare_pairs);
    int n_near;
    int32_t(*near)[2] = neighbour_pairs(packing, joint_reach, &n_near);
    for (int k = 0; k < n_near; k++) {
        if (packing->n_bond > 0 && bsearch(near[k], bonded, (size_t)packing->n_bond,
                                           sizeof *bonded, compare_pairs))
            continue;
        append(list, contact_joint(setup, near[k][0], near[k][1],
                                   nearest_image(packing, near[k][0], near[k][1])));
    }
    free(near);
    free(bonded);
}

static void add_wall(const struct joint_setup *setup, struct joint_list *list)
{
    const struct packing *packing = setup->packing;
    for (int i = 0; i < packing->n_particle; i++) {
        const double height = packing->position[i].z - packing->lower.z;
        if (height <= (1 + joint_reach) * packing->radius[i])
            append(list, wall_joint(setup, i));
    }
}

struct joint *make_joints(const struct joint_setup *setup, int *count)
{
    struct joint_list list = {0};
    add_bonds(setup, &list);
    add_near(setup, &list);
    if (setup->has_wall) add_wall(setup, &list);
    *count = list.count;
    return list.joint;
}
