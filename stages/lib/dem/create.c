// SPDX-License-Identifier: GPL-3.0-or-later
// From a packing and materials in SI to an engine in its own units.
//
// Units: length is the mean radius, mass the mean grain mass, stiffness the largest
// that any pair can have, and time = sqrt(mass / stiffness). So the stiffest mean pair
// has k = m = 1, and the critical step of [K 4.47], 2 sqrt(m/k), is 2 for it.
//
// Order matters: materials and grains first, as they decide which features the pair
// sweep needs; then walls and liquid, as they decide how far pairs are sought; then
// grains are numbered along the curve, pairs are found, and last the time step, which
// depends on the pairs.
#include "dem/engine.h"

#include "basics/cpu_features.h"
#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double grain_mass(const struct dem_setup *setup, int particle)
{
    const int kind = setup->material_of ? setup->material_of[particle] : 0;
    const double radius = setup->packing->radius[particle];
    return material(setup, kind)->density * (4.0 / 3 * M_PI) * radius * radius * radius;
}

static double bond_radius(const struct dem_setup *setup, int bond)
{
    const int32_t *end = setup->packing->bond[bond];
    return setup->bond.radius_fraction *
           fmin(setup->packing->radius[end[0]], setup->packing->radius[end[1]]);
}

// The largest translational stiffness between two grains, or a grain and a wall, N/m,
// of linear contacts and bonds. Two equal springs in series make half of one. A wall is
// rigid unless it says otherwise, so a grain at a wall keeps its whole stiffness. A
// contact bond has the stiffness of the contact.
static double largest_linear_stiffness(const struct dem_setup *setup)
{
    double normal_stiffness = 0, shear_stiffness = 0;
    for (int k = 0; k <= setup->n_other; k++) {
        const struct dem_material *m = material(setup, k);
        normal_stiffness = fmax(normal_stiffness, m->normal_stiffness);
        shear_stiffness = fmax(shear_stiffness, m->shear_stiffness);
    }
    const double grain = fmax(normal_stiffness, shear_stiffness);
    double largest = setup->n_wall > 0 ? grain : 0.5 * grain;
    if (setup->bond.kind == DEM_CONTACT_BOND) return largest;
    for (int b = 0; b < setup->packing->n_bond; b++) {
        const double radius = bond_radius(setup, b), area = M_PI * radius * radius;
        const double normal =
            0.5 * normal_stiffness + setup->bond.normal_stiffness * area;
        const double shear = 0.5 * shear_stiffness + setup->bond.shear_stiffness * area;
        largest = fmax(largest, fmax(normal, shear));
    }
    return largest;
}

// Stiffness of [G 2] for the heaviest pair, or the heaviest grain at a wall. k = m
// (pi^2 + ln^2 e) / t^2 rises with the mass and as e falls: the heaviest pair with the
// smallest restitution bounds it. Two equal grains have half the mass of one.
static double largest_timed_stiffness(const struct dem_setup *setup, double heaviest)
{
    double logarithm = 0;
    for (int k = 0; k <= setup->n_other; k++)
        logarithm = fmin(logarithm, log(material(setup, k)->restitution));
    const int n = 1 + setup->n_other;
    for (int k = 0; setup->pair_restitution && k < n * n; k++)
        logarithm = fmin(logarithm, log(setup->pair_restitution[k]));
    const double t = setup->material.contact_time;
    const double mass = setup->n_wall > 0 ? heaviest : 0.5 * heaviest;
    return mass * (M_PI * M_PI + logarithm * logarithm) / (t * t);
}

// Hertz: tangent 2 E* sqrt(R* U) of the stiffest material at the largest overlap
// expected. The stiffest partner is a rigid wall. Only a unit: a contact that is
// pressed further is stiffer than 1, which is fine.
static double largest_hertz_stiffness(const struct dem_setup *setup, double mean_radius,
                                      double largest_radius)
{
    double modulus = 0;
    for (int k = 0; k <= setup->n_other; k++) {
        const struct dem_material *m = material(setup, k);
        modulus =
            fmax(modulus, m->young_modulus / (1 - m->poisson_ratio * m->poisson_ratio));
    }
    const double share = setup->largest_overlap > 0 ? setup->largest_overlap : 0.01;
    return 2 * modulus * sqrt(share * mean_radius * largest_radius);
}

// Without grains (walls alone) all units are 1.
static struct units choose_units(const struct dem_setup *setup)
{
    const int n = setup->packing->n_particle;
    double radius = 0, largest_radius = 0, mass = 0, heaviest = 0;
    for (int i = 0; i < n; i++) {
        radius += setup->packing->radius[i];
        largest_radius = fmax(largest_radius, setup->packing->radius[i]);
        mass += grain_mass(setup, i);
        heaviest = fmax(heaviest, grain_mass(setup, i));
    }
    struct units unit = {.length = n > 0 ? radius / n : 1,
                         .mass = n > 0 ? mass / n : 1};
    if (n == 0)
        unit.stiffness = 1;
    else if (setup->law == DEM_HERTZ)
        unit.stiffness = largest_hertz_stiffness(setup, unit.length, largest_radius);
    else if (setup->law == DEM_TIMED)
        unit.stiffness = largest_timed_stiffness(setup, heaviest);
    else
        unit.stiffness = largest_linear_stiffness(setup);
    unit.time = sqrt(unit.mass / unit.stiffness);
    return unit;
}

// Stiffnesses over `stiffness`, moduli over stiffness / length, densities over mass /
// length^3. Tables of pairs that were not given are filled with the smaller value [K
// 4.25].
static void take_materials(struct dem *dem, const struct dem_setup *setup)
{
    const int n = dem->n_material = 1 + setup->n_other;
    const double stiffness = dem->unit.stiffness, length = dem->unit.length;
    dem->material = NEW_ARRAY(struct material, n);
    dem->pair_friction = NEW_ARRAY(double, n *n);
    dem->pair_restitution = NEW_ARRAY(double, n *n);
    dem->pair_rolling_friction = NEW_ARRAY(double, n *n);
    for (int k = 0; k < n; k++) {
        const struct dem_material *m = material(setup, k);
        dem->material[k] = (struct material){
            .density = m->density / dem->unit.mass * length * length * length,
            .normal_stiffness = m->normal_stiffness / stiffness,
            .shear_stiffness = m->shear_stiffness / stiffness,
            .damping_ratio = m->damping_ratio,
            .young_modulus = m->young_modulus / stiffness * length,
            .poisson_ratio = m->poisson_ratio,
            .rolling_damping = m->rolling_damping};
        for (int l = 0; l < n; l++) {
            const struct dem_material *other = material(setup, l);
            dem->pair_friction[n * k + l] = setup->pair_friction
                                                ? setup->pair_friction[n * k + l]
                                                : fmin(m->friction, other->friction);
            dem->pair_restitution[n * k + l] =
                setup->pair_restitution ? setup->pair_restitution[n * k + l]
                                        : fmin(m->restitution, other->restitution);
            dem->pair_rolling_friction[n * k + l] =
                setup->pair_rolling_friction
                    ? setup->pair_rolling_friction[n * k + l]
                    : fmin(m->rolling_friction, other->rolling_friction);
        }
    }
    dem->contact_time = setup->material.contact_time / dem->unit.time;
    dem->local_damping = setup->material.local_damping;
    dem->no_tensile_damping = setup->no_tensile_damping;
    const double area = length * length;
    dem->bond_kind = setup->bond.kind;
    dem->moment_contribution = 1 - setup->bond.moments_left_out;
    dem->bond_normal_stiffness = setup->bond.normal_stiffness * area / stiffness;
    dem->bond_shear_stiffness = setup->bond.shear_stiffness * area / stiffness;
}

// One place more: the dummy grain, which unused lanes pair with itself.
static void new_grains(struct dem *dem, int n)
{
    const size_t n_with_dummy = (size_t)n + 1;
    dem->n_particle = n;
    dem->id = NEW_ARRAY(int32_t, n);
    dem->index = NEW_ARRAY(int32_t, n);
    dem->start = NEW_ARRAY(struct vector, n);
    dem->place = allocate_aligned(n_with_dummy, sizeof *dem->place);
    dem->external = allocate_aligned((size_t)n, sizeof *dem->external);
    dem->mobility = allocate((size_t)n, sizeof *dem->mobility);
    dem->mass = NEW_ARRAY(double, n);
    dem->weight = NEW_ARRAY(double, n);
    dem->material_of = NEW_ARRAY(uint8_t, n);
    dem->wall_offset = NEW_ARRAY(int, n + 1);
    dem->pair_offset = NEW_ARRAY(int, n + 1);
    dem->is_shared = NEW_ARRAY(uint8_t, n);
    dem->shared_grain = NEW_ARRAY(int32_t, n);
    dem->first_row = NEW_ARRAY(int32_t, n + 1);
    dem->first_group = NEW_ARRAY(int, n);
    dem->last_group = NEW_ARRAY(int, n);
    dem->place_at_search = NEW_ARRAY(struct vector, n);
    dem->half_skin = NEW_ARRAY(double, n);
    if (dem->balance_energy)
        dem->grain_ledger = allocate((size_t)n, sizeof *dem->grain_ledger);
}

// Room for velocities and spins. Where grains turn, both of a grain lie in one line of
// the cache, as every pair reads both. Else sweeps never touch the spins (those of
// driven grains, for who asks), and velocities lie close together: half the memory
// traffic.
static void place_motions(struct dem *dem)
{
    const size_t n_with_dummy = (size_t)dem->n_particle + 1;
    const bool turns = dem->features & FEATURE_ROTATION;
    dem->velocity = allocate_aligned(8 * n_with_dummy, sizeof *dem->velocity);
    dem->spin = dem->velocity + (turns ? 4 : 4 * n_with_dummy);
    dem->motion_stride = turns ? 8 : 4;
}

// 16 roundings of the farthest coordinate: grains that a text file has touching may be
// that far apart or in each other.
static void take_box(struct dem *dem, const struct packing *packing)
{
    double largest_distance = 1;
    for (int i = 0; i < dem->n_particle; i++)
        for (int axis = 0; axis < 3; axis++)
            largest_distance =
                fmax(largest_distance, fabs(component(dem->start[i], axis)));
    dem->coordinate_error = 16 * 0x1p-53 * largest_distance;
    for (int axis = 0; axis < 3; axis++) {
        dem->box_lower[axis] = component(packing->lower, axis) / dem->unit.length;
        dem->box_upper[axis] = component(packing->upper, axis) / dem->unit.length;
        if (packing->periodic[axis])
            dem->period[axis] = dem->box_upper[axis] - dem->box_lower[axis];
    }
}

// Driven grains get the mobility of fixed ones: forces do not move them.
static void take_grains(struct dem *dem, const struct dem_setup *setup)
{
    const struct packing *packing = setup->packing;
    const double length = dem->unit.length;
    new_grains(dem, packing->n_particle);
    for (int i = 0; i < dem->n_particle; i++) {
        const struct vector x = packing->position[i];
        dem->id[i] = dem->index[i] = i;
        dem->start[i] = (struct vector){x.x / length, x.y / length, x.z / length};
        dem->place[i].radius = packing->radius[i] / length;
        if (setup->material_of) dem->material_of[i] = setup->material_of[i];
    }
    const double unit = length / (dem->unit.time * dem->unit.time);
    dem->gravity = (struct vector){setup->gravity.x / unit, setup->gravity.y / unit,
                                   setup->gravity.z / unit};
    dem->density_scaling = setup->density_scaling;
    static const uint8_t none[1];
    uint8_t *fixed = NEW_ARRAY(uint8_t, dem->n_particle);
    if (setup->fixed) memcpy(fixed, setup->fixed, (size_t)dem->n_particle);
    take_groups(dem, setup);
    for (int i = 0; i < dem->n_particle; i++)
        fixed[i] = fixed[i] || is_driven(dem, i);
    set_masses(dem, dem->n_particle > 0 ? fixed : none);
    free(fixed);
    set_external(dem);
    take_box(dem, packing);
}

// Strengths of parallel bonds are stresses, of contact bonds forces. Grains in rising
// order, as pairs have them.
static void take_bonds(struct dem *dem, const struct dem_setup *setup)
{
    const int n = dem->n_bond = setup->packing->n_bond;
    const bool parallel = setup->bond.kind == DEM_PARALLEL_BOND;
    const double unit = parallel ? dem->unit.stiffness / dem->unit.length
                                 : dem->unit.stiffness * dem->unit.length;
    dem->bond_particle = allocate((size_t)n, sizeof *dem->bond_particle);
    dem->bond_radius = NEW_ARRAY(double, n);
    dem->bond_strength[DEM_CRACK_NORMAL] = NEW_ARRAY(double, n);
    dem->bond_strength[DEM_CRACK_SHEAR] = NEW_ARRAY(double, n);
    for (int b = 0; b < n; b++) {
        const int32_t *end = setup->packing->bond[b];
        dem->bond_particle[b][0] = end[0] < end[1] ? end[0] : end[1];
        dem->bond_particle[b][1] = end[0] < end[1] ? end[1] : end[0];
        dem->bond_radius[b] = parallel ? bond_radius(setup, b) / dem->unit.length : 0;
        const double normal = setup->normal_strength ? setup->normal_strength[b]
                                                     : setup->bond.normal_strength;
        const double shear = setup->shear_strength ? setup->shear_strength[b]
                                                   : setup->bond.shear_strength;
        dem->bond_strength[DEM_CRACK_NORMAL][b] = normal / unit;
        dem->bond_strength[DEM_CRACK_SHEAR][b] = shear / unit;
    }
}

static struct vector scaled(struct vector a, double unit)
{
    return (struct vector){a.x / unit, a.y / unit, a.z / unit};
}

// The normal gets length 1; of spheres and blocks it means nothing and stays.
static void take_walls(struct dem *dem, const struct dem_setup *setup)
{
    const double length = dem->unit.length, time = dem->unit.time;
    dem->n_wall = setup->n_wall;
    dem->wall = NEW_ARRAY(struct rigid_wall, setup->n_wall);
    for (int w = 0; w < setup->n_wall; w++) {
        struct dem_wall wall = setup->wall[w];
        wall.point = scaled(wall.point, length);
        if (has_direction(wall.shape))
            wall.normal = scale(1 / norm(wall.normal), wall.normal);
        wall.radius /= length;
        wall.inner_radius /= length;
        wall.half_edge = scaled(wall.half_edge, length);
        wall.velocity = scaled(wall.velocity, length / time);
        wall.spin = scaled(wall.spin, 1 / time);
        wall.servo_force /= dem->unit.stiffness * length;
        wall.servo_largest_speed /= length / time;
        dem->wall[w].is = wall;
    }
}

// Friction of walls alone makes grains turn.
static bool walls_grip(const struct dem_setup *setup)
{
    bool grip = false;
    for (int w = 0; w < setup->n_wall; w++)
        grip = grip || (setup->wall[w].has_friction && setup->wall[w].friction > 0);
    return grip;
}

// Whether every pair has the same numbers and every grain the same radius.
static bool pairs_are_alike(const struct dem *dem)
{
    bool alike = dem->n_material == 1;
    for (int i = 1; i < dem->n_particle && alike; i++)
        alike = dem->mass[i] == dem->mass[0] &&
                dem->place[i].radius == dem->place[0].radius;
    return alike;
}

// The fewest that are enough: each one costs time in every pair of every cycle.
static unsigned choose_features(const struct dem *dem, const struct dem_setup *setup)
{
    bool grip = dem->n_bond > 0 || walls_grip(setup), rolls = false;
    for (int k = 0; k < dem->n_material * dem->n_material; k++) {
        grip = grip || dem->pair_friction[k] > 0;
        rolls = rolls || dem->pair_rolling_friction[k] > 0;
    }
    unsigned features = 0;
    if (rolls) features |= FEATURE_ROTATION | FEATURE_ROLLING;
    if (grip) features |= FEATURE_ROTATION;
    if (dem->kind == DEM_HERTZ) features |= FEATURE_HERTZ;
    if (!pairs_are_alike(dem)) features |= FEATURE_PAIR_LAWS;
    if (dem->n_bond > 0)
        features |= dem->bond_kind == DEM_CONTACT_BOND ? FEATURE_CONTACT_BOND
                                                       : FEATURE_PARALLEL_BOND;
    return features;
}

// In scaled units the critical step of [K 4.47] is 2 sqrt(m) for the lightest grain at
// the largest stiffness, 1.
static void choose_time_step(struct dem *dem, const struct dem_setup *setup)
{
    double lightest = INFINITY;
    for (int i = 0; i < dem->n_particle; i++)
        lightest = fmin(lightest, dem->mass[i]);
    if (dem->n_particle == 0) lightest = 1;
    dem->critical_step = 2 * sqrt(fmin(lightest, 1));
    dem->safety_key = setup->safety_key;
    dem->automatic_share =
        setup->automatic_share > 0 ? setup->automatic_share : AUTOMATIC_SHARE;
    dem->step_is_automatic = !(setup->time_step > 0) && isnan(setup->time_step_safety);
    dem->time_step = dem->step_is_automatic ? automatic_time_step(dem)
                     : setup->time_step > 0
                         ? setup->time_step / dem->unit.time
                         : setup->time_step_safety * dem->critical_step;
}

// Each pair must be near in one image only. Twice the longest distance at which two
// grains are a pair: otherwise the list would need the image of each.
enum status check_periods(const struct dem *dem, const double stretch[3],
                          struct reason *reason)
{
    const double least =
        2 * (2 * dem->largest_radius + FIRST_SKIN + bridge_cutoff(dem));
    for (int axis = 0; axis < 3; axis++) {
        const double period = dem->period[axis] * stretch[axis];
        if (dem->period[axis] != 0 && !(period >= least))
            return refuse(reason, STATUS_BAD_DATA,
                          "periodic box is %g m along %c, needs at least %g m",
                          period * dem->unit.length, "xyz"[axis],
                          least * dem -> unit.length);
    }
    return STATUS_OK;
}

static enum status check_pairs(const struct dem *dem, struct reason *reason)
{
    int n_bonded = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int32_t *end = dem->pairs.particle[p];
        const double distance =
            dem->pairs.group[p / PAIRS_IN_GROUP].distance[p % PAIRS_IN_GROUP];
        if (distance <= 1e-9 * (dem->place[end[0]].radius + dem->place[end[1]].radius))
            return refuse(reason, STATUS_BAD_DATA, "grains %d and %d coincide",
                          dem->id[end[0]], dem->id[end[1]]);
        n_bonded += bond_of_pair(dem, p) >= 0;
    }
    if (n_bonded != dem->n_bond)
        return refuse(reason, STATUS_BAD_DATA, "%d bonds join only %d pairs of grains",
                      dem->n_bond, n_bonded);
    return STATUS_OK;
}

// Takes the overlaps of the start as reference gaps: they do not push from now on.
// Grains apart keep their distance.
static void set_reference_gaps(struct dem *dem)
{
    for (int k = 0; k < dem->pairs.n_group; k++)
        for (int lane = 0; lane < PAIRS_IN_GROUP; lane++) {
            double *overlap = &dem->pairs.group[k].overlap[lane];
            dem->unstressed |= *overlap > 0;
            *overlap = fmin(*overlap, 0);
        }
    for (int k = 0; k < dem->n_wall_pair; k++) {
        double *depth = &dem->wall_pair[k].depth;
        dem->unstressed |= *depth > 0;
        *depth = fmin(*depth, 0);
    }
}

// A step of 0 or NAN comes from densities or stiffnesses that overflow.
static enum status check_time_step(const struct dem *dem, const struct dem_setup *setup,
                                   struct reason *reason)
{
    const double step = dem_time_step(dem), limit = dem_time_step_limit(dem);
    if (!(step > 0 && limit > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "density and stiffness must give a time step above 0, got %g s",
                      step);
    if (step <= limit) return STATUS_OK;
    if (setup->time_step > 0)
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "time step %g s is past the stability limit of %g s", step,
                      limit);
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "time step %g s is past the stability limit of %g s: time_step_safety "
        "must be below %.3g, got %g",
        step, limit, setup->time_step_safety * limit / step, setup->time_step_safety);
}

// The bytes are the same; only speed depends on the processor.
static pair_sweep *choose_sweep(unsigned features)
{
    return has_avx512() ? pair_sweeps_avx512[features] : pair_sweeps_avx2[features];
}

// On failure dem_free frees what there is: all pointers begin as NULL.
static enum status build(struct dem *dem, const struct dem_setup *setup,
                         struct reason *reason)
{
    dem->unit = choose_units(setup);
    dem->kind = setup->law;
    dem->threads = setup->threads;
    dem->balance_energy = setup->balance_energy;
    dem->friction_feels_dashpot = setup->friction_feels_dashpot;
    dem->skin = FIRST_SKIN;
    dem->min_inactive_gap = 1e-6;
    dem->expected_overlap = setup->largest_overlap > 0 ? setup->largest_overlap : 0.01;
    take_materials(dem, setup);
    take_grains(dem, setup);
    take_bonds(dem, setup);
    take_shrinkage(dem, setup);
    take_walls(dem, setup);
    dem->features = choose_features(dem, setup);
    dem->springs_differ = dem->kind != DEM_LINEAR || dem->n_material > 1;
    place_motions(dem);
    start_groups(dem);
    dem->sweep = choose_sweep(dem->features);
    dem->gaps = has_avx512() ? pair_gaps_avx512 : pair_gaps_avx2;
    enum status status =
        setup->liquid ? take_liquid(dem, setup->liquid, reason) : STATUS_OK;
    if (setup->adhesion > 0) take_adhesion(dem, setup->adhesion / dem->unit.stiffness);
    const double one[3] = {1, 1, 1};
    if (status == STATUS_OK) status = check_periods(dem, one, reason);
    if (status != STATUS_OK) return status;
    renumber_grains(dem);
    find_pairs(dem);
    status = check_pairs(dem, reason);
    if (status != STATUS_OK) return status;
    if (setup->unstressed) set_reference_gaps(dem);
    if (dem->liquid) form_bridges(dem);
    dem->time_step_limit = stability_limit(dem, false);
    choose_time_step(dem, setup);
    if (setup->force_time_step) return STATUS_OK;
    return check_time_step(dem, setup, reason);
}

enum status dem_create(struct dem **result, const struct dem_setup *setup,
                       struct reason *reason)
{
    *result = NULL;
    enum status status = check_setup(setup, reason);
    if (status != STATUS_OK) return status;
    if (!(choose_units(setup).stiffness > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "neither grains nor bonds have a stiffness");

    struct dem *dem = NEW_ARRAY(struct dem, 1);
    status = build(dem, setup, reason);
    if (status != STATUS_OK) {
        dem_free(dem);
        return status;
    }
    *result = dem;
    return STATUS_OK;
}
