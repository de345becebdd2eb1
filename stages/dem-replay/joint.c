// SPDX-License-Identifier: GPL-3.0-or-later
#include "joint.h"

#include <string.h>

static struct displacement no_displacement(void)
{
    return (struct displacement){{0, 0, 0}, {0, 0, 0}};
}

// The surfaces' shear strain is that of the centres less (a_i turn_i + a_j turn_j) x n.
struct displacement joint_arm(const struct joint *joint, int end, int strain)
{
    const struct vector *axis = joint->axis;
    const double sign = end ? 1 : -1;
    struct displacement arm = no_displacement();
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
    const struct displacement i = first ? *first : no_displacement();
    const struct displacement j = second ? *second : no_displacement();
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

static void add_bond(const struct joint *joint, const double strain[STRAINS],
                     struct resistance *resistance)
{
    const double stiffness[STRAINS] = {joint->bond_along,  joint->bond_across,
                                       joint->bond_across, joint->bond_twist,
                                       joint->bond_bend,   joint->bond_bend};
    for (int k = 0; k < STRAINS; k++) {
        resistance->bond_load[k] = resistance->load[k] = stiffness[k] * strain[k];
        resistance->tangent[k] = stiffness[k];
    }
}

// Where the shear spring is free: where it was, or, for grains that come to touch,
// where on the straight way from the last equilibrium they did.
void joint_hold_friction(struct joint *joint, const double strain[STRAINS],
                         double share)
{
    const double before = joint->overlap - joint->strain[STRAIN_ALONG];
    const double after = joint->overlap - strain[STRAIN_ALONG];
    const double limit = joint->friction * joint->contact_along * fmax(after, 0);
    joint->slip_limit += share * (limit - joint->slip_limit);
    const double way = after > before ? -before / (after - before) : 1;
    for (int k = 0; k < 2; k++) {
        const double was = joint->strain[STRAIN_ACROSS + k];
        joint->anchor[k] = joint->contact.touches
                               ? joint->contact.anchor[k]
                               : was + way * (strain[STRAIN_ACROSS + k] - was);
    }
}

// Coulomb slip [K 4.25-4.26]. A spring that slides still resists what turns its
// direction.
static void add_shear(const struct joint *joint, const double strain[STRAINS],
                      struct resistance *resistance)
{
    const double stiffness = joint->contact_across;
    double trial[2];
    for (int k = 0; k < 2; k++)
        trial[k] = stiffness * (strain[STRAIN_ACROSS + k] - joint->anchor[k]);
    const double size = hypot(trial[0], trial[1]);
    const bool slips = size > joint->slip_limit;
    const double kept = slips ? joint->slip_limit / size : 1;
    for (int k = 0; k < 2; k++) {
        const double other = slips ? trial[1 - k] / size : 1;
        resistance->load[STRAIN_ACROSS + k] += kept * trial[k];
        resistance->tangent[STRAIN_ACROSS + k] += stiffness * kept * other * other;
        resistance->contact.anchor[k] = joint->anchor[k];
        if (slips) resistance->contact.anchor[k] += (1 - kept) * trial[k] / stiffness;
    }
    if (slips)
        resistance->tangent_across =
            -stiffness * kept * (trial[0] / size) * (trial[1] / size);
}

// [K 4.11-4.16]
static void add_contact(const struct joint *joint, const double strain[STRAINS],
                        struct resistance *resistance)
{
    const double overlap = joint->overlap - strain[STRAIN_ALONG];
    resistance->contact.touches = overlap >= 0;
    if (joint->contact_across > 0 && joint->slip_limit > 0)
        add_shear(joint, strain, resistance);
    else
        memcpy(resistance->contact.anchor, strain + STRAIN_ACROSS,
               sizeof resistance->contact.anchor);
    if (overlap < 0) return;
    resistance->load[STRAIN_ALONG] -= joint->contact_along * overlap;
    resistance->tangent[STRAIN_ALONG] += joint->contact_along;
}

struct resistance joint_resistance(const struct joint *joint,
                                   const double strain[STRAINS])
{
    struct resistance resistance = {.load = {0}};
    if (joint->is_gone) return resistance;
    if (joint->is_bonded) add_bond(joint, strain, &resistance);
    add_contact(joint, strain, &resistance);
    return resistance;
}

// With k^n A and k^s A known, A R^2 = 4 I = 2 J gives the stresses without A.
struct overload joint_overload(const struct joint *joint,
                               const double bond_load[STRAINS], double normal_strength,
                               double shear_strength)
{
    const double radius = joint->bond_radius, area = M_PI * radius * radius;
    const double bending = hypot(bond_load[STRAIN_BEND], bond_load[STRAIN_BEND + 1]);
    const double shear = hypot(bond_load[STRAIN_ACROSS], bond_load[STRAIN_ACROSS + 1]);
    const double twisting = fabs(bond_load[STRAIN_TWIST]);
    const double normal_stress =
        (bond_load[STRAIN_ALONG] + 4 * bending / radius) / area;
    const double shear_stress = (shear + 2 * twisting / radius) / area;
    return (struct overload){normal_stress / normal_strength,
                             shear_stress / shear_strength};
}
