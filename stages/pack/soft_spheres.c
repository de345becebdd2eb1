// SPDX-License-Identifier: GPL-3.0-or-later
// Soft spheres: random points of final sizes, relaxed to a minimum of the energy of
// their overlaps (O'Hern et al. 2003, Phys. Rev. E 68, 011306),
//     E = sum over pairs (R_i + R_j - d)^2 / 2, and over walls (R_i - d_wall)^2,
// by the fast inertial relaxation engine (Bitzek et al. 2006, Phys. Rev. Lett. 97,
// 170201): with velocities v, forces f and unit masses, in each step
//     P = f.v;  v = (1 - a) v + a |v| f / |f|;
//     P > 0 for five steps: dt = min(1.1 dt, most), a = 0.99 a;
//     P <= 0: dt = dt / 2, a = 0.1, v = 0;
//     v += dt f;  x += dt v.
// Lengths in mean radii. It ends when no overlap of more than OVERLAP mean radii is
// left, or when the mean force on a grain is small beside the mean force of a contact:
// then it is jammed, and grains overlap a little. No friction, no dynamics, no walls to
// order the grains by where the box repeats; some seconds for 1e4 to 1e5 grains.
#include "basics/memory.h"
#include "geometry/neighbours.h"
#include "geometry/space_filling_curve.h"
#include "pack.h"

#include <math.h>
#include <stdlib.h>

static const double SKIN = 0.15; // of the sum of two radii
static const double OVERLAP = 1e-6, AT_REST = 1e-2;
enum { MOST_STEPS = 5000, LEAST_TO_ORDER = 150000 };

struct relaxation {
    struct packing *packing;                    // in mean radii, along a curve
    struct vector *force, *velocity, *searched; // (n) the last: where pairs were sought
    int32_t (*pair)[2];
    int n_pair;
    double smallest, contact_force; // radius; mean of the pairs that overlap
    int n_contact;
    double step, mixing;
    int downhill; // steps in a row
};

static void search(struct relaxation *r, const struct domain *domain)
{
    struct packing *packing = r->packing;
    for (int i = 0; i < packing->n_particle; i++)
        r->searched[i] = packing->position[i] =
            domain_wrap(domain, packing->position[i]);
    free(r->pair);
    r->pair = neighbour_pairs(packing, SKIN, &r->n_pair);
}

// Whether two grains that no list names may overlap.
static bool pairs_are_due(const struct relaxation *r)
{
    const double least = SKIN * r->smallest;
    for (int i = 0; i < r->packing->n_particle; i++)
        if (norm(subtract(r->packing->position[i], r->searched[i])) > least)
            return true;
    return false;
}

static void push_off_walls(struct relaxation *r)
{
    const struct packing *packing = r->packing;
    for (int i = 0; i < packing->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            if (packing->periodic[axis]) continue;
            const double at = component(packing->position[i], axis);
            const double below =
                packing->radius[i] - (at - component(packing->lower, axis));
            const double above =
                packing->radius[i] - (component(packing->upper, axis) - at);
            const double push = (below > 0 ? below : 0) - (above > 0 ? above : 0);
            set_component(&r->force[i], axis, component(r->force[i], axis) + 2 * push);
        }
}

// In the order of the pairs. Returns the largest overlap. Coincident centres part along
// x.
static double find_forces(struct relaxation *r)
{
    const struct packing *packing = r->packing;
    double largest = 0, sum = 0;
    r->n_contact = 0;
    for (int i = 0; i < packing->n_particle; i++)
        r->force[i] = (struct vector){0, 0, 0};
    for (int p = 0; p < r->n_pair; p++) {
        const int i = r->pair[p][0], j = r->pair[p][1];
        const struct vector apart = nearest_image(packing, i, j);
        const double touching = packing->radius[i] + packing->radius[j];
        const double square = dot(apart, apart);
        if (square >= touching * touching) continue;
        const double d = sqrt(square), overlap = touching - d;
        const struct vector along =
            d > 0 ? scale(overlap / d, apart) : (struct vector){overlap, 0, 0};
        r->force[i] = subtract(r->force[i], along);
        r->force[j] = add(r->force[j], along);
        if (overlap > largest) largest = overlap;
        sum += overlap;
        r->n_contact++;
    }
    r->contact_force = r->n_contact ? sum / r->n_contact : 0;
    push_off_walls(r);
    return largest;
}

struct sums {
    double power, force, speed; // f.v, |f|, |v| of all grains
    double mean_force;          // on a grain
};

static struct sums sum_up(const struct relaxation *r)
{
    struct sums s = {0};
    const int n = r->packing->n_particle;
    for (int i = 0; i < n; i++) {
        s.power += dot(r->force[i], r->velocity[i]);
        s.force += dot(r->force[i], r->force[i]);
        s.speed += dot(r->velocity[i], r->velocity[i]);
        s.mean_force += norm(r->force[i]) / n;
    }
    s.force = sqrt(s.force);
    s.speed = sqrt(s.speed);
    return s;
}

// One step; no grain moves by more than a tenth of the mean radius in it.
static void advance(struct relaxation *r, const struct sums *s)
{
    static const double most_step = 0.5, first_mixing = 0.1, furthest = 0.1;
    const bool stops = !(s->power > 0);
    if (stops) {
        r->downhill = 0;
        r->step *= 0.5;
        r->mixing = first_mixing;
    } else if (++r->downhill > 5) {
        r->step = fmin(1.1 * r->step, most_step);
        r->mixing *= 0.99;
    }
    const double turn = s->force > 0 ? r->mixing * s->speed / s->force : 0;
    for (int i = 0; i < r->packing->n_particle; i++) {
        struct vector v =
            stops ? (struct vector){0, 0, 0}
                  : add(scale(1 - r->mixing, r->velocity[i]), scale(turn, r->force[i]));
        v = add(v, scale(r->step, r->force[i]));
        const double length = r->step * norm(v);
        if (length > furthest) v = scale(furthest / length, v);
        r->velocity[i] = v;
        r->packing->position[i] = add(r->packing->position[i], scale(r->step, v));
    }
}

static enum status relax(struct relaxation *r, const struct domain *domain,
                         struct progress *progress, struct reason *reason)
{
    r->step = 0.1;
    r->mixing = 0.1;
    search(r, domain);
    struct sums s = {0};
    for (int k = 0; k < MOST_STEPS; k++) {
        if (pairs_are_due(r)) search(r, domain);
        const double largest = find_forces(r);
        s = sum_up(r);
        if (largest < OVERLAP || s.mean_force < AT_REST * r->contact_force) {
            search(r, domain);
            return STATUS_OK;
        }
        advance(r, &s);
        progress_update(progress, (double)k / MOST_STEPS);
    }
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "soft_spheres: after %d steps the mean force on a grain is %g of that "
        "of a contact: another seed, or a larger porosity (pack.target=porosity, "
        "pack.target_value)",
        MOST_STEPS, s.mean_force / r->contact_force);
}

// ---- order --------------------------------------------------------------------------

// Neighbours in space become neighbours in memory; fewer grains fit in the cache in any
// order, and keep theirs.
static int32_t *order_of(const struct packing *packing)
{
    return packing->n_particle < LEAST_TO_ORDER
               ? NULL
               : order_along_curve(packing->n_particle, packing->position);
}

// Grain k becomes what grain ORDER[k] was, or the other way round.
static void reorder(struct packing *packing, const int32_t *order, bool back)
{
    if (!order) return;
    const size_t n = (size_t)packing->n_particle;
    struct vector *position = duplicate(packing->position, n, sizeof *position);
    double *radius = duplicate(packing->radius, n, sizeof *radius);
    for (int k = 0; k < packing->n_particle; k++) {
        const int to = back ? order[k] : k, from = back ? k : order[k];
        packing->position[to] = position[from];
        packing->radius[to] = radius[from];
    }
    free(position);
    free(radius);
}

// ---- units --------------------------------------------------------------------------

static void rescale(struct packing *packing, struct domain *domain, double unit)
{
    struct vector *const corner[] = {&packing->lower, &packing->upper, &domain->lower,
                                     &domain->upper};
    for (int k = 0; k < 4; k++)
        *corner[k] = scale(unit, *corner[k]);
    for (int i = 0; i < packing->n_particle; i++) {
        packing->position[i] = scale(unit, packing->position[i]);
        packing->radius[i] *= unit;
    }
}

// Radii first: as many as were counted to fill the box, and the same.
static enum status place_at_random(const struct domain *domain,
                                   const struct sizes *sizes, int count,
                                   gsl_rng *random, struct packing *packing,
                                   struct reason *reason)
{
    double *radius = sizes_draw_many(sizes, count, random);
    enum status status = domain_check_filling(domain, radius, count, reason);
    *packing = packing_in(domain, count);
    for (int i = 0; !status && i < count; i++) {
        packing->radius[i] = radius[i];
        if (!domain_random_point(domain, radius[i], random, &packing->position[i]))
            status = refuse(reason, STATUS_BAD_DATA,
                            "pack.upper: must leave room for the grains");
    }
    free(radius);
    if (status) packing_free(packing);
    return status;
}

enum status soft_spheres(const struct domain *domain, const struct sizes *sizes,
                         int count, gsl_rng *random, struct progress *progress,
                         struct packing *packing, struct reason *reason)
{
    enum status status = place_at_random(domain, sizes, count, random, packing, reason);
    if (status) return status;
    struct domain scaled = *domain;
    double sum = 0, smallest = INFINITY;
    for (int i = 0; i < count; i++) {
        sum += packing->radius[i] / count;
        smallest = fmin(smallest, packing->radius[i]);
    }
    rescale(packing, &scaled, 1 / sum);
    struct relaxation r = {.packing = packing,
                           .smallest = smallest / sum,
                           .force = NEW_ARRAY(struct vector, count),
                           .velocity = NEW_ARRAY(struct vector, count),
                           .searched = NEW_ARRAY(struct vector, count)};
    int32_t *order = order_of(packing);
    reorder(packing, order, false);
    status = relax(&r, &scaled, progress, reason);
    reorder(packing, order, true);
    free(order);
    rescale(packing, &scaled, sum);
    packing->lower = domain->lower;
    packing->upper = domain->upper;
    free(r.force);
    free(r.velocity);
    free(r.searched);
    free(r.pair);
    if (status) packing_free(packing);
    return status;
}
