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

// Pushes overlapping grains apart, with a time step so short that even a grain on top
// of another leaves it in steps of a few hundredths of a radius.
static enum status push_apart(const struct making *making, double stiffness,
                              const struct dem_wall *wall, int n_wall,
                              struct reason *reason)
{
    struct dem *dem = NULL;
    const struct vector none = {0, 0, 0};
    enum status status = start_dynamics(making, stiffness, 0.1 * fixed_safety(making),
                                        none, wall, n_wall, &dem, reason);
    if (status == STATUS_OK) status = dem_run(dem, CYCLES_A_BATCH, reason);
    if (status == STATUS_OK) {
        take_grains(making, dem);
        making->reached->cycles += dem_cycle(dem);
        making->reached->time += (double)dem_cycle(dem) * dem_time_step(dem);
    }
    dem_free(dem);
    return status;
}

static enum status come_to_rest(const struct making *making, double stiffness,
                                const struct dem_wall *wall, int n_wall,
                                struct reason *reason)
{
    const struct dynamics_parameters *how = making->how;
    struct dem *dem = NULL;
    const struct vector none = {0, 0, 0};
    enum status status = start_dynamics(making, stiffness, fixed_safety(making), none,
                                        wall, n_wall, &dem, reason);
    if (status == STATUS_OK)
        status = dem_run_until(dem, how->tolerance, how->most_cycles, reason);
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

enum status repel(const struct making *making, int count, struct reason *reason)
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
        if (status == STATUS_OK)
            status = push_apart(making, stiffness, wall, n_wall, reason);
    }
    if (status == STATUS_OK)
        status = come_to_rest(making, stiffness, wall, n_wall, reason);
    if (status != STATUS_OK) packing_free(making->packing);
    return status;
}
