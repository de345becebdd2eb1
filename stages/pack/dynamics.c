// SPDX-License-Identifier: GPL-3.0-or-later
// What the moving methods share: walls of the domain for the engine, an engine for the
// packing, and measures of its state. Speeds and stresses are compared with scales of
// the method, never with absolute numbers. Note that the engine's stress is over the
// box it began with: mean_stress corrects for the volume of the domain.
//     mean stress  = (sxx + syy + szz) / dimensions  box / domain volume,
//     coordination = sum of contacts / grains, over those with enough to be stable,
//     solid        = sum of (4/3) pi r^3 / domain volume  (discs: pi r^2 thickness).
// Without gravity every grain gets the inertia of the mean one (density_scaling), so
// that small grains do not shorten the time step.
//
// A fixed step is a share of [K 4.47], a tenth where radii are wide. An adapted one is
// ADAPTED_SHARE of the stability limit (dem/relaxation.c), found again as contacts
// form, and under gravity
//     inertia = max(m, mean m).
// Besides, a grain with many contacts gets as much inertia as it takes for a step that
// does not fall with their number (dem_even_steps); but not while grains flow without
// gravity, where their inertia decides how dense they jam.
// While grains fall, weights are in proportion to it; at rest each has its own.
#include "dynamics.h"

#include "basics/memory.h"
#include "dem/keep.h"
#include "geometry/neighbours.h"
#include "geometry/porosity.h"
#include "pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// DIRECTION is 1 for a lower side, -1 for an upper one: the normal points to the
// grains.
static struct dem_wall plane(struct vector point, int axis, double direction)
{
    struct dem_wall wall = {.point = point};
    set_component(&wall.normal, axis, direction);
    return wall;
}

// No walls where the box repeats, across a plane, and where round walls stand; OPEN
// leaves the top away.
static int box_walls(const struct domain *domain, bool open, struct dem_wall *wall)
{
    const bool round = domain->shape != DOMAIN_BOX;
    int n = 0;
    for (int axis = 0; axis < 3; axis++) {
        const bool flat = domain->dimensions == 2 && axis == 1;
        if (domain->periodic[axis] || flat || (round && axis != 2)) continue;
        wall[n++] = plane(domain->lower, axis, 1);
        if (!(open && axis == 2)) wall[n++] = plane(domain->upper, axis, -1);
    }
    return n;
}

static struct dem_wall round_wall(enum dem_wall_shape shape, struct vector centre,
                                  double radius, bool outside)
{
    return (struct dem_wall){.point = centre,
                             .normal = {0, 0, 1},
                             .shape = shape,
                             .outside = outside,
                             .radius = radius};
}

// Grains are outside of what is cut out; a block is so by nature.
static int cut_walls(const struct domain *domain, struct dem_wall *wall)
{
    const struct vector edge = subtract(domain->cut_upper, domain->cut_lower);
    if (domain->cut == CUT_NONE) return 0;
    if (domain->cut == CUT_BOX)
        *wall = (struct dem_wall){.point = domain->cut_centre,
                                  .shape = DEM_BLOCK,
                                  .half_edge = scale(0.5, edge)};
    if (domain->cut == CUT_CYLINDER)
        *wall = round_wall(DEM_CYLINDER, domain->cut_centre, domain->cut_radius, true);
    if (domain->cut == CUT_SPHERE)
        *wall = round_wall(DEM_SPHERE, domain->cut_centre, domain->cut_radius, true);
    return 1;
}

// The factor by which all radii must shrink so that nothing overlaps: the least of
// distance over sum of radii, for pairs, and over the radius, for walls.
double fitting_size(const struct packing *packing)
{
    double fits = 1;
    const bool flat = packing_is_flat(packing);
    int count;
    int32_t(*pair)[2] = neighbour_pairs(packing, 0, &count);
    for (int k = 0; k < count; k++) {
        const int i = pair[k][0], j = pair[k][1];
        fits = fmin(fits, norm(nearest_image(packing, i, j)) /
                              (packing->radius[i] + packing->radius[j]));
    }
    free(pair);
    for (int i = 0; i < packing->n_particle; i++)
        for (int wall = 0; wall < WALL_COUNT; wall++) {
            const int axis = wall / 2;
            if (packing->periodic[axis] || (flat && axis == 1)) continue;
            const double x = component(packing->position[i], axis);
            const double at = wall_position(packing, wall);
            fits = fmin(fits, (wall % 2 ? at - x : x - at) / packing->radius[i]);
        }
    for (int i = 0; i < packing->n_particle; i++)
        fits = fmin(fits, depth_in_bodies(packing, packing->position[i]) /
                              packing->radius[i]);
    return fits;
}

// Round walls after flat ones; MAX_WALLS is enough for all shapes with a cut-out.
int domain_walls(const struct domain *domain, const struct dynamics_parameters *how,
                 bool open, struct dem_wall wall[MAX_WALLS])
{
    int n = 0;
    const struct vector centre = domain->centre;
    if (domain->shape == DOMAIN_SPHERE)
        wall[n++] = round_wall(DEM_SPHERE, centre, domain->radius, false);
    else
        n += box_walls(domain, open, wall);
    if (domain->shape == DOMAIN_CYLINDER || domain->shape == DOMAIN_RING)
        wall[n++] = round_wall(DEM_CYLINDER, centre, domain->radius, false);
    if (domain->shape == DOMAIN_RING)
        wall[n++] = round_wall(DEM_CYLINDER, centre, domain->inner_radius, true);
    n += cut_walls(domain, wall + n);
    for (int w = 0; w < n; w++) {
        wall[w].has_friction = !isnan(how->wall_friction);
        wall[w].friction = wall[w].has_friction ? how->wall_friction : 0;
    }
    return n;
}

// Overlaps count twice. In two dimensions discs fill the layer.
double solid_fraction(const struct domain *domain, const struct packing *packing)
{
    const double room = domain_volume(domain);
    const double thick = domain->upper.y - domain->lower.y;
    double share = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double radius = packing->radius[i];
        share += M_PI * radius * radius / room *
                 (domain->dimensions == 2 ? thick : 4 * radius / 3);
    }
    return share;
}

// A clone of the random stream: the grains drawn later are these.
double drawn_fraction(const struct making *making, int count)
{
    gsl_rng *same = gsl_rng_clone(making->random);
    struct packing drawn = packing_in(making->domain, count);
    for (int i = 0; i < count; i++)
        drawn.radius[i] = sizes_draw(making->sizes, same);
    const double fraction = solid_fraction(making->domain, &drawn);
    packing_free(&drawn);
    gsl_rng_free(same);
    return fraction;
}

// The limit is a bound; the rest is for contacts that form before it is found again.
static const double ADAPTED_SHARE = 0.95;

// The mean grain's mass over the least one's, from which fines keep their own inertia:
// with more they settle into looser beds; and from which the step is fixed: fines that
// met grains of 8000 times their mass in steps near the limit came to rest in another
// fabric (docs/packings.md). 2000 lognormal radii reach 30 at a spread of about 0.3.
static const double WIDE = 30, WIDEST = 300;

static double mass_ratio(const struct packing *packing)
{
    double mean = 0, least = INFINITY;
    for (int i = 0; i < packing->n_particle; i++) {
        const double volume = pow(packing->radius[i], 3);
        mean += volume / packing->n_particle;
        least = fmin(least, volume);
    }
    return mean / least;
}

double fixed_safety(const struct making *making)
{
    const double usual = 0.1;
    return isnan(making->how->safety) ? usual : making->how->safety;
}

double step_safety(const struct making *making)
{
    return mass_ratio(making->packing) > WIDEST ? fixed_safety(making)
                                                : making->how->safety;
}

void adapt_step(struct dem *dem, bool fall, double speed)
{
    dem_adapt_time_step(dem, ADAPTED_SHARE, !fall, speed);
}

// Tried: 5 or 3, 7 or 5, 4 or 2. With fewer contacts nearly all grains become heavier,
// and slower, which gains nothing.
void even_steps(struct dem *dem, bool fall)
{
    dem_even_steps(dem, fall ? 5 : 3, !fall);
}

// Over the mean grain's.
static double least_mass(const struct making *making)
{
    return mass_ratio(making->packing) > WIDE ? 0 : 1;
}

void land_grains(const struct making *making, struct dem *dem)
{
    dem_set_least_mass(dem, least_mass(making), false);
}

// Damping ratio and stiffness are the same in all methods; what differs is gravity,
// walls and the safety of the step.
enum status start_dynamics(const struct making *making, double stiffness, double safety,
                           struct vector gravity, const struct dem_wall *wall,
                           int n_wall, struct dem **dem, struct reason *reason)
{
    const struct dynamics_parameters *how = making->how;
    const bool statics = norm(gravity) <= 0;
    const struct dem_setup setup = {
        .packing = making->packing,
        .material = {.density = how->density,
                     .normal_stiffness = stiffness,
                     .shear_stiffness = how->shear_ratio * stiffness,
                     .friction = how->friction,
                     .damping_ratio = how->damping,
                     .local_damping = how->local_damping},
        .n_wall = n_wall,
        .wall = wall,
        .gravity = gravity,
        .density_scaling = statics,
        .time_step_safety = safety,
        .safety_key = "pack.dynamics.time_step_safety",
        .threads = how->threads};
    const enum status status = dem_create(dem, &setup, reason);
    if (status != STATUS_OK) return status;
    making->reached->stiffness = stiffness;
    if (!isnan(safety)) return STATUS_OK;
    if (!statics) dem_set_least_mass(*dem, least_mass(making), true);
    adapt_step(*dem, true, 0);
    return STATUS_OK;
}

// PROTOCOL is what a method must remember besides the engine: COUNT numbers of its own.
enum status restore_dynamics(const struct making *making, struct dem *dem,
                             double *protocol, int count, struct reason *reason)
{
    const struct keeper *keeper = making->how->keeper;
    if (!keeper || !keeper->begin) return STATUS_OK;
    const struct kept_state *state = keeper->begin;
    const enum status status =
        dem_restore(dem, state->engine.array, state->engine.count, reason);
    if (status != STATUS_OK) return status;
    struct array_reader reader = {.list = &state->stage, .reason = reason};
    const double *kept =
        read_array(&reader, "protocol", ARRAY_FLOAT64, count, -1e150, 1e150);
    if (reader.failed) return STATUS_BAD_DATA;
    memcpy(protocol, kept, (size_t)count * sizeof *kept);
    return STATUS_OK;
}

void keep_dynamics_if_due(const struct making *making, const struct dem *dem,
                          const double *protocol, int count)
{
    struct array_list list = {NULL, 0};
    if (!is_due(making->how->keeper)) return;
    add_array(&list, "protocol", ARRAY_FLOAT64, count, protocol);
    keep_state(making->how->keeper, dem, list);
}

// Radii too, because some methods let grains grow.
void take_grains(const struct making *making, const struct dem *dem)
{
    struct packing *packing = making->packing;
    dem_positions(dem, packing->position);
    dem_radii(dem, packing->radius);
    for (int i = 0; i < packing->n_particle; i++)
        packing->position[i] = domain_wrap(making->domain, packing->position[i]);
}

double largest_speed(const struct making *making, const struct dem *dem)
{
    const int n = making->packing->n_particle;
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    dem_velocities(dem, velocity);
    double largest = 0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, norm(velocity[i]));
    free(velocity);
    return largest;
}

// The engine divides by the volume of its box, not of the domain. Round domains fill
// only part of the engine's box. Compression is positive.
double mean_stress(const struct making *making, const struct dem *dem)
{
    const struct dem_census census = dem_census(dem);
    const double sum = census.stress[0][0] + census.stress[1][1] + census.stress[2][2];
    struct vector lower, upper;
    dem_box(dem, &lower, &upper);
    const struct vector edge = subtract(upper, lower);
    const double room = domain_volume(making->domain) / box_volume(edge);
    return sum / making->domain->dimensions / room;
}

// Grains with too few contacts to be held are left out, once: what they leave behind is
// not looked at again.
double backbone_coordination(const struct making *making, const struct dem *dem)
{
    const int n = making->packing->n_particle;
    const bool has_friction = making->how->friction > 0;
    const int least = has_friction ? 2 : making->domain->dimensions + 1;
    int *contacts = NEW_ARRAY(int, n), count;
    struct dem_contact *contact = dem_contacts(dem, &count);
    for (int k = 0; k < count; k++)
        for (int end = 0; end < 2; end++)
            if (contact[k].particle[end] >= 0) contacts[contact[k].particle[end]]++;
    double sum = 0;
    int backbone = 0;
    for (int i = 0; i < n; i++)
        if (contacts[i] >= least) {
            sum += contacts[i];
            backbone++;
        }
    free(contact);
    free(contacts);
    return backbone > 0 ? sum / backbone : 0;
}

// CYCLES and TIME add up, because a method may run several engines.
void note_end(const struct making *making, const struct dem *dem)
{
    struct reached *reached = making->reached;
    reached->dynamic = true;
    reached->unbalanced_ratio = dem_unbalanced_ratio(dem);
    reached->cycles += dem_cycle(dem);
    reached->time_step = dem_time_step(dem);
    reached->time += dem_time(dem);
    reached->largest_speed = largest_speed(making, dem);
    reached->pressure = mean_stress(making, dem);
    const double porosity = 1 - solid_fraction(making->domain, making->packing);
    switch ((enum target)making->how->target) {
    case TARGET_SETTLED:
        reached->value = reached->unbalanced_ratio;
        break;
    case TARGET_POROSITY:
        reached->value = porosity;
        break;
    case TARGET_COORDINATION:
        reached->value = backbone_coordination(making, dem);
        break;
    case TARGET_PRESSURE:
        reached->value = reached->pressure;
        break;
    }
}
