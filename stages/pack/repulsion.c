// SPDX-License-Identifier: GPL-3.0-or-later
// Explosive repulsion [K 3.1.1]: grains of their final size are added at random places,
// overlapping others, and after each batch a few cycles push overlapping grains apart.
// K adds one grain at a time; batches of a hundredth of all are as gentle and cost O(n)
// each. In the end the packing is brought to rest. Batches use a tenth of the usual
// time step. Where a stiffness is not given it is density radius^3 1e12, with which the
// critical time step is of the order of a microsecond: only ratios matter.
#include "dynamics.h"
#include "pack.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

enum { BATCHES = 100, CYCLES_A_BATCH = 200 };

// Two coincident centres have no direction in which to separate: each grain is moved by
// up to a thousandth of its radius.
static void separate_coincident(const struct making *making)
{
    struct packing *packing = making->packing;
    gsl_rng *random = making->random;
    const bool flat = making->domain->dimensions == 2;
    for (int i = 0; i < packing->n_particle; i++) {
        const double by = 1e-3 * packing->radius[i];
        packing->position[i].x += by * (2 * gsl_rng_uniform(random) - 1);
        if (!flat) packing->position[i].y += by * (2 * gsl_rng_uniform(random) - 1);
        packing->position[i].z += by * (2 * gsl_rng_uniform(random) - 1);
    }
}

// An engine with a step of SHARE of the usual one, or, where a grain has so many
// contacts that this would not be stable, a half or less of it; as given, if it is.
static enum status start(const struct making *making, double stiffness, double share,
                         const struct dem_wall *wall, int n_wall, struct dem **dem,
                         struct reason *reason)
{
    const struct vector none = {0, 0, 0};
    const bool given = !isnan(making->how->safety);
    double safety = share * fixed_safety(making);
    enum status status;
    enum { MOST_HALVINGS = 20 };
    for (int k = 0; k < MOST_HALVINGS; k++, safety /= 2) {
        status =
            start_dynamics(making, stiffness, safety, none, wall, n_wall, dem, reason);
        if (status != STATUS_NOT_CONVERGED || given) return status;
    }
    return status;
}

// Pushes overlapping grains apart, with a time step so short that even a grain on top
// of another leaves it in steps of a few hundredths of a radius.
static enum status push_apart(const struct making *making, double stiffness,
                              const struct dem_wall *wall, int n_wall,
                              struct reason *reason)
{
    struct dem *dem = NULL;
    enum status status = start(making, stiffness, 0.1, wall, n_wall, &dem, reason);
    if (status == STATUS_OK) status = dem_run(dem, CYCLES_A_BATCH, reason);
    if (status == STATUS_OK) {
        take_grains(making, dem);
        making->reached->cycles += dem_cycle(dem);
        making->reached->time += (double)dem_cycle(dem) * dem_time_step(dem);
    }
    dem_free(dem);
    return status;
}

// Until no grains overlap deeply: they would shoot apart in longer steps. Those that
// are jammed may go on doing so.
static enum status push_on(const struct making *making, double stiffness,
                           const struct dem_wall *wall, int n_wall,
                           struct reason *reason)
{
    enum { MOST_PUSHES = 20 };
    const double apart = 0.9;
    enum status status = STATUS_OK;
    for (int k = 0; k < MOST_PUSHES && fitting_size(making->packing) < apart; k++) {
        status = push_apart(making, stiffness, wall, n_wall, reason);
        if (status != STATUS_OK) break;
    }
    return status;
}

// The largest overlap, over the smaller radius.
static double largest_overlap(const struct making *making, const struct dem *dem)
{
    const double *radius = making->packing->radius;
    double largest = 0;
    int count;
    struct dem_contact *contact = dem_contacts(dem, &count);
    for (int k = 0; k < count; k++) {
        const int first = contact[k].particle[0], second = contact[k].particle[1];
        const double smaller =
            second < 0 ? radius[first] : fmin(radius[first], radius[second]);
        largest = fmax(largest, contact[k].overlap / smaller);
    }
    free(contact);
    return largest;
}

// Until the forces of grains that are jammed balance, or grains have parted: these fly
// on, and what few contacts they have never balances.
static enum status run_to_rest(const struct making *making, struct dem *dem,
                               struct reason *reason)
{
    enum { LOOK_EVERY = 200 };
    const struct dynamics_parameters *how = making->how;
    const double parted = 1e-6;
    for (int64_t done = 0; done < how->most_cycles; done += LOOK_EVERY) {
        const enum status status = dem_run(dem, LOOK_EVERY, reason);
        if (status != STATUS_OK) return status;
        if (dem_unbalanced_ratio(dem) < how->tolerance ||
            largest_overlap(making, dem) < parted)
            return STATUS_OK;
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "unbalanced ratio %g is not below %g after %lld cycles "
                  "(pack.dynamics.most_cycles, .tolerance)",
                  dem_unbalanced_ratio(dem), how->tolerance,
                  (long long)how->most_cycles);
}

static enum status come_to_rest(const struct making *making, double stiffness,
                                const struct dem_wall *wall, int n_wall,
                                struct reason *reason)
{
    struct dem *dem = NULL;
    enum status status = start(making, stiffness, 1, wall, n_wall, &dem, reason);
    if (status == STATUS_OK) status = run_to_rest(making, dem, reason);
    if (status == STATUS_OK) {
        take_grains(making, dem);
        note_end(making, dem);
    }
    dem_free(dem);
    return status;
}

// Adds grains up to UPTO, at random places.
static enum status add_batch(const struct making *making, const double *radius,
                             int upto, struct reason *reason)
{
    struct packing *packing = making->packing;
    for (int i = packing->n_particle; i < upto; i++) {
        packing->radius[i] = radius[i];
        if (!domain_random_point(making->domain, radius[i], making->random,
                                 &packing->position[i]))
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.domain.cut.shape: must leave room for the grains");
    }
    packing->n_particle = upto;
    return STATUS_OK;
}

static enum status fill(const struct making *making, int count, double stiffness,
                        const struct dem_wall *wall, int n_wall, struct reason *reason)
{
    double *radius = sizes_draw_many(making->sizes, count, making->random);
    *making->packing = packing_in(making->domain, count);
    making->packing->n_particle = 0;
    enum status status = domain_check_filling(making->domain, radius, count, reason);
    const int batch = count / BATCHES > 0 ? count / BATCHES : 1;
    for (int n = batch; status == STATUS_OK; n += batch) {
        status = add_batch(making, radius, n < count ? n : count, reason);
        if (status == STATUS_OK) separate_coincident(making);
        if (status == STATUS_OK)
            status = push_apart(making, stiffness, wall, n_wall, reason);
        progress_update(making->progress, 0.9 * n / count);
        if (n >= count) break;
    }
    free(radius);
    return status;
}

static enum status repel_smooth(const struct making *making, int count,
                                struct reason *reason)
{
    struct dem_wall wall[MAX_WALLS];
    const int n_wall = domain_walls(making->domain, making->how, false, wall);
    const double radius = making->sizes->largest;
    const double stiffness =
        isnan(making->how->stiffness)
            ? making->how->density * radius * radius * radius * 1e12
            : making->how->stiffness;
    making->reached->growth = 1;
    enum status status;
    if (count > 0)
        status = fill(making, count, stiffness, wall, n_wall, reason);
    else {
        const struct packing *packing = making->packing;
        status = domain_check_filling(making->domain, packing->radius,
                                      packing->n_particle, reason);
        if (status == STATUS_OK) separate_coincident(making);
    }
    if (status == STATUS_OK) status = push_on(making, stiffness, wall, n_wall, reason);
    if (status == STATUS_OK)
        status = come_to_rest(making, stiffness, wall, n_wall, reason);
    if (status != STATUS_OK) packing_free(making->packing);
    return status;
}

// Without friction, by which grains would hold each other where they overlap.
enum status repel(const struct making *making, int count, struct reason *reason)
{
    struct dynamics_parameters smooth = *making->how;
    struct making repelling = *making;
    smooth.friction = smooth.wall_friction = 0;
    repelling.how = &smooth;
    return repel_smooth(&repelling, count, reason);
}
