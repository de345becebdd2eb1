// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer time steps to the same rest. How long grains take to come to rest is set by
// forces over masses; how many steps that takes, by the largest stiffness over the
// smallest mass around any grain. So
//     inertia = factor max(mass, share of the mean mass),
//     factor  = max(1, dt wanted / limit of the grain)^2,
//     weight  = mass, or in a fall inertia  sum of masses / sum of inertias,
//     dt      = share of the stability limit of the contacts as they are now.
// In a fall all must fall alike; together they weigh as much as ever, for grains that
// have been pressed harder stay pressed from the sides.
//
// The limit of a grain grows with the root of its inertia alone, as the bound of
// stability.c takes each with its neighbours at rest. A tenth of the grains bind the
// step to three quarters of what the others could do with.
//
// The limit is that of stability.c. Local damping multiplies forces against the motion
// by 1 + damping; here springs and dashpots are so multiplied before the limit is
// found,
//     dt^2 (1 + damping) k + 2 dt (1 + damping) c = 4,
// which is sharper than the limit over 1 + damping. Grains that fly are not bound by
// contacts: dt is so short as well that no surface moves by more than FURTHEST of
// what the engine lets it in one step. Thornton's density scaling is the case in which
// all grains get the mean mass (dem_setup.density_scaling).
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>

static const double FURTHEST = 0.4;

// All that depends on inertia.
static void renew_masses(struct dem *dem)
{
    set_masses(dem, NULL);
    set_external(dem);
    for (int p = 0; dem->pairs.laws && p < dem->pairs.n_pair; p++)
        set_pair_law(dem, p);
    set_wall_laws(dem);
}

void dem_set_least_mass(struct dem *dem, double share, bool falls)
{
    dem->least_mass = share;
    dem->falls_alike = falls;
    renew_masses(dem);
}

void dem_even_steps(struct dem *dem, double contacts, bool now)
{
    const int n = dem->n_particle;
    if (!dem->inertia_factor) dem->inertia_factor = NEW_ARRAY(double, n);
    double *factor = dem->inertia_factor;
    for (int i = 0; i < n; i++)
        factor[i] = 1;
    renew_masses(dem);
    const double wanted = limit_of_two(dem) / sqrt(contacts);
#pragma omp parallel for num_threads(dem->threads)
    for (int i = 0; i < n; i++) {
        const double longer = wanted / sharp_grain_limit(dem, i, now, wanted);
        factor[i] = longer * longer;
    }
    renew_masses(dem);
}

void dem_inertia_ratios(const struct dem *dem, double *ratio)
{
    for (int i = 0; i < dem->n_particle; i++)
        ratio[dem->id[i]] = dem->mass[i] / own_mass(dem, i);
}

// Of the surfaces of all grains.
static double fastest_surface(const struct dem *dem)
{
    double fastest = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        const double *v = velocity_of(dem, i), *w = spin_of(dem, i);
        const double turning = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        fastest = fmax(fastest, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) +
                                    turning * dem->place[i].radius);
    }
    return fastest;
}

void dem_adapt_time_step(struct dem *dem, double share, bool now, double speed)
{
    const double fastest =
        fmax(speed * dem->unit.time / dem->unit.length, fastest_surface(dem));
    const double limit =
        fmin(sharp_stability_limit(dem, now), FURTHEST * MAX_STEP / (share * fastest));
    dem->time_before += (double)(dem->cycle - dem->step_since) * dem->time_step;
    dem->step_since = dem->cycle;
    dem->step_is_automatic = false;
    dem->step_is_adapted = dem->step_was_shortened = true;
    dem->automatic_share = share;
    dem->time_step_limit = limit;
    dem->time_step = share * limit;
}

bool dem_step_is_adapted(const struct dem *dem)
{
    return dem->step_is_adapted;
}
