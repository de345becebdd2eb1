// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation d = B u of a pair, from translations x and rotations w of its grains i
// and j, with n, t1, t2 its axes and a_i, a_j the arms [K 4.7, 4.15, 4.17]:
//     d[NORMAL]    = n . (x_j - x_i)
//     d[SHEAR]     = t1 . (x_j - x_i) - t2 . (a_i w_i + a_j w_j)
//     d[SHEAR + 1] = t2 . (x_j - x_i) + t1 . (a_i w_i + a_j w_j)
//     d[TORSION], d[BENDING], d[BENDING + 1] = n, t1, t2 . (w_j - w_i)
// Load: of the bond, bond_stiffness d [K 4.32-4.39], d[NORMAL] less free_stretch; of
// the contact, where the overlap o = overlap - d[NORMAL] is not negative, a normal
// force -normal_stiffness o and a shear force shear_stiffness (d - anchor) of at most
// friction normal_stiffness o; slip moves the anchor [K 4.11-4.26]. The grains feel B^T
// load.
#include "contact_pair.h"

#include <string.h>

struct displacement pair_kinematic_row(const struct contact_pair *pair, int end,
                                       int component)
{
    const struct vector *axis = pair->axis;
    const double sign = end ? 1 : -1;
    struct displacement arm = no_displacement;
    switch (component) {
    case NORMAL:
        arm.translation = scale(sign, axis[0]);
        break;
    case SHEAR:
        arm.translation = scale(sign, axis[1]);
        arm.rotation = scale(-pair->arm[end], axis[2]);
        break;
    case SHEAR + 1:
        arm.translation = scale(sign, axis[2]);
        arm.rotation = scale(pair->arm[end], axis[1]);
        break;
    default:
        arm.rotation = scale(sign, axis[component - TORSION]);
    }
    return arm;
}

void pair_deformation(const struct contact_pair *pair, const struct displacement *first,
                      const struct displacement *second, double deformation[COMPONENTS])
{
    const struct vector *axis = pair->axis;
    const struct displacement i = first ? *first : no_displacement;
    const struct displacement j = second ? *second : no_displacement;
    const struct vector shift = subtract(j.translation, i.translation);
    const struct vector turn = subtract(j.rotation, i.rotation);
    const struct vector rolling =
        add(scale(pair->arm[0], i.rotation), scale(pair->arm[1], j.rotation));
    deformation[NORMAL] = dot(axis[0], shift);
    deformation[SHEAR] = dot(axis[1], shift) - dot(axis[2], rolling);
    deformation[SHEAR + 1] = dot(axis[2], shift) + dot(axis[1], rolling);
    for (int k = 0; k < 3; k++)
        deformation[TORSION + k] = dot(axis[k], turn);
}

struct displacement pair_load_on_grain(const struct contact_pair *pair, int end,
                                       const double load[COMPONENTS])
{
    const struct vector *axis = pair->axis;
    const double sign = end ? 1 : -1, arm = pair->arm[end];
    const struct vector across =
        add(scale(load[SHEAR], axis[1]), scale(load[SHEAR + 1], axis[2]));
    const struct vector turning =
        add(scale(load[SHEAR + 1], axis[1]), scale(-load[SHEAR], axis[2]));
    struct vector moment = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        moment = add(moment, scale(load[TORSION + k], axis[k]));
    return (struct displacement){scale(sign, add(scale(load[NORMAL], axis[0]), across)),
                                 add(scale(arm, turning), scale(sign, moment))};
}

void pair_subtract_load(const struct contact_pair *pair, const double load[COMPONENTS],
                        struct displacement *residual)
{
    for (int end = 0; end < 2; end++)
        if (pair->grain[end] >= 0)
            displacement_subtract(&residual[pair->grain[end]],
                                  pair_load_on_grain(pair, end, load));
}

static void add_bond(const struct contact_pair *pair,
                     const double deformation[COMPONENTS],
                     struct pair_response *response)
{
    for (int k = 0; k < COMPONENTS; k++)
        response->load[k] = pair->bond_stiffness[k] * deformation[k];
    response->load[NORMAL] -= pair->bond_stiffness[NORMAL] * pair->free_stretch;
    for (int k = 0; k < 3; k++) {
        response->slope[k][k] = pair->bond_stiffness[k];
        response->stiffness[k] = pair->bond_stiffness[3 + k];
    }
}

// The shear spring of a contact: its force FREE of slip, and the TRIAL force by which
// slip is judged; the LIMIT on the force, and on the trial.
struct spring {
    double free[2], trial[2], limit, augmented_limit;
};

// Coulomb slip [K 4.25-4.26]. With s the stiffness ratio, m the shear force of the
// augmented state, t = s k (d - anchor) + (1 - s) m the trial and a = t / |t|, the
// force is limit a. Newton's method takes m along, as it is the force itself in the
// end:
//     force = limit a + held P (s k dd + (1 - s) (force - m)),
// held = augmented_limit / |t|, P = 1 - a a^T. Solved for the force, that divides by
// turned = 1 - (1 - s) held. The limit falls as the grains part.
static void slide(const struct contact_pair *pair,
                  const struct augmented_state *augmented, const struct spring *spring,
                  struct pair_response *response)
{
    const double *trial = spring->trial, limit = spring->limit;
    const double size = sqrt(trial[0] * trial[0] + trial[1] * trial[1]);
    const double along[2] = {trial[0] / size, trial[1] / size};
    const double held = spring->augmented_limit / size;
    const double turned = 1 - (1 - augmented->stiffness_ratio) * held;
    const double kept =
        augmented->stiffness_ratio * held * pair->shear_stiffness / turned;
    const double along_force =
        along[0] * augmented->shear_force[0] + along[1] * augmented->shear_force[1];
    for (int k = 0; k < 2; k++) {
        double *slope = response->slope[SHEAR + k];
        slope[NORMAL] -= pair->friction * pair->normal_stiffness * along[k];
        for (int l = 0; l < 2; l++)
            slope[SHEAR + l] += kept * ((k == l) - along[k] * along[l]);
        response->load[SHEAR + k] +=
            limit * along[k] +
            (1 - 1 / turned) * (augmented->shear_force[k] - along_force * along[k]);
        response->contact.anchor[k] +=
            (1 - limit / size) * trial[k] / pair->shear_stiffness;
    }
    response->contact.state = CONTACT_SLIPPING;
}

static void stick(const struct contact_pair *pair, const struct spring *spring,
                  struct pair_response *response)
{
    response->contact.state = CONTACT_STICKING;
    for (int k = 0; k < 2; k++) {
        response->load[SHEAR + k] += spring->free[k];
        response->slope[SHEAR + k][SHEAR + k] += pair->shear_stiffness;
    }
}

// Grains that come to touch do so without shear: their spring is free where they lie
// once all is balanced.
static void add_shear(const struct contact_pair *pair,
                      const double deformation[COMPONENTS], double overlap,
                      const struct augmented_state *augmented,
                      struct pair_response *response)
{
    const double ratio = augmented->stiffness_ratio;
    struct spring spring = {.limit = pair->friction * pair->normal_stiffness * overlap};
    spring.augmented_limit = pair->friction * pair->normal_stiffness *
                             (ratio * overlap + (1 - ratio) * augmented->overlap);
    double *anchor = response->contact.anchor, *trial = spring.trial;
    if (pair->contact.state == CONTACT_OPEN) {
        response->contact.state = CONTACT_NEW;
        memcpy(anchor, deformation + SHEAR, 2 * sizeof *anchor);
        return;
    }
    for (int k = 0; k < 2; k++) {
        anchor[k] = pair->contact.anchor[k];
        spring.free[k] = pair->shear_stiffness * (deformation[SHEAR + k] - anchor[k]);
        trial[k] = ratio * spring.free[k] + (1 - ratio) * augmented->shear_force[k];
    }
    // One that slid is at the limit: rounding must not make it stick.
    const double edge = pair->contact.state == CONTACT_SLIPPING ? 1 - 1e-11 : 1;
    if (sqrt(trial[0] * trial[0] + trial[1] * trial[1]) > edge * spring.augmented_limit)
        slide(pair, augmented, &spring, response);
    else
        stick(pair, &spring, response);
}

// [K 4.11-4.16]
static void add_contact(const struct contact_pair *pair,
                        const double deformation[COMPONENTS],
                        const struct augmented_state *augmented,
                        struct pair_response *response)
{
    const double overlap = pair->overlap - deformation[NORMAL];
    if (overlap < 0) return;
    response->load[NORMAL] -= pair->normal_stiffness * overlap;
    response->slope[NORMAL][NORMAL] += pair->normal_stiffness;
    add_shear(pair, deformation, overlap, augmented, response);
}

struct pair_response pair_respond_augmented(const struct contact_pair *pair,
                                            const double deformation[COMPONENTS],
                                            const struct augmented_state *augmented)
{
    struct pair_response response = {.contact.state = CONTACT_OPEN};
    if (pair->is_detached) return response;
    if (pair->is_bonded) add_bond(pair, deformation, &response);
    add_contact(pair, deformation, augmented, &response);
    return response;
}

struct pair_response pair_respond(const struct contact_pair *pair,
                                  const double deformation[COMPONENTS])
{
    return pair_respond_augmented(pair, deformation,
                                  &(struct augmented_state){.stiffness_ratio = 1});
}

void pair_break_bond(struct contact_pair *pair, const double deformation[COMPONENTS])
{
    pair->is_bonded = false;
    if (!pair->is_point) return;
    pair->overlap = pair->free_stretch;
    pair->contact = (struct contact){CONTACT_OPEN, {0, 0}};
    if (pair->overlap - deformation[NORMAL] >= 0)
        pair->contact.state = CONTACT_STICKING;
}

// Scaled numbers neither overflow nor underflow: no need of hypot.
static double size_of_two(const double a[2])
{
    return sqrt(a[0] * a[0] + a[1] * a[1]);
}

static struct overload point_overload(const struct contact_pair *pair,
                                      const double deformation[COMPONENTS],
                                      double normal_strength, double shear_strength)
{
    const double *stiffness = pair->bond_stiffness;
    const double tension =
        stiffness[NORMAL] * (deformation[NORMAL] - pair->free_stretch);
    const double shear = stiffness[SHEAR] * size_of_two(deformation + SHEAR);
    return (struct overload){tension / normal_strength, shear / shear_strength};
}

// With k^n A and k^s A known, A R^2 = 4 I = 2 J gives the stresses without A.
struct overload pair_overload(const struct contact_pair *pair,
                              const double deformation[COMPONENTS],
                              double normal_strength, double shear_strength)
{
    if (pair->is_point)
        return point_overload(pair, deformation, normal_strength, shear_strength);
    const double *stiffness = pair->bond_stiffness;
    const double beta = 1 - pair->moments_left_out;
    const double radius = pair->bond_radius, area = M_PI * radius * radius;
    const double bending = stiffness[BENDING] * size_of_two(deformation + BENDING);
    const double shear = stiffness[SHEAR] * size_of_two(deformation + SHEAR);
    const double twisting = stiffness[TORSION] * fabs(deformation[TORSION]);
    const double tension =
        stiffness[NORMAL] * (deformation[NORMAL] - pair->free_stretch);
    return (struct overload){
        (tension + beta * 4 * bending / radius) / area / normal_strength,
        (shear + beta * 2 * twisting / radius) / area / shear_strength};
}
