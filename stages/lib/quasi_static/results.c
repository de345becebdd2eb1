// SPDX-License-Identifier: GPL-3.0-or-later
// What came out of an equilibrium.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

const struct dem_crack *equilibrium_cracks(const struct equilibrium *e, int *count)
{
    *count = e->n_crack;
    return e->crack;
}

int equilibrium_iterations(const struct equilibrium *e)
{
    return e->iterations;
}

const bool *equilibrium_is_gone(const struct equilibrium *e)
{
    return e->is_gone;
}

int equilibrium_gone(const struct equilibrium *e, int *first)
{
    *first = e->first_gone;
    return e->n_gone;
}

int equilibrium_restless(const struct equilibrium *e, int *last)
{
    *last = e->restless;
    return e->n_restless;
}

int equilibrium_snaps(const struct equilibrium *e, int *last)
{
    *last = e->snapped;
    return e->n_snap;
}

// Where nothing holds the grains, nor says where they are as one, rounding does: small
// displacements are told without that, large ones are found without [rigid_motion.c].
void equilibrium_displacements(const struct equilibrium *e, struct vector *displacement)
{
    struct displacement *moved = duplicate(e->trial, (size_t)e->n, sizeof *moved);
    if (e->setup.is_free && !e->large) stand_at_start(e, moved);
    for (int i = 0; i < e->n; i++)
        displacement[i] = scale(e->length, moved[i].shift);
    free(moved);
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
    const bool is_point = joint->is_bonded && joint->is_point;
    const double overlap = is_point ? joint->point_overlap : joint->overlap;
    return (struct dem_contact){
        .particle = {i, joint->grain[1]},
        .bond = joint->is_bonded ? joint->bond : -1,
        .overlap = e->length * (overlap - joint->strain[STRAIN_ALONG]),
        .force = scale(e->stiffness * e->length, on_first.shift),
        .position = add(e->packing->position[i], scale(e->length, from))};
}

struct dem_contact *equilibrium_contacts(const struct equilibrium *e, int *count)
{
    struct dem_contact *contact = NEW_ARRAY(struct dem_contact, e->n_joint);
    *count = 0;
    for (int j = 0; j < e->n_joint; j++) {
        const struct joint *joint = &e->joint[j];
        if (joint->is_gone || !(joint->is_bonded || joint->contact.touch)) continue;
        contact[(*count)++] = contact_of(e, j);
    }
    qsort(contact, (size_t)*count, sizeof *contact, by_pair);
    return contact;
}

// Where END of a joint is loaded: the centre of a grain, or the wall at the contact.
static struct vector loaded_at(const struct equilibrium *e, const struct joint *joint,
                               int end)
{
    if (joint->grain[end] >= 0) return e->packing->position[joint->grain[end]];
    return add(e->packing->position[joint->grain[0]],
               scale(e->length * joint->arm[0], joint->axis[0]));
}

// Adds what is LOADED at PLACE, about ABOUT.
static void add_reaction(const struct equilibrium *e, struct displacement load,
                         struct vector place, struct vector about, struct vector *force,
                         struct vector *moment)
{
    const double unit = e->stiffness * e->length;
    const struct vector pull = scale(unit, load.shift);
    const struct vector turn = scale(unit * e->length, load.turn);
    *force = add(*force, pull);
    *moment = add(*moment, add(cross(subtract(place, about), pull), turn));
}

void equilibrium_reaction(const struct equilibrium *e, struct vector about,
                          struct vector *force, struct vector *moment)
{
    *force = *moment = (struct vector){0, 0, 0};
    for (int j = 0; j < e->n_joint; j++)
        for (int end = 0; end < 2 && !e->joint[j].is_gone; end++) {
            const int grain = e->joint[j].grain[end];
            if (grain >= 0 && !e->setup.fixed[grain]) continue;
            add_reaction(e, joint_loads(&e->joint[j], end, e->resistance[j].load),
                         loaded_at(e, &e->joint[j], end), about, force, moment);
        }
}

double equilibrium_unbalanced_ratio(const struct equilibrium *e)
{
    double left = 0, carried = 0;
    int moving = 0, carrying = 0; // grains, joints
    for (int i = 0; i < e->n; i++) {
        if (e->setup.fixed[i] || e->is_gone[i]) continue;
        left += norm(e->left[i].shift);
        moving++;
    }
    for (int j = 0; j < e->n_joint; j++) {
        const double *load = e->resistance[j].load; // along axes that are perpendicular
        const double force = norm((struct vector){load[0], load[1], load[2]});
        carried += force;
        carrying += force > 0 || (e->joint[j].is_bonded && !e->joint[j].is_gone);
    }
    if (!(left > 0)) return 0;
    // Of loads that are gone there may be rounding left on grains and in joints alike.
    const double nothing = e->setup.tolerance * e->largest_load;
    if (largest_left(e) <= nothing && carried <= carrying * nothing) return 0;
    return carried > 0 ? left / moving / (carried / carrying) : 1; // all is unbalanced
}
