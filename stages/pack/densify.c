// SPDX-License-Identifier: GPL-3.0-or-later
// Radius expansion and domain contraction [K 3.1.1]: from loose points to a dense
// packing, by grains that grow or by a box that contracts, more and more slowly.
//
// With an adapted step (dynamics.c) strains come at the same times as with a step of a
// tenth of [K 4.47], `pace`, and are as large: what decides how dense grains jam is the
// rate of strain over that of their rearrangement.
//
// Strain is the relative change of lengths, of all radii or of the box. It is applied
// in small steps, with some cycles of dynamics in between. The stress is measured as
//     scaled stress = mean stress 2 radius / pair_stiffness,
// about the mean overlap over the diameter, and steered to its target: each step
// strains by (target - stress) / 1.2, at most `most`, and whenever the stress is above
// the target `most` halves, so that the end is approached quasi-statically.
//
// To a porosity the total strain is known,
//     strain = (solid wanted / solid now)^(1/dimensions) - 1;
// to a coordination the pressure is raised by a quarter at a time, at rest each time,
// until it is reached. Given grains that overlap are shrunk, or spread, first.
// Contraction needs a box that repeats along all axes; between walls grains grow.
#include "dynamics.h"
#include "pack.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The solid fraction that random sequential addition reaches easily.
static double loose_fraction(const struct domain *domain)
{
    return domain->dimensions == 2 ? 0.4 : 0.28;
}

struct densification {
    const struct making *making;
    struct dem *dem;
    bool grow;
    double most;                   // largest strain of a step
    bool jammed;                   // once grains have found their places
    double done;                   // between 0 and 1, for the progress bar
    double pair_stiffness, radius; // N/m, m by volume: the scale of pressure
    double target;                 // scaled stress being approached, 0: none
    double gone_on_at; // of a run that was stopped: the target it was at; 0 once met
    double pace;       // s, the step that strains are timed by
    double strains;    // done so far
};

// ---- stopping and going on ----------------------------------------------------------

// The state of the protocol besides the engine, as the numbers of a checkpoint.
struct protocol {
    double most, jammed, target, growth, strains;
    struct vector lower, upper, centre, cut_lower, cut_upper;
};
enum { PROTOCOL_NUMBERS = sizeof(struct protocol) / sizeof(double) };

static struct protocol protocol_now(const struct densification *d)
{
    const struct domain *domain = d->making->domain;
    return (struct protocol){.most = d->most,
                             .jammed = d->jammed,
                             .target = d->target,
                             .growth = d->making->reached->growth,
                             .strains = d->strains,
                             .lower = domain->lower,
                             .upper = domain->upper,
                             .centre = domain->centre,
                             .cut_lower = domain->cut_lower,
                             .cut_upper = domain->cut_upper};
}

static void keep_protocol(const struct densification *d)
{
    const struct protocol protocol = protocol_now(d);
    keep_dynamics_if_due(d->making, d->dem, (const double *)&protocol,
                         PROTOCOL_NUMBERS);
}

static enum status restore_protocol(struct densification *d, struct reason *reason)
{
    struct protocol protocol = protocol_now(d);
    const enum status status = restore_dynamics(d->making, d->dem, (double *)&protocol,
                                                PROTOCOL_NUMBERS, reason);
    if (status != STATUS_OK) return status;
    d->most = protocol.most;
    d->jammed = protocol.jammed > 0;
    d->target = d->gone_on_at = protocol.target;
    d->making->reached->growth = protocol.growth;
    d->strains = protocol.strains;
    struct domain *domain = d->making->domain;
    d->making->packing->lower = domain->lower = protocol.lower;
    d->making->packing->upper = domain->upper = protocol.upper;
    domain->centre = protocol.centre;
    domain->cut_lower = protocol.cut_lower;
    domain->cut_upper = protocol.cut_upper;
    return STATUS_OK;
}

// Whether a restored run had reached this TARGET already.
static bool was_done(struct densification *d, double target)
{
    const bool done = d->gone_on_at > 0 && target != d->gone_on_at;
    if (!done) d->gone_on_at = 0;
    return done;
}

// ---- straining ----------------------------------------------------------------------

static double solid_now(const struct densification *d)
{
    take_grains(d->making, d->dem);
    struct domain *domain = d->making->domain;
    return solid_fraction(domain, d->making->packing);
}

// In two dimensions the layer stays as thick as its largest grain.
static void thicken_layer(const struct making *making)
{
    struct domain *domain = making->domain;
    if (domain->dimensions != 2) return;
    const double half = making->sizes->largest * making->reached->growth;
    domain->cut_lower.y = domain->lower.y = domain->centre.y - half;
    domain->cut_upper.y = domain->upper.y = domain->centre.y + half;
    making->packing->lower = domain->lower;
    making->packing->upper = domain->upper;
}

// Applies a strain of BY: radii grow, or the box contracts with all positions.
static void strain(struct densification *d, double by)
{
    struct domain *domain = d->making->domain;
    const double one[3] = {1, 1, 1};
    if (d->grow) {
        dem_rescale(d->dem, one, 1 + by);
        d->making->reached->growth *= 1 + by;
        thicken_layer(d->making);
        return;
    }
    const bool flat = domain->dimensions == 2;
    const double closer = 1 - by;
    const double stretch[3] = {closer, flat ? 1 : closer, closer};
    dem_rescale(d->dem, stretch, 1);
    dem_box(d->dem, &domain->lower, &domain->upper);
    domain->centre = scale(0.5, add(domain->lower, domain->upper));
    d->making->packing->lower = domain->lower;
    d->making->packing->upper = domain->upper;
}

// The strain from now to the SOLID fraction wanted.
static double strain_to(const struct densification *d, double solid)
{
    const int dimensions = d->making->domain->dimensions;
    return pow(solid / solid_now(d), 1.0 / dimensions) - 1;
}

// Stress over its scale, pair_stiffness / (2 radius).
static double scaled_stress(const struct densification *d)
{
    return mean_stress(d->making, d->dem) * 2 * d->radius / d->pair_stiffness;
}

// ---- to a pressure ------------------------------------------------------------------

// The strain that brings the stress from NOW to TARGET, a little underestimated: a
// jammed packing has about a third of its contacts' stiffness in each of three
// dimensions.
static double strain_for(double now, double target)
{
    return (target - now) / 1.2;
}

enum { CYCLES = 20 }; // of the pace, between two strains

// Runs until the next strain. Every so often the step is adapted.
static enum status run_a_while(struct densification *d, struct reason *reason)
{
    enum { ADAPT_EVERY = 25 };
    const bool adapted = dem_step_is_adapted(d->dem);
    const double cycles = CYCLES * (adapted ? d->pace / dem_time_step(d->dem) : 1);
    const enum status status = dem_run(d->dem, (int64_t)fmax(1, rint(cycles)), reason);
    d->strains++;
    if (status != STATUS_OK || !adapted) return status;
    if (fmod(d->strains, ADAPT_EVERY) != 0) return status;
    if (d->jammed) even_steps(d->dem, false);
    adapt_step(d->dem, !d->jammed, 0);
    return status;
}

// The largest strain of a step for which inertia is negligible at the stress TARGET:
// with CYCLES time steps of a tenth of a contact's period the inertial number is about
// 1e-3.
static double quasi_static_strain(double target)
{
    return 4e-3 * sqrt(target);
}

// One step towards TARGET. Before grains jam, the stress comes from collisions and does
// not depend on the strain: then the strain is the largest allowed, or none.
static void servo(struct densification *d, double now, double target)
{
    const double flowing = 0.05;
    if (!d->jammed && now > 0.5 * target && dem_unbalanced_ratio(d->dem) < flowing)
        d->jammed = true;
    if (now > target) d->most = fmax(0.5 * d->most, quasi_static_strain(target));
    double by = d->jammed ? strain_for(now, target) : now < target ? d->most : 0;
    by = fmin(fmax(by, -d->most), d->most);
    if (by != 0) strain(d, by);
}

static enum status give_up(const struct densification *d, const char *what, double got,
                           double wanted, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "%s %.4g is not the target %.4g after %lld cycles: unbalanced ratio "
                  "%.3g (pack.dynamics.most_cycles, .tolerance)",
                  what, got, wanted, (long long)dem_cycle(d->dem),
                  dem_unbalanced_ratio(d->dem));
}

// Stops grains without contacts. Rattlers would fly through their cages and hit others
// forever: local damping takes nothing from a grain without contact.
static void stop_rattlers(const struct densification *d)
{
    const int n = d->making->packing->n_particle;
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    bool *touches = NEW_ARRAY(bool, n);
    int count;
    struct dem_contact *contact = dem_contacts(d->dem, &count);
    for (int k = 0; k < count; k++)
        for (int end = 0; end < 2; end++)
            if (contact[k].particle[end] >= 0) touches[contact[k].particle[end]] = true;
    dem_velocities(d->dem, velocity);
    for (int i = 0; i < n; i++)
        if (!touches[i]) velocity[i] = (struct vector){0, 0, 0};
    dem_set_velocity(d->dem, velocity, NULL);
    free(contact);
    free(touches);
    free(velocity);
}

// Progress: the first half until grains jam, the second until rest, by digits of the
// unbalanced ratio.
static void show_progress(struct densification *d)
{
    const bool flat = d->making->domain->dimensions == 2;
    const double loose = loose_fraction(d->making->domain), jam = flat ? 0.84 : 0.64;
    const double rest =
        log(dem_unbalanced_ratio(d->dem)) / log(d->making->how->tolerance);
    const double done = d->jammed ? 0.5 + 0.5 * fmax(rest, 0)
                                  : 0.5 * (solid_now(d) - loose) / (jam - loose);
    if (isfinite(done)) d->done = fmax(d->done, fmin(done, 0.99));
    progress_update(d->making->progress, d->done);
}

// Presses until the packing is at rest at the scaled stress TARGET, to 1 %.
static enum status press(struct densification *d, double target, double tolerance,
                         struct reason *reason)
{
    enum { STOP_EVERY = 50, SHOW_EVERY = 25 };
    const struct dynamics_parameters *how = d->making->how;
    const double near = 0.01;
    d->target = target;
    while (dem_cycle(d->dem) < how->most_cycles) {
        const enum status status = run_a_while(d, reason);
        if (status != STATUS_OK) return status;
        const double now = scaled_stress(d);
        const bool there = fabs(now / target - 1) < near;
        if (there && dem_unbalanced_ratio(d->dem) < tolerance) return STATUS_OK;
        servo(d, now, target);
        if (d->jammed && fmod(d->strains, STOP_EVERY) == 0) stop_rattlers(d);
        keep_protocol(d);
        if (fmod(d->strains, SHOW_EVERY) == 0) show_progress(d);
    }
    return give_up(d, "stress over its scale", scaled_stress(d), target, reason);
}

// A packing without friction has no memory of a higher pressure, and comes to rest
// sooner from above, where its soft modes are stiffer.
static enum status press_from_above(struct densification *d, double target,
                                    struct reason *reason)
{
    const struct dynamics_parameters *how = d->making->how;
    enum status status = STATUS_OK;
    const double rough = 0.01;
    if (how->friction <= 0)
        for (double above = 1e-3; status == STATUS_OK && above > 2 * target; above /= 3)
            if (!was_done(d, above)) status = press(d, above, rough, reason);
    return status == STATUS_OK ? press(d, target, how->tolerance, reason) : status;
}

// ---- to a porosity ------------------------------------------------------------------

// Runs until rest at the porosity wanted: by K 4.20 if grains touch, by their speed if
// they do not.
static enum status rest(struct densification *d, struct reason *reason)
{
    enum { CYCLES_OF_REST = 100 };
    const struct dynamics_parameters *how = d->making->how;
    const double still = how->tolerance * d->radius / d->pace; // a radius in 1e4 steps
    while (dem_cycle(d->dem) < how->most_cycles) {
        const enum status status = dem_run(d->dem, CYCLES_OF_REST, reason);
        if (status != STATUS_OK) return status;
        if (dem_step_is_adapted(d->dem)) adapt_step(d->dem, false, 0);
        const double ratio = dem_unbalanced_ratio(d->dem);
        if (ratio < how->tolerance && largest_speed(d->making, d->dem) < still)
            return STATUS_OK;
        keep_protocol(d);
    }
    return give_up(d, "unbalanced ratio", dem_unbalanced_ratio(d->dem), how->tolerance,
                   reason);
}

static enum status strain_to_porosity(struct densification *d, double porosity,
                                      struct reason *reason)
{
    const double total = strain_to(d, 1 - porosity);
    for (double left = total; left > 1e-12;) {
        strain(d, fmin(left, d->most));
        const enum status status = run_a_while(d, reason);
        if (status != STATUS_OK) return status;
        left = strain_to(d, 1 - porosity);
        progress_update(d->making->progress, 1 - left / total);
        if (dem_cycle(d->dem) > d->making->how->most_cycles)
            return give_up(d, "porosity", 1 - solid_now(d), porosity, reason);
        keep_protocol(d);
    }
    return rest(d, reason);
}

// ---- to a coordination --------------------------------------------------------------

// Raises the pressure by a quarter at a time, at rest each time, until the coordination
// is reached.
static enum status press_to_contacts(struct densification *d, double wanted,
                                     struct reason *reason)
{
    enum { TARGETS = 42 }; // the last below 0.1
    double target = 1e-5;
    for (int k = 0; k < TARGETS; k++, target *= 1.25) {
        if (was_done(d, target)) continue;
        const enum status status = press(d, target, d->making->how->tolerance, reason);
        if (status != STATUS_OK) return status;
        take_grains(d->making, d->dem);
        if (backbone_coordination(d->making, d->dem) >= wanted) return STATUS_OK;
        d->most = fmax(d->most, 0.1 * target);
    }
    return give_up(d, "coordination", backbone_coordination(d->making, d->dem), wanted,
                   reason);
}

// ---- the whole ----------------------------------------------------------------------

static enum status reach_target(struct densification *d, struct reason *reason)
{
    const struct dynamics_parameters *how = d->making->how;
    switch ((enum target)how->target) {
    case TARGET_POROSITY:
        return strain_to_porosity(d, how->value, reason);
    case TARGET_COORDINATION:
        return press_to_contacts(d, how->value, reason);
    case TARGET_PRESSURE:
        return press_from_above(d, how->value * 2 * d->radius / d->pair_stiffness,
                                reason);
    default: // jammed, at the overlap asked for
        return press_from_above(d, how->overlap, reason);
    }
}

// Stiffness of a grain, N/m. Its value is arbitrary unless the target is a pressure in
// Pa.
static double stiffness_for(const struct dynamics_parameters *how, double radius)
{
    if (!isnan(how->stiffness)) return how->stiffness;
    if (how->target == TARGET_PRESSURE)
        return 2 * how->value * 2 * radius / how->overlap;
    // So that the critical time step is of the order of a microsecond and one.
    return how->density * radius * radius * radius * 1e12;
}

// The step of K 4.47 times a tenth, for the mean mass; a fixed step is its own.
static double pace_of(const struct densification *d)
{
    const struct making *making = d->making;
    const struct packing *packing = making->packing;
    if (!dem_step_is_adapted(d->dem)) return dem_time_step(d->dem);
    double mass = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double r = packing->radius[i];
        mass += making->how->density * (4 * M_PI / 3) * r * r * r / packing->n_particle;
    }
    return 0.1 * 2 * sqrt(mass / d->pair_stiffness);
}

// Scales all positions, and the box with them, by LENGTHS from its lower corner.
static void stretch_all(const struct making *making, double lengths)
{
    struct packing *packing = making->packing;
    struct domain *domain = making->domain;
    const bool flat = domain->dimensions == 2;
    for (int i = 0; i < packing->n_particle; i++) {
        const double y = packing->position[i].y;
        const struct vector from = subtract(packing->position[i], domain->lower);
        packing->position[i] = add(domain->lower, scale(lengths, from));
        if (flat) packing->position[i].y = y;
    }
    domain_stretch(domain, lengths);
    packing->lower = domain->lower;
    packing->upper = domain->upper;
}

// Random points for grains at the loose fraction: shrunk grains, or a larger box.
static enum status make_loose(const struct making *making, int count, bool grow,
                              double *shrunk, struct reason *reason)
{
    struct domain *domain = making->domain;
    const double solid = drawn_fraction(making, count);
    // Less fits where walls are near: looser, until all have a place.
    gsl_rng *same = gsl_rng_clone(making->random);
    const int64_t most_trials = 100000;
    double loose = loose_fraction(domain), stretched = 1;
    enum status status;
    do {
        gsl_rng_memcpy(making->random, same);
        *shrunk = pow(fmin(1, loose / solid), 1.0 / domain->dimensions);
        struct sizes sizes = *making->sizes;
        if (grow)
            sizes_scale(&sizes, *shrunk);
        else
            domain_stretch(domain, 1 / (*shrunk * stretched));
        stretched = 1 / *shrunk;
        status = random_sequential(domain, &sizes, count, most_trials, making->random,
                                   making->progress, making->packing, reason);
        loose *= 0.8;
    } while (status == STATUS_NOT_CONVERGED && loose > 0.01);
    gsl_rng_free(same);
    return status;
}

// Given grains, shrunk or moved apart until none overlaps another.
static enum status loosen(const struct making *making, bool grow, double *shrunk,
                          struct reason *reason)
{
    struct packing *packing = making->packing;
    const double least = 0.1;
    *shrunk = fitting_size(packing);
    if (*shrunk < least) {
        packing_free(packing);
        return refuse(
            reason, STATUS_BAD_DATA,
            "%s: grains are nearly in one place, or outside the box, and would have to "
            "be %.3g as large not to overlap (part them by "
            "pack.method=explosive_repulsion)",
            making->given, *shrunk);
    }
    if (!grow) stretch_all(making, 1 / *shrunk);
    for (int i = 0; i < packing->n_particle && grow; i++)
        packing->radius[i] *= *shrunk;
    return STATUS_OK;
}

// Mean radius by volume: of the grains that carry the stress. By number it would be
// that of the fines, and the same stress would press large grains into each other. The
// sum is in units of the first radius, so that no fourth power underflows.
static double typical_radius(const struct packing *packing)
{
    const double first = packing->n_particle > 0 ? packing->radius[0] : 1;
    double volume = 0, moment = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double ratio = packing->radius[i] / first;
        const double cube = ratio * ratio * ratio;
        volume += cube;
        moment += cube * ratio;
    }
    return volume > 0 ? first * (moment / volume) : first;
}

static enum status check_contraction(const struct domain *domain, struct reason *reason)
{
    bool closed = domain->shape != DOMAIN_BOX || domain->cut != CUT_NONE;
    for (int axis = 0; axis < 3; axis++)
        closed = closed ||
                 !(domain->periodic[axis] || (domain->dimensions == 2 && axis == 1));
    if (!closed) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.method: domain_contraction closes in a box that repeats along "
                  "all axes (pack.periodic); between walls use radius_expansion");
}

// Restores the SIZES of given grains: their growth becomes a contraction of the box.
static void restore_sizes(const struct making *making, const double *sizes)
{
    const double back = 1 / making->reached->growth;
    making->reached->growth = 1;
    making->reached->pressure /= back; // the same overlaps, of smaller grains
    stretch_all(making, back);
    const size_t n = (size_t)making->packing->n_particle;
    memcpy(making->packing->radius, sizes, n * sizeof *sizes);
    thicken_layer(making);
}

enum status densify(const struct making *making, int count, bool grow,
                    struct reason *reason)
{
    enum status status = grow ? STATUS_OK : check_contraction(making->domain, reason);
    double shrunk, *sizes = NULL;
    if (!count && grow)
        sizes = duplicate(making->packing->radius, (size_t)making->packing->n_particle,
                          sizeof *sizes);
    if (status == STATUS_OK)
        status = count ? make_loose(making, count, grow, &shrunk, reason)
                       : loosen(making, grow, &shrunk, reason);
    if (status != STATUS_OK) {
        free(sizes);
        return status;
    }

    const double first_step = 1e-3;
    struct dem_wall wall[MAX_WALLS];
    const int n_wall = domain_walls(making->domain, making->how, false, wall);
    struct densification d = {.making = making,
                              .grow = grow,
                              .most = first_step,
                              .radius = typical_radius(making->packing) /
                                        (grow ? shrunk : 1)};
    const double stiffness = stiffness_for(making->how, d.radius);
    d.pair_stiffness = 0.5 * stiffness;
    making->reached->growth = grow ? shrunk : 1;
    thicken_layer(making);
    const struct vector none = {0, 0, 0};
    status = start_dynamics(making, stiffness, step_safety(making), none, wall, n_wall,
                            &d.dem, reason);
    if (status == STATUS_OK) d.pace = pace_of(&d);
    if (status == STATUS_OK) status = restore_protocol(&d, reason);
    if (status == STATUS_OK) status = reach_target(&d, reason);
    if (status == STATUS_OK) {
        take_grains(making, d.dem);
        note_end(making, d.dem);
        if (sizes) restore_sizes(making, sizes);
    }
    dem_free(d.dem);
    free(sizes);
    if (status != STATUS_OK) packing_free(making->packing);
    return status;
}
