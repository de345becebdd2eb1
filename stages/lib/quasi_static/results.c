// SPDX-License-Identifier: GPL-3.0-or-later
// Results of the last equilibrium, in SI units. With L = `length`, K = `stiffness`,
//     displacement  L u, of a free body without its rigid motion,
//     overlap       L (overlap at the start - d[NORMAL]),
//     force         K L (B^T load at the first grain): what the second one feels,
//     moment        K L^2 (B^T load), in reactions with (place - about) x force,
//     stress        K L^2 / volume, sum of branch x force,
//     unbalanced    mean |residual| of grains that move / mean |force| of pairs
//                   [K 4.20].
// Grains feel -B^T load, so fixed ones and the wall hold with B^T load: the reaction is
// the sum of these, at places of the packing. Pairs that touch or are bonded are
// contacts, sorted by their grains, walls last; pairs of grains that left are none.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

const struct dem_crack *quasi_static_cracks(const struct quasi_static *qs, int *count)
{
    *count = qs->n_crack;
    return qs->crack;
}

int quasi_static_iterations(const struct quasi_static *qs)
{
    return qs->iterations;
}

const bool *quasi_static_is_detached(const struct quasi_static *qs)
{
    return qs->is_detached;
}

int quasi_static_detached(const struct quasi_static *qs, int *first)
{
    *first = qs->first_detached;
    return qs->n_detached;
}

int quasi_static_unconverged(const struct quasi_static *qs, int *last)
{
    *last = qs->last_unconverged;
    return qs->n_unconverged;
}

int quasi_static_instabilities(const struct quasi_static *qs, int *last)
{
    *last = qs->last_unstable;
    return qs->n_instability;
}

// Rigid motion of a body that nothing holds is rounding: taken off small displacements
// here, off large ones as they are found [rigid_motion.c].
void quasi_static_displacements(const struct quasi_static *qs,
                                struct vector *displacement)
{
    struct displacement *moved =
        duplicate(qs->displacement, (size_t)qs->n, sizeof *moved);
    if (qs->setup.is_free && !qs->large) remove_small_rigid_motion(qs, moved);
    for (int i = 0; i < qs->n; i++)
        displacement[i] = scale(qs->length, moved[i].translation);
    free(moved);
}

void quasi_static_bonds_intact(const struct quasi_static *qs, uint8_t *intact)
{
    for (int j = 0; j < qs->n_pair; j++)
        if (qs->pair[j].bond >= 0) intact[qs->pair[j].bond] = qs->pair[j].is_bonded;
}

static int by_pair(const void *a, const void *b)
{
    const struct dem_contact *p = a, *q = b;
    if (p->particle[0] != q->particle[0])
        return p->particle[0] < q->particle[0] ? -1 : 1;
    const uint32_t second = (uint32_t)p->particle[1], other = (uint32_t)q->particle[1];
    return (second > other) - (second < other); // walls last
}

static struct dem_contact contact_of(const struct quasi_static *qs, int j)
{
    const struct contact_pair *pair = &qs->pair[j];
    const int i = pair->grain[0];
    const struct displacement on_first =
        pair_load_on_grain(pair, 0, qs->response[j].load);
    const struct vector from =
        add(qs->displacement[i].translation, scale(pair->arm[0], pair->axis[0]));
    const bool is_point = pair->is_bonded && pair->is_point;
    const double overlap = is_point ? pair->free_stretch : pair->overlap;
    return (struct dem_contact){
        .particle = {i, pair->grain[1]},
        .bond = pair->is_bonded ? pair->bond : -1,
        .overlap = qs->length * (overlap - pair->deformation[NORMAL]),
        .force = scale(qs->stiffness * qs->length, on_first.translation),
        .position = add(qs->packing->position[i], scale(qs->length, from))};
}

struct dem_contact *quasi_static_contacts(const struct quasi_static *qs, int *count)
{
    struct dem_contact *contact = NEW_ARRAY(struct dem_contact, qs->n_pair);
    *count = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        if (pair->is_detached || !(pair->is_bonded || pair->contact.state)) continue;
        contact[(*count)++] = contact_of(qs, j);
    }
    qsort(contact, (size_t)*count, sizeof *contact, by_pair);
    return contact;
}

// Where END of a pair is loaded: the centre of a grain, or the wall at the contact.
static struct vector loaded_at(const struct quasi_static *qs,
                               const struct contact_pair *pair, int end)
{
    if (pair->grain[end] >= 0) return qs->packing->position[pair->grain[end]];
    return add(qs->packing->position[pair->grain[0]],
               scale(qs->length * pair->arm[0], pair->axis[0]));
}

// Adds LOAD at PLACE, about ABOUT.
static void add_reaction(const struct quasi_static *qs, struct displacement load,
                         struct vector place, struct vector about, struct vector *force,
                         struct vector *moment)
{
    const double unit = qs->stiffness * qs->length;
    const struct vector force_there = scale(unit, load.translation);
    const struct vector moment_there = scale(unit * qs->length, load.rotation);
    *force = add(*force, force_there);
    *moment =
        add(*moment, add(cross(subtract(place, about), force_there), moment_there));
}

void quasi_static_reaction(const struct quasi_static *qs, struct vector about,
                           struct vector *force, struct vector *moment)
{
    *force = *moment = (struct vector){0, 0, 0};
    for (int j = 0; j < qs->n_pair; j++)
        for (int end = 0; end < 2 && !qs->pair[j].is_detached; end++) {
            const int grain = qs->pair[j].grain[end];
            if (grain >= 0 && !qs->setup.fixed[grain]) continue;
            add_reaction(qs,
                         pair_load_on_grain(&qs->pair[j], end, qs->response[j].load),
                         loaded_at(qs, &qs->pair[j], end), about, force, moment);
        }
}

// From centre to centre, as far as they are apart now where displacements are large.
void quasi_static_stress(const struct quasi_static *qs, double stress[3][3])
{
    const struct vector edge = subtract(qs->packing->upper, qs->packing->lower);
    const double unit = qs->stiffness * qs->length * qs->length / box_volume(edge);
    for (int k = 0; k < 9; k++)
        stress[k / 3][k % 3] = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        const struct contact_pair *pair = &qs->pair[j];
        if (pair->is_detached) continue;
        const struct vector force =
            pair_load_on_grain(pair, 0, qs->response[j].load).translation;
        const double branch = pair->arm[0] + (pair->grain[1] < 0 ? 0 : pair->arm[1]);
        for (int k = 0; k < 9; k++)
            stress[k / 3][k % 3] += unit * branch * component(pair->axis[0], k / 3) *
                                    component(force, k % 3);
    }
}

double quasi_static_unbalanced_ratio(const struct quasi_static *qs)
{
    double left = 0, carried = 0;
    int moving = 0, carrying = 0; // grains, pairs
    for (int i = 0; i < qs->n; i++) {
        if (qs->setup.fixed[i] || qs->is_detached[i]) continue;
        left += norm(qs->residual[i].translation);
        moving++;
    }
    for (int j = 0; j < qs->n_pair; j++) {
        const double *load = qs->response[j].load; // along axes that are perpendicular
        const double force = norm((struct vector){load[0], load[1], load[2]});
        carried += force;
        carrying += force > 0 || (qs->pair[j].is_bonded && !qs->pair[j].is_detached);
    }
    if (!(left > 0)) return 0;
    // Loads that are gone may leave rounding on grains and in pairs alike.
    const double nothing = qs->setup.tolerance * qs->largest_load;
    if (largest_residual(qs) <= nothing && carried <= carrying * nothing) return 0;
    return carried > 0 ? left / moving / (carried / carrying) : 1; // all is unbalanced
}
