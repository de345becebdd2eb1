// SPDX-License-Identifier: GPL-3.0-or-later
// Gravitational deposition [K 3.1.1, Fig. 3.1]: grains fall from a loose cloud onto the
// floor until they are at rest (K 4.20, and no grain still falls). The stiffness is
// chosen so that the contacts on the floor overlap by about `overlap` under all the
// weight above,
//     F = rho g h (1 - porosity) (2 R)^2,   k = 2 F / (overlap R),
// and that no grain of radius r sinks deeper by its own weight: F/R >= m g/r. In a thin
// bed grains would fall through the floor otherwise.
// The cloud starts at the loose fraction and is made thinner until all grains find a
// place; in the end the highest grain closes the box. Trap: at rest is the unbalanced
// ratio of [K 4.20] below the tolerance, which is a mean; a single grain may still
// fall. So no grain may be faster than a tenth of sqrt(2 g R).
//
// With an adapted step (dynamics.c) grains have landed when the ratio is below LANDED
// and none is faster than sqrt(2 g R), but not before twice the time of a free fall
// from the top: a large grain that lands first carries most of the weight. From then on
// each has its own weight.
#include "dynamics.h"
#include "pack.h"

#include "basics/memory.h"
#include "geometry/porosity.h"

#include <math.h>
#include <stdlib.h>

// The domain, extended upwards until grains of VOLUME have the solid fraction CLOUD.
static struct domain cloud_domain(const struct domain *domain, double volume,
                                  double cloud)
{
    struct domain tall = *domain;
    const double height = domain->upper.z - domain->lower.z;
    // The part drawn on is as wide as the whole is on average.
    const double room = domain_volume(domain);
    if (domain->shape != DOMAIN_SPHERE && volume / room > cloud)
        tall.upper.z = domain->lower.z + height * (volume / room) / cloud;
    return tall;
}

// Every attempt starts from the same random numbers, so that the radii are those that
// drawn_fraction saw.
static enum status make_cloud(const struct making *making, int count,
                              struct domain *tall, struct reason *reason)
{
    const double volume = drawn_fraction(making, count) * domain_volume(making->domain);
    // Less fits where walls are near: thinner, until all have a place.
    gsl_rng *same = gsl_rng_clone(making->random);
    double cloud = making->domain->dimensions == 2 ? 0.4 : 0.28;
    const double thinnest = making->domain->shape == DOMAIN_SPHERE ? cloud : 0.01;
    const int64_t most_trials = 100000;
    enum status status;
    do {
        gsl_rng_memcpy(making->random, same);
        *tall = cloud_domain(making->domain, volume, cloud);
        status =
            random_sequential(tall, making->sizes, count, most_trials, making->random,
                              making->progress, making->packing, reason);
        cloud *= 0.8;
    } while (status == STATUS_NOT_CONVERGED && cloud > thinnest);
    gsl_rng_free(same);
    return status;
}

// The stiffness (N/m) at which the floor's contacts, which carry all the weight above,
// overlap by a few times `overlap`.
static double stiffness_for(const struct making *making)
{
    const struct dynamics_parameters *how = making->how;
    if (!isnan(how->stiffness)) return how->stiffness;
    const struct packing *packing = making->packing;
    double radius = 0, volume = 0, largest = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double r = packing->radius[i];
        radius += r / packing->n_particle;
        volume += 4.0 / 3 * M_PI * r * r * r;
        largest = fmax(largest, r);
    }
    const struct vector edge = subtract(making->domain->upper, making->domain->lower);
    const double area =
        making->domain->dimensions == 2 ? edge.x * 2 * radius : edge.x * edge.y;
    const double weight =
        how->density * how->gravity * volume / area; // Pa on the floor
    const double force = weight * 4 * radius * radius;
    const double own = how->density * how->gravity * 4 / 3 * M_PI * largest * largest;
    return 2 * fmax(force, own * radius) / (how->overlap * radius);
}

// The highest point of a grain becomes the top of the box.
static void close_box(const struct making *making)
{
    struct packing *packing = making->packing;
    double top = -INFINITY;
    for (int i = 0; i < packing->n_particle; i++)
        top = fmax(top, packing->position[i].z + packing->radius[i]);
    struct domain *domain = making->domain;
    if (domain->shape == DOMAIN_SPHERE) return;
    domain->upper.z = top;
    domain->centre.z = 0.5 * (domain->lower.z + domain->upper.z);
    packing->lower = domain->lower;
    packing->upper = domain->upper;
}

// The largest speed, of a grain of own inertia with as much kinetic energy: with more
// inertia one that falls is slow.
static double largest_own_speed(const struct making *making, const struct dem *dem)
{
    const struct packing *packing = making->packing;
    const int n = packing->n_particle;
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    double *ratio = NEW_ARRAY(double, n);
    dem_velocities(dem, velocity);
    dem_inertia_ratios(dem, ratio);
    double largest = 0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, norm(velocity[i]) * sqrt(ratio[i]));
    free(velocity);
    free(ratio);
    return largest;
}

// At rest: K 4.20 is met, and no single grain still falls, which a mean would not show.
static bool is_settled(const struct making *making, const struct dem *dem,
                       double typical_speed)
{
    return dem_unbalanced_ratio(dem) < making->how->tolerance &&
           largest_own_speed(making, dem) < 0.1 * typical_speed;
}

// The state of the settling besides the engine, as the numbers of a checkpoint.
struct settling {
    double done;   // between 0 and 1, for the progress bar
    double landed; // 1: grains have
    double adapts; // the cycle from which the step is due to be adapted again
};
static const double LANDED = 0.01;
enum { SETTLING_NUMBERS = sizeof(struct settling) / sizeof(double) };

// Of a grain that has fallen by HEIGHT.
static double fall_speed(const struct making *making, double height)
{
    return sqrt(2 * making->how->gravity * height);
}

// Adapts the step. This takes as long as 40 cycles, and contacts of landed grains
// hardly change: there it is due again when the run is longer by SHARE.
static void adapt(const struct making *making, struct dem *dem, double height,
                  struct settling *settling)
{
    const double cycle = (double)dem_cycle(dem), often = 400, share = 0.05;
    const bool falls = settling->landed == 0;
    even_steps(dem, falls);
    adapt_step(dem, falls, falls ? fall_speed(making, height) : 0);
    settling->adapts = cycle + fmax(often, falls ? 0 : share * cycle);
}

// Ends the fall from HEIGHT when it is over, and adapts the step when it is due.
static void follow(const struct making *making, struct dem *dem, double height,
                   struct settling *settling)
{
    if (!dem_step_is_adapted(dem)) return;
    const double slow = fall_speed(making, mean_radius(making->packing));
    const double fall_time = fall_speed(making, height) / making->how->gravity;
    const bool lands = dem_time(dem) > 2 * fall_time &&
                       dem_unbalanced_ratio(dem) < LANDED &&
                       largest_speed(making, dem) < slow;
    const bool ends = settling->landed == 0 && lands;
    if (ends) land_grains(making, dem);
    if (ends) settling->landed = 1;
    if (ends || (double)dem_cycle(dem) >= settling->adapts)
        adapt(making, dem, height, settling);
}

static void show_progress(const struct making *making, const struct dem *dem,
                          struct settling *settling)
{
    const double ratio = dem_unbalanced_ratio(dem);
    if (!isfinite(ratio) || ratio <= 0) return;
    // from 1 to the tolerance, by digits
    const double done = log(fmin(ratio, 1)) / log(making->how->tolerance);
    settling->done = fmax(settling->done, done);
    progress_update(making->progress, settling->done);
}

// Grains fall from HEIGHT at most.
static enum status settle(const struct making *making, double height, struct dem *dem,
                          struct reason *reason)
{
    const bool adapted = dem_step_is_adapted(dem);
    const int check_every = adapted ? 200 : 500;
    const double typical_speed = fall_speed(making, mean_radius(making->packing));
    struct settling settling = {.landed = !adapted};
    enum status status =
        restore_dynamics(making, dem, (double *)&settling, SETTLING_NUMBERS, reason);
    if (status != STATUS_OK) return status;
    if (adapted && settling.landed > 0) land_grains(making, dem);
    if (adapted && dem_cycle(dem) == 0)
        adapt_step(dem, true, fall_speed(making, height));
    while (dem_cycle(dem) < making->how->most_cycles) {
        status = dem_run(dem, check_every, reason);
        if (status != STATUS_OK) return status;
        if (settling.landed > 0 && is_settled(making, dem, typical_speed))
            return STATUS_OK;
        follow(making, dem, height, &settling);
        show_progress(making, dem, &settling);
        keep_dynamics_if_due(making, dem, (const double *)&settling, SETTLING_NUMBERS);
    }
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "not settled after %lld cycles: unbalanced ratio %.3g, largest speed "
                  "%.3g m/s (pack.dynamics.most_cycles, .tolerance)",
                  (long long)dem_cycle(dem), dem_unbalanced_ratio(dem),
                  largest_speed(making, dem));
}

// Refuses if grains could not even fall to the floor in the cycles allowed.
static enum status check_fall(const struct making *making, const struct domain *tall,
                              const struct dem *dem, struct reason *reason)
{
    const double height = tall->upper.z - tall->lower.z;
    const double cycles = sqrt(2 * height / making->how->gravity) / dem_time_step(dem);
    if (cycles < (double)making->how->most_cycles) return STATUS_OK;
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "falling %g m takes %.3g cycles of %g s, and pack.dynamics.most_cycles "
        "= %lld (.stiffness, .overlap, .gravity)",
        height, cycles, dem_time_step(dem), (long long)making->how->most_cycles);
}

// Given grains fall from where they are. Diameters for radii make grains that touch fit
// at half their size.
static enum status take_cloud(const struct making *making, struct domain *tall,
                              struct reason *reason)
{
    *tall = *making->domain;
    const double least = 0.95, fits = fitting_size(making->packing);
    if (fits >= least) return STATUS_OK;
    packing_free(making->packing);
    return refuse(
        reason, STATUS_BAD_DATA,
        "%s: grains overlap each other or the walls so much that they would fly "
        "apart instead of falling: without overlaps they would be %.3g of their size "
        "(%sseparate them first by pack.method=explosive_repulsion)",
        making->given, fits,
        fits < 0.6 ? "diameters for radii? pack.import.diameters=true halves them; "
                     "otherwise "
                   : "");
}

enum status deposit(const struct making *making, int count, struct reason *reason)
{
    struct domain tall;
    enum status status = count ? make_cloud(making, count, &tall, reason)
                               : take_cloud(making, &tall, reason);
    if (status != STATUS_OK) return status;
    struct dem_wall wall[MAX_WALLS];
    const bool open = making->domain->shape != DOMAIN_SPHERE;
    const int n_wall = domain_walls(&tall, making->how, open, wall);
    const struct vector down = {0, 0, -making->how->gravity};
    struct dem *dem = NULL;
    status = start_dynamics(making, stiffness_for(making), step_safety(making), down,
                            wall, n_wall, &dem, reason);
    if (status == STATUS_OK) status = check_fall(making, &tall, dem, reason);
    if (status == STATUS_OK)
        status = settle(making, tall.upper.z - tall.lower.z, dem, reason);
    if (status == STATUS_OK) {
        making->reached->growth = 1;
        take_grains(making, dem);
        close_box(making);
        note_end(making, dem);
    }
    dem_free(dem);
    if (status != STATUS_OK) packing_free(making->packing);
    return status;
}
