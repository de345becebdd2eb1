// SPDX-License-Identifier: GPL-3.0-or-later
// The engine is made, because it finds the time step, and asked; nothing moves:
//     steps     = duration / time step,
//     snapshots = duration / interval + 1, with as many contacts as at the start, and
//                 not fewer than LOOSE a grain.
// Grains that come together shorten a step that the user has not given: that makes up
// to SHORTER times as many steps, and to be expected is the mean of digits.
#include "foresee.h"

#include "run.h"

#include <math.h>
#include <stdlib.h>

static const double LOOSE = 2, SHORTER = 2;

static struct motion_size size_of(const struct simulate_parameters *parameters,
                                  const struct scene *scene, const struct dem *dem)
{
    const double n = scene->setup.packing->n_particle;
    const double recorded = parameters->duration - parameters->snapshots_from;
    int contacts;
    free(dem_contacts(dem, &contacts));
    return (struct motion_size){
        .grains = n,
        .steps = ceil(parameters->duration / dem_time_step(dem)),
        .snapshots = 1 + floor(fmax(0, recorded) / snapshot_interval(parameters)),
        .contacts = parameters->record_contacts ? fmax(LOOSE * n, contacts) : 0,
        .turns = dem_grains_turn(dem),
        .wet = scene->setup.liquid != NULL};
}

enum status foresee_run(const struct simulate_parameters *parameters,
                        struct scene *scene, struct cost *cost, struct reason *reason)
{
    struct dem *dem;
    scene->setup.threads = 1;
    const enum status status = dem_create(&dem, &scene->setup, reason);
    if (status) return status;
    struct motion_size least = size_of(parameters, scene, dem), most = least;
    if (isnan(parameters->time_step)) most.steps *= SHORTER;
    struct motion_size expected = least;
    expected.steps = sqrt(least.steps * most.steps);
    if (!isnan(parameters->stop_ratio))
        least.steps = fmin(least.steps, parameters->stop_after / dem_time_step(dem));
    *cost = cost_of_motion(&expected);
    cost->least = cost_of_motion(&least).seconds;
    cost->most = cost_of_motion(&most).seconds;
    if (parameters->write == WRITE_PACKING)
        cost->disk = cost_of_packing(expected.grains, MOVING_NOT).disk;
    dem_free(dem);
    return STATUS_OK;
}
