// SPDX-License-Identifier: GPL-3.0-or-later
#include "equilibrium.h"

#include "basics/memory.h"
#include "fragments.h"
#include "make_joints.h"
#include "stiffness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Mean radii, and as much of a turn: further is not small.
static const double furthest = 0.1;
// A bond is at its strength from here on: what rounding and the tolerance leave open.
static const double strong = 1 - 1e-9;

struct equilibrium {
    const struct packing *packing;
    struct equilibrium_setup setup;
    double length, stiffness; // units
    int n, n_joint;
    struct joint *joint;
    double (*strain)[STRAINS];     // (n_joint) of the trial
    struct resistance *resistance; // (n_joint) of the trial
    struct displacement *trial;    // (n) and once found, the equilibrium
    struct displacement *load;     // (n) from outside
    struct displacement *left;     // (n) what is not balanced at the trial
    struct displacement *step;     // (n)
    struct displacement *before;   // (n) the trial the step begins at
    struct fragments fragments;
    bool *is_loose; // (n) by the number of the fragment: not balanced for now
    bool *is_gone;  // (n) grains
    int n_gone;
    struct stiffness *matrix;
    double soft;
    double largest_load; // so far: what is left is measured by it
    int iterations;
    int n_crack, crack_capacity;
    struct dem_crack *crack;
};

static const struct displacement nothing = {{0, 0, 0}, {0, 0, 0}};

static double size_of(struct displacement a)
{
    return fmax(norm(a.shift), norm(a.turn));
}

// ---- begin and end ------------------------------------------------------------------

static void find_units(struct equilibrium *e)
{
    const struct packing *packing = e->packing;
    for (int i = 0; i < packing->n_particle; i++)
        e->length += packing->radius[i] / packing->n_particle;
    double radius = 0; // of the thickest bond
    for (int b = 0; b < packing->n_bond; b++)
        radius = fmax(radius, fmin(packing->radius[packing->bond[b][0]],
                                   packing->radius[packing->bond[b][1]]));
    radius *= e->setup.bond.radius_fraction;
    const double glue = e->setup.bond.normal_stiffness * M_PI * radius * radius;
    e->stiffness = fmax(glue, e->setup.material.normal_stiffness);
}

// Much softer than anything that resists: it moves what nothing holds, and nothing
// else.
static double softness(const struct equilibrium *e)
{
    double least = 1;
    for (int j = 0; j < e->n_joint; j++) {
        const double each[] = {e->joint[j].bond_along, e->joint[j].contact_along};
        for (int k = 0; k < 2; k++)
            if (each[k] > 0) least = fmin(least, each[k]);
    }
    return 1e-8 * least;
}

enum status equilibrium_new(struct equilibrium **result,
                            const struct equilibrium_setup *setup,
                            struct reason *reason)
{
    struct equilibrium *e = NEW_ARRAY(struct equilibrium, 1);
    const int n = setup->packing->n_particle;
    *result = NULL;
    e->packing = setup->packing;
    e->setup = *setup;
    e->n = n;
    find_units(e);
    if (n > 0 && !(e->stiffness > 0)) {
        free(e);
        return refuse(reason, STATUS_BAD_DATA,
                      "neither contacts nor bonds resist: there is no equilibrium");
    }
    const struct joint_setup joints = {.packing = setup->packing,
                                       .material = &e->setup.material,
                                       .bond = &e->setup.bond,
                                       .has_wall = setup->has_wall,
                                       .length = e->length,
                                       .stiffness = e->stiffness};
    e->joint = make_joints(&joints, &e->n_joint);
    e->strain = allocate((size_t)e->n_joint, sizeof *e->strain);
    e->resistance = NEW_ARRAY(struct resistance, e->n_joint);
    struct displacement **const of_grains[] = {&e->trial, &e->load, &e->left, &e->step,
                                               &e->before};
    for (size_t k = 0; k < sizeof of_grains / sizeof *of_grains; k++)
        *of_grains[k] = NEW_ARRAY(struct displacement, n);
    e->is_gone = NEW_ARRAY(bool, n);
    e->is_loose = NEW_ARRAY(bool, n);
    e->fragments = fragments_new(n);
    e->soft = softness(e);
    e->matrix = stiffness_new(n, setup->fixed, e->n_joint, e->joint);
    *result = e;
    return STATUS_OK;
}

void equilibrium_free(struct equilibrium *e)
{
    if (!e) return;
    fragments_free(&e->fragments);
    stiffness_free(e->matrix);
    void *const owned[] = {e->joint,   e->strain,   e->resistance, e->trial,
                           e->load,    e->left,     e->step,       e->before,
                           e->is_gone, e->is_loose, e->crack};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(e);
}

// ---- balance ------------------------------------------------------------------------

static void pull(struct displacement *sum, struct displacement load)
{
    sum->shift = subtract(sum->shift, load.shift);
    sum->turn = subtract(sum->turn, load.turn);
}

// What is left of the load at the trial, loose grains and all.
static void resist(struct equilibrium *e)
{
    memcpy(e->left, e->load, (size_t)e->n * sizeof *e->left);
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        const int32_t second = joint->grain[1];
        joint_strains(joint, &e->trial[joint->grain[0]],
                      second < 0 ? NULL : &e->trial[second], e->strain[j]);
        e->resistance[j] = joint_resistance(joint, e->strain[j]);
        for (int end = 0; end < 2; end++)
            if (joint->grain[end] >= 0)
                pull(&e->left[joint->grain[end]],
                     joint_loads(joint, end, e->resistance[j].load));
    }
    for (int i = 0; i < e->n; i++)
        if (e->setup.fixed[i] || e->is_gone[i]) e->left[i] = nothing;
}

static bool is_loose(const struct equilibrium *e, int grain)
{
    return e->is_loose[e->fragments.of[grain]];
}

static double largest_left(const struct equilibrium *e)
{
    double most = 0;
    for (int i = 0; i < e->n; i++)
        if (!is_loose(e, i)) most = fmax(most, size_of(e->left[i]));
    return most;
}

static double largest_load(const struct equilibrium *e)
{
    double most = 0;
    for (int i = 0; i < e->n; i++)
        most = fmax(most, size_of(e->load[i]));
    return most;
}

// The work that is left along the step.
static double slope(const struct equilibrium *e)
{
    double sum = 0;
    for (int i = 0; i < e->n; i++)
        sum += dot(e->left[i].shift, e->step[i].shift) +
               dot(e->left[i].turn, e->step[i].turn);
    return sum;
}

static void walk(struct equilibrium *e, double share)
{
    for (int i = 0; i < e->n; i++) {
        e->trial[i].shift = add(e->before[i].shift, scale(share, e->step[i].shift));
        e->trial[i].turn = add(e->before[i].turn, scale(share, e->step[i].turn));
    }
    resist(e);
}

// Along the step to where little work is left in it: as the energy is convex, that is
// less and less further on.
static void search_line(struct equilibrium *e)
{
    enum { MOST = 30 };
    memcpy(e->before, e->trial, (size_t)e->n * sizeof *e->before);
    const double first = slope(e);
    double near = 0, near_slope = first, far = INFINITY, far_slope = 0, share = 1;
    for (int k = 0; k < MOST; k++) {
        walk(e, share);
        const double now = slope(e);
        if (fabs(now) <= 0.5 * fabs(first)) return;
        if (now > 0)
            near = share, near_slope = now;
        else
            far = share, far_slope = now;
        const double secant =
            near + (far - near) * near_slope / (near_slope - far_slope);
        share = isinf(far) ? 2 * share
                           : fmax(near + 0.1 * (far - near),
                                  fmin(far - 0.1 * (far - near), secant));
    }
}

// A step from what is left, of all but loose grains when these are not ASKED.
static bool find_step(struct equilibrium *e, bool asked)
{
    if (!asked)
        for (int i = 0; i < e->n; i++)
            if (is_loose(e, i)) e->left[i] = nothing;
    return stiffness_solve(e->matrix, e->resistance, e->soft, e->left, e->step);
}

// Fragments that the step would move too far, and that no support holds, are loose;
// they stay where they are. Whether there are any.
static bool set_loose(struct equilibrium *e)
{
    bool any = false;
    for (int i = 0; i < e->n; i++) {
        const int fragment = e->fragments.of[i];
        if (e->is_gone[i] || e->fragments.is_held[fragment]) continue;
        if (size_of(e->step[i]) > furthest) e->is_loose[fragment] = true;
    }
    for (int i = 0; i < e->n; i++) {
        if (!is_loose(e, i)) continue;
        e->step[i] = nothing;
        any = true;
    }
    return any;
}

static void hold_all(struct equilibrium *e)
{
    memset(e->is_loose, 0, (size_t)e->n * sizeof *e->is_loose);
}

static void let_go(struct equilibrium *e)
{
    for (int i = 0; i < e->n; i++) {
        if (!is_loose(e, i)) continue;
        e->is_gone[i] = true;
        e->n_gone++;
        e->load[i] = nothing;
    }
    for (int j = 0; j < e->n_joint; j++)
        for (int end = 0; end < 2; end++) {
            const int32_t grain = e->joint[j].grain[end];
            if (grain >= 0 && e->is_gone[grain]) e->joint[j].is_gone = true;
        }
    hold_all(e);
}

static enum status check_small(const struct equilibrium *e, struct reason *reason)
{
    for (int i = 0; i < e->n; i++)
        if (!e->is_gone[i] && !(size_of(e->trial[i]) <= furthest))
            return refuse(
                reason, STATUS_NOT_CONVERGED,
                "grain %d moves %.3g mean radii: displacements are not small, "
                "and equilibrium is a matter of dynamics "
                "(engine=explicit, or stiffer bonds)",
                i, size_of(e->trial[i]));
    return STATUS_OK;
}

// Newton's method, with friction held, until at most AIM is left.
static bool minimise(struct equilibrium *e, double aim, int64_t *left_to_do)
{
    bool any_loose = false;
    while (largest_left(e) > aim && *left_to_do > 0) {
        if (!find_step(e, !any_loose)) return false;
        any_loose = set_loose(e);
        search_line(e);
        (*left_to_do)--;
        e->iterations++;
    }
    return true;
}

// Fragments that are loose while the rest is balanced leave if they still would move
// too far. Whether none did.
static bool keep_all(struct equilibrium *e)
{
    hold_all(e);
    if (!find_step(e, true) || !set_loose(e)) return true;
    let_go(e);
    return false;
}

static void hold_friction(struct equilibrium *e, double share)
{
    for (int j = 0; j < e->n_joint; j++)
        joint_hold_friction(&e->joint[j], e->strain[j], share);
    resist(e);
}

static enum status not_balanced(const struct equilibrium *e, struct reason *reason)
{
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "%g of the largest load is left after %lld iterations "
        "(quasi_static.most_iterations), not %g: what slips so is a matter of "
        "dynamics (engine=explicit)",
        largest_left(e) / e->largest_load, (long long)e->setup.most_iterations,
        e->setup.tolerance);
}

// Friction, as the normal forces found last allow it, and equilibrium with it held by
// turns, from the last trial on. As friction follows from what it changes, the turns
// come nearer by a factor each; late ones half as far, should they go to and fro.
static enum status balance(struct equilibrium *e, struct reason *reason)
{
    enum { EARLY = 30 };
    int64_t left_to_do = e->setup.most_iterations;
    const double enough = e->setup.tolerance * e->largest_load;
    hold_all(e);
    fragments_find(&e->fragments, e->joint, e->n_joint, e->setup.fixed, e->is_gone);
    resist(e);
    for (int turn = 0; left_to_do > 0; turn++) {
        hold_friction(e, turn < EARLY ? 1 : 0.5);
        const double left = largest_left(e);
        if (left <= enough) {
            if (keep_all(e)) return check_small(e, reason);
            resist(e);
        } else if (!minimise(e, fmax(0.1 * left, 0.5 * enough), &left_to_do))
            return refuse(reason, STATUS_NOT_CONVERGED,
                          "the stiffness is singular: something moves without "
                          "resistance (engine=explicit)");
    }
    return not_balanced(e, reason);
}

// ---- bonds --------------------------------------------------------------------------

static void record_crack(struct equilibrium *e, struct joint *joint, int mode)
{
    const int i = joint->grain[0];
    const struct vector from =
        add(e->trial[i].shift, scale(joint->arm[0], joint->axis[0]));
    GROW_ARRAY(e->crack, e->n_crack, e->crack_capacity);
    e->crack[e->n_crack++] = (struct dem_crack){
        .bond = joint->bond,
        .mode = (uint8_t)mode,
        .cycle = e->iterations,
        .position = add(e->packing->position[i], scale(e->length, from))};
    joint->is_bonded = false;
}

// The most overloaded bond breaks, if one is at its strength. Whether one was.
static bool break_one(struct equilibrium *e)
{
    const double stress = e->stiffness / e->length; // its unit
    struct joint *worst = NULL;
    double most = strong;
    int mode = DEM_CRACK_NORMAL;
    for (int j = 0; j < e->n_joint; j++) {
        struct joint *joint = &e->joint[j];
        if (!joint->is_bonded || joint->is_gone) continue;
        const struct overload overload = joint_overload(
            joint, e->resistance[j].bond_load, e->setup.bond.normal_strength / stress,
            e->setup.bond.shear_strength / stress);
        const double larger = fmax(overload.normal, overload.shear);
        if (!(larger >= most) || (worst && larger == most)) continue;
        most = larger;
        worst = joint;
        mode = overload.normal >= overload.shear ? DEM_CRACK_NORMAL : DEM_CRACK_SHEAR;
    }
    if (worst) record_crack(e, worst, mode);
    return worst;
}

static void keep_history(struct equilibrium *e)
{
    for (int j = 0; j < e->n_joint; j++) {
        memcpy(e->joint[j].strain, e->strain[j], sizeof e->joint[j].strain);
        e->joint[j].contact = e->resistance[j].contact;
    }
}

enum status equilibrium_find(struct equilibrium *e, const struct vector *force,
                             struct reason *reason)
{
    const double unit = e->stiffness * e->length;
    for (int i = 0; i < e->n; i++)
        e->load[i] = e->is_gone[i] || e->setup.fixed[i]
                         ? nothing
                         : (struct displacement){scale(1 / unit, force[i]), {0, 0, 0}};
    e->largest_load = fmax(e->largest_load, largest_load(e));
    do {
        const enum status status = balance(e, reason);
        if (status) return status;
        keep_history(e);
    } while (break_one(e));
    return STATUS_OK;
}

// ---- what came out ------------------------------------------------------------------

const struct dem_crack *equilibrium_cracks(const struct equilibrium *e, int *count)
{
    *count = e->n_crack;
    return e->crack;
}

int equilibrium_iterations(const struct equilibrium *e)
{
    return e->iterations;
}

int equilibrium_gone(const struct equilibrium *e)
{
    return e->n_gone;
}

void equilibrium_displacements(const struct equilibrium *e, struct vector *displacement)
{
    for (int i = 0; i < e->n; i++)
        displacement[i] = scale(e->length, e->trial[i].shift);
}

void equilibrium_bonds_intact(const struct equilibrium *e, uint8_t *intact)
{
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].bond >= 0) intact[e->joint[j].bond] = e->joint[j].is_bonded;
}

static int by_pair(const void *a, const void *b)
{
    const struct dem_contact *p = a, *q = b;
    if (p->particle[0] != q->particle[0])
        return p->particle[0] < q->particle[0] ? -1 : 1;
    const uint32_t second = (uint32_t)p->particle[1], other = (uint32_t)q->particle[1];
    return (second > other) - (second < other); // walls last
}

static struct dem_contact contact_of(const struct equilibrium *e, int j)
{
    const struct joint *joint = &e->joint[j];
    const int i = joint->grain[0];
    const struct displacement on_first = joint_loads(joint, 0, e->resistance[j].load);
    const struct vector from =
        add(e->trial[i].shift, scale(joint->arm[0], joint->axis[0]));
    return (struct dem_contact){
        .particle = {i, joint->grain[1]},
        .bond = joint->is_bonded ? joint->bond : -1,
        .overlap = e->length * (joint->overlap - joint->strain[STRAIN_ALONG]),
        .force = scale(e->stiffness * e->length, on_first.shift),
        .position = add(e->packing->position[i], scale(e->length, from))};
}

struct dem_contact *equilibrium_contacts(const struct equilibrium *e, int *count)
{
    struct dem_contact *contact = NEW_ARRAY(struct dem_contact, e->n_joint);
    *count = 0;
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        if (joint->is_gone || !(joint->is_bonded || joint->contact.touches)) continue;
        contact[(*count)++] = contact_of(e, j);
    }
    qsort(contact, (size_t)*count, sizeof *contact, by_pair);
    return contact;
}

// [K 4.20].
double equilibrium_unbalanced_ratio(const struct equilibrium *e)
{
    double left = 0, carried = 0;
    int moving = 0, carrying = 0;
    for (int i = 0; i < e->n; i++) {
        if (e->setup.fixed[i] || e->is_gone[i]) continue;
        left += norm(e->left[i].shift);
        moving++;
    }
    for (int j = 0; j < e->n_joint; j++) {
        const double force =
            norm(joint_loads(&e->joint[j], 0, e->resistance[j].load).shift);
        if (!(force > 0)) continue;
        carried += force;
        carrying++;
    }
    if (!(left > 0)) return 0;
    return carrying > 0 ? left / moving / (carried / carrying) : INFINITY;
}
