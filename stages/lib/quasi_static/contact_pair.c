// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_pair.h"

#include <string.h>

// The surfaces' shear strain is that of the centres less (a_i turn_i + a_j turn_j) x n.
struct displacement joint_arm(const struct joint *joint, int end, int strain)
{
    const struct vector *axis = joint->axis;
    const double sign = end ? 1 : -1;
    struct displacement arm = no_displacement;
    switch (strain) {
    case STRAIN_ALONG:
        arm.shift = scale(sign, axis[0]);
        break;
    case STRAIN_ACROSS:
        arm.shift = scale(sign, axis[1]);
        arm.turn = scale(-joint->arm[end], axis[2]);
        break;
    case STRAIN_ACROSS + 1:
        arm.shift = scale(sign, axis[2]);
        arm.turn = scale(joint->arm[end], axis[1]);
        break;
    default:
        arm.turn = scale(sign, axis[strain - STRAIN_TWIST]);
    }
    return arm;
}

void joint_strains(const struct joint *joint, const struct displacement *first,
                   const struct displacement *second, double strain[STRAINS])
{
    const struct vector *axis = joint->axis;
    const struct displacement i = first ? *first : no_displacement;
    const struct displacement j = second ? *second : no_displacement;
    const struct vector shift = subtract(j.shift, i.shift);
    const struct vector turn = subtract(j.turn, i.turn);
    const struct vector rolling =
        add(scale(joint->arm[0], i.turn), scale(joint->arm[1], j.turn));
    strain[STRAIN_ALONG] = dot(axis[0], shift);
    strain[STRAIN_ACROSS] = dot(axis[1], shift) - dot(axis[2], rolling);
    strain[STRAIN_ACROSS + 1] = dot(axis[2], shift) + dot(axis[1], rolling);
    for (int k = 0; k < 3; k++)
        strain[STRAIN_TWIST + k] = dot(axis[k], turn);
}

struct displacement joint_loads(const struct joint *joint, int end,
                                const double load[STRAINS])
{
    const struct vector *axis = joint->axis;
    const double sign = end ? 1 : -1, arm = joint->arm[end];
    const struct vector across = add(scale(load[STRAIN_ACROSS], axis[1]),
                                     scale(load[STRAIN_ACROSS + 1], axis[2]));
    const struct vector turning = add(scale(load[STRAIN_ACROSS + 1], axis[1]),
                                      scale(-load[STRAIN_ACROSS], axis[2]));
    struct vector moment = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        moment = add(moment, scale(load[STRAIN_TWIST + k], axis[k]));
    return (struct displacement){
        scale(sign, add(scale(load[STRAIN_ALONG], axis[0]), across)),
        add(scale(arm, turning), scale(sign, moment))};
}

void joint_take_off(const struct joint *joint, const double load[STRAINS],
                    struct displacement *left)
{
    for (int end = 0; end < 2; end++) {
        if (joint->grain[end] < 0) continue;
        const struct displacement part = joint_loads(joint, end, load);
        struct displacement *of = &left[joint->grain[end]];
        of->shift = subtract(of->shift, part.shift);
        of->turn = subtract(of->turn, part.turn);
    }
}

static void add_bond(const struct joint *joint, const double strain[STRAINS],
                     struct resistance *resistance)
{
    for (int k = 0; k < STRAINS; k++)
        resistance->load[k] = joint->bond_stiffness[k] * strain[k];
    resistance->load[STRAIN_ALONG] -=
        joint->bond_stiffness[STRAIN_ALONG] * joint->point_overlap;
    for (int k = 0; k < 3; k++) {
        resistance->slope[k][k] = joint->bond_stiffness[k];
        resistance->stiffness[k] = joint->bond_stiffness[3 + k];
    }
}

// The shear spring of a contact: what it would pull if nothing slipped, and as is
// judged; what it can hold, and as is judged.
struct spring {
    double free[2], trial[2], limit, judged_limit;
};

// Coulomb slip [K 4.25-4.26]: the limit falls as the grains part. One that slides still
// resists what turns its direction.
static void slide(const struct joint *joint, const struct judgement *judgement,
                  const struct spring *spring, struct resistance *resistance)
{
    const double *trial = spring->trial, limit = spring->limit;
    const double size = sqrt(trial[0] * trial[0] + trial[1] * trial[1]);
    const double along[2] = {trial[0] / size, trial[1] / size};
    const double held = spring->judged_limit / size;
    const double turned = 1 - (1 - judgement->share) * held;
    const double kept = judgement->share * held * joint->contact_across / turned;
    const double pull = along[0] * judgement->pull[0] + along[1] * judgement->pull[1];
    for (int k = 0; k < 2; k++) {
        double *slope = resistance->slope[STRAIN_ACROSS + k];
        slope[STRAIN_ALONG] -= joint->friction * joint->contact_along * along[k];
        for (int l = 0; l < 2; l++)
            slope[STRAIN_ACROSS + l] += kept * ((k == l) - along[k] * along[l]);
        resistance->load[STRAIN_ACROSS + k] +=
            limit * along[k] +
            (1 - 1 / turned) * (judgement->pull[k] - pull * along[k]);
        resistance->contact.anchor[k] +=
            (1 - limit / size) * trial[k] / joint->contact_across;
    }
    resistance->contact.touch = TOUCH_SLIPS;
}

static void stick(const struct joint *joint, const struct spring *spring,
                  struct resistance *resistance)
{
    resistance->contact.touch = TOUCH_STICKS;
    for (int k = 0; k < 2; k++) {
        resistance->load[STRAIN_ACROSS + k] += spring->free[k];
        resistance->slope[STRAIN_ACROSS + k][STRAIN_ACROSS + k] +=
            joint->contact_across;
    }
}

// Grains that come to touch do so without shear: their spring is free where they are
// when all is balanced.
static void add_shear(const struct joint *joint, const double strain[STRAINS],
                      double overlap, const struct judgement *judgement,
                      struct resistance *resistance)
{
    const double share = judgement->share;
    struct spring spring = {.limit = joint->friction * joint->contact_along * overlap};
    spring.judged_limit = joint->friction * joint->contact_along *
                          (share * overlap + (1 - share) * judgement->overlap);
    double *anchor = resistance->contact.anchor, *trial = spring.trial;
    if (joint->contact.touch == TOUCH_NONE) {
        resistance->contact.touch = TOUCH_BEGINS;
        memcpy(anchor, strain + STRAIN_ACROSS, 2 * sizeof *anchor);
        return;
    }
    for (int k = 0; k < 2; k++) {
        anchor[k] = joint->contact.anchor[k];
        spring.free[k] =
            joint->contact_across * (strain[STRAIN_ACROSS + k] - anchor[k]);
        trial[k] = share * spring.free[k] + (1 - share) * judgement->pull[k];
    }
    // One that slid lies where it begins to: it goes on, until it is seen to stick.
    const double edge = joint->contact.touch == TOUCH_SLIPS ? 1 - 1e-11 : 1;
    if (sqrt(trial[0] * trial[0] + trial[1] * trial[1]) > edge * spring.judged_limit)
        slide(joint, judgement, &spring, resistance);
    else
        stick(joint, &spring, resistance);
}

// [K 4.11-4.16]
static void add_contact(const struct joint *joint, const double strain[STRAINS],
                        const struct judgement *judgement,
                        struct resistance *resistance)
{
    const double overlap = joint->overlap - strain[STRAIN_ALONG];
    if (overlap < 0) return;
    resistance->load[STRAIN_ALONG] -= joint->contact_along * overlap;
    resistance->slope[STRAIN_ALONG][STRAIN_ALONG] += joint->contact_along;
    add_shear(joint, strain, overlap, judgement, resistance);
}

struct resistance joint_softened(const struct joint *joint,
                                 const double strain[STRAINS],
                                 const struct judgement *judgement)
{
    struct resistance resistance = {.contact.touch = TOUCH_NONE};
    if (joint->is_gone) return resistance;
    if (joint->is_bonded) add_bond(joint, strain, &resistance);
    add_contact(joint, strain, judgement, &resistance);
    return resistance;
}

struct resistance joint_resistance(const struct joint *joint,
                                   const double strain[STRAINS])
{
    return joint_softened(joint, strain, &(struct judgement){.share = 1});
}

void joint_break(struct joint *joint, const double strain[STRAINS])
{
    joint->is_bonded = false;
    if (!joint->is_point) return;
    joint->overlap = joint->point_overlap;
    joint->contact = (struct contact){TOUCH_NONE, {0, 0}};
    if (joint->overlap - strain[STRAIN_ALONG] >= 0) joint->contact.touch = TOUCH_STICKS;
}

// In units in which numbers are far from their ends: no need of hypot.
static double size_of_two(const double a[2])
{
    return sqrt(a[0] * a[0] + a[1] * a[1]);
}

static struct overload point_overload(const struct joint *joint,
                                      const double strain[STRAINS],
                                      double normal_strength, double shear_strength)
{
    const double *stiffness = joint->bond_stiffness;
    const double tension =
        stiffness[STRAIN_ALONG] * (strain[STRAIN_ALONG] - joint->point_overlap);
    const double shear = stiffness[STRAIN_ACROSS] * size_of_two(strain + STRAIN_ACROSS);
    return (struct overload){tension / normal_strength, shear / shear_strength};
}

// With k^n A and k^s A known, A R^2 = 4 I = 2 J gives the stresses without A.
struct overload joint_overload(const struct joint *joint, const double strain[STRAINS],
                               double normal_strength, double shear_strength)
{
    if (joint->is_point)
        return point_overload(joint, strain, normal_strength, shear_strength);
    const double *stiffness = joint->bond_stiffness;
    const double beta = 1 - joint->moments_left_out;
    const double radius = joint->bond_radius, area = M_PI * radius * radius;
    const double bending = stiffness[STRAIN_BEND] * size_of_two(strain + STRAIN_BEND);
    const double shear = stiffness[STRAIN_ACROSS] * size_of_two(strain + STRAIN_ACROSS);
    const double twisting = stiffness[STRAIN_TWIST] * fabs(strain[STRAIN_TWIST]);
    const double tension = stiffness[STRAIN_ALONG] * strain[STRAIN_ALONG];
    return (struct overload){
        (tension + beta * 4 * bending / radius) / area / normal_strength,
        (shear + beta * 2 * twisting / radius) / area / shear_strength};
}
