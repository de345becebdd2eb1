// SPDX-License-Identifier: GPL-3.0-or-later
// From a packing and materials in SI to an engine in its own units.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void *allocate_aligned(size_t count, size_t size)
{
    const size_t bytes = (count * size + CACHE_LINE) / CACHE_LINE * CACHE_LINE;
    void *memory = aligned_alloc(CACHE_LINE, bytes);
    if (!memory) die(STATUS_INTERNAL, "out of memory: %zu bytes", bytes);
    memset(memory, 0, bytes);
    return memory;
}

static bool is_finite_vector(struct vector a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

struct quantity {
    const char *name;
    double value;
    bool may_be_infinite;
};

static enum status check_numbers(const struct dem_setup *setup, struct reason *reason)
{
    const struct dem_material *m = &setup->material;
    const struct dem_bond_material *b = &setup->bond;
    const struct quantity quantity[] = {
        {"normal stiffness", m->normal_stiffness, false},
        {"shear stiffness", m->shear_stiffness, false},
        {"friction", m->friction, false},
        {"damping ratio", m->damping_ratio, false},
        {"local damping", m->local_damping, false},
        {"normal stiffness of bonds", b->normal_stiffness, false},
        {"shear stiffness of bonds", b->shear_stiffness, false},
        {"normal strength of bonds", b->normal_strength, true},
        {"shear strength of bonds", b->shear_strength, true}};
    for (size_t k = 0; k < sizeof quantity / sizeof *quantity; k++) {
        const struct quantity q = quantity[k];
        if (!(q.value >= 0) || (isinf(q.value) && !q.may_be_infinite))
            return refuse(reason, STATUS_BAD_DATA, "%s must be >= 0, got %g", q.name,
                          q.value);
    }
    if (m->local_damping >= 1)
        return refuse(reason, STATUS_BAD_DATA, "local damping must be < 1, got %g",
                      m->local_damping);
    if (!(m->density > 0) || isinf(m->density))
        return refuse(reason, STATUS_BAD_DATA, "density must be > 0 kg/m3, got %g",
                      m->density);
    if (!(setup->time_step_safety > 0) || isinf(setup->time_step_safety))
        return refuse(reason, STATUS_BAD_DATA, "time step safety must be > 0, got %g",
                      setup->time_step_safety);
    if (setup->packing->n_bond > 0 &&
        !(b->radius_fraction > 0 && b->radius_fraction <= 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "radius fraction of bonds must be in (0,1], got %g",
                      b->radius_fraction);
    if (setup->threads < 1)
        return refuse(reason, STATUS_BAD_DATA, "threads must be >= 1, got %d",
                      setup->threads);
    return STATUS_OK;
}

static enum status check_scene(const struct dem_setup *setup, struct reason *reason)
{
    const struct packing *packing = setup->packing;
    for (int i = 0; i < packing->n_particle; i++) {
        if (!is_finite_vector(packing->position[i]))
            return refuse(reason, STATUS_BAD_DATA, "grain %d: position is not finite",
                          i);
        if (!(packing->radius[i] > 0) || isinf(packing->radius[i]))
            return refuse(reason, STATUS_BAD_DATA,
                          "grain %d: radius must be > 0 m, got %g", i,
                          packing->radius[i]);
    }
    for (int b = 0; b < packing->n_bond; b++) {
        const int32_t *end = packing->bond[b];
        for (int k = 0; k < 2; k++)
            if (end[k] < 0 || end[k] >= packing->n_particle)
                return refuse(reason, STATUS_BAD_DATA, "bond %d: no grain %d among %d",
                              b, end[k], packing->n_particle);
        if (end[0] == end[1])
            return refuse(reason, STATUS_BAD_DATA, "bond %d: joins grain %d to itself",
                          b, end[0]);
    }
    for (int w = 0; w < setup->n_wall; w++)
        if (!is_finite_vector(setup->wall[w].point) ||
            !is_finite_vector(setup->wall[w].normal) ||
            !(norm(setup->wall[w].normal) > 0))
            return refuse(reason, STATUS_BAD_DATA,
                          "wall %d: needs a point and a normal that is not zero", w);
    return STATUS_OK;
}

static double grain_mass(const struct dem_setup *setup, int particle)
{
    const double radius = setup->packing->radius[particle];
    return setup->material.density * (4.0 / 3 * M_PI) * radius * radius * radius;
}

static double bond_radius(const struct dem_setup *setup, int bond)
{
    const int32_t *end = setup->packing->bond[bond];
    return setup->bond.radius_fraction *
           fmin(setup->packing->radius[end[0]], setup->packing->radius[end[1]]);
}

// The largest translational stiffness between two grains, or a grain and a wall, N/m.
static double largest_stiffness(const struct dem_setup *setup)
{
    const struct dem_material *m = &setup->material;
    const double grain = fmax(m->normal_stiffness, m->shear_stiffness);
    double largest = setup->n_wall > 0 ? grain : 0.5 * grain;
    for (int b = 0; b < setup->packing->n_bond; b++) {
        const double radius = bond_radius(setup, b), area = M_PI * radius * radius;
        const double normal =
            0.5 * m->normal_stiffness + setup->bond.normal_stiffness * area;
        const double shear =
            0.5 * m->shear_stiffness + setup->bond.shear_stiffness * area;
        largest = fmax(largest, fmax(normal, shear));
    }
    return largest;
}

static struct units choose_units(const struct dem_setup *setup)
{
    const int n = setup->packing->n_particle;
    struct units unit = {.length = 1, .mass = 1, .stiffness = largest_stiffness(setup)};
    if (n > 0) {
        double radius = 0, mass = 0;
        for (int i = 0; i < n; i++) {
            radius += setup->packing->radius[i];
            mass += grain_mass(setup, i);
        }
        unit.length = radius / n;
        unit.mass = mass / n;
    }
    unit.time = sqrt(unit.mass / unit.stiffness);
    return unit;
}

// A contact whose stiffness is SERIES of a grain's: a half between two [K 4.22], all of
// it against a rigid wall.
static struct contact_law contact_law(const struct dem_setup *setup,
                                      const struct units *unit, double series)
{
    const struct dem_material *m = &setup->material;
    struct contact_law law = {
        .normal_stiffness = series * m->normal_stiffness / unit->stiffness,
        .shear_stiffness = series * m->shear_stiffness / unit->stiffness,
        .friction = m->friction};
    law.normal_damping = 2 * m->damping_ratio * sqrt(law.normal_stiffness);
    law.shear_damping = 2 * m->damping_ratio * sqrt(law.shear_stiffness);
    const double area = unit->length * unit->length;
    law.bond_normal_stiffness = setup->bond.normal_stiffness * area / unit->stiffness;
    law.bond_shear_stiffness = setup->bond.shear_stiffness * area / unit->stiffness;
    return law;
}

static void take_grains(struct dem *dem, const struct dem_setup *setup)
{
    const struct packing *packing = setup->packing;
    const int n = dem->n_particle = packing->n_particle;
    const size_t with_nobody = (size_t)n + 1;
    dem->start = NEW_ARRAY(struct vector, n);
    dem->place = allocate_aligned(with_nobody, sizeof *dem->place);
    dem->motion = allocate_aligned(with_nobody, sizeof *dem->motion);
    dem->external = allocate_aligned((size_t)n, sizeof *dem->external);
    dem->mobility = allocate((size_t)n, sizeof *dem->mobility);
    dem->mass = NEW_ARRAY(double, n);
    dem->slot_offset = NEW_ARRAY(int, n + 1);
    dem->first_group = NEW_ARRAY(int, n);
    dem->last_group = NEW_ARRAY(int, n);
    dem->place_at_search = NEW_ARRAY(struct vector, n);
    double furthest = 1;
    for (int i = 0; i < n; i++) {
        const struct vector x = packing->position[i];
        const double length = dem->unit.length, radius = packing->radius[i] / length;
        dem->start[i] = (struct vector){x.x / length, x.y / length, x.z / length};
        dem->place[i].radius = radius;
        dem->mass[i] = grain_mass(setup, i) / dem->unit.mass;
        dem->largest_radius = fmax(dem->largest_radius, radius);
        for (int axis = 0; axis < 3; axis++)
            furthest = fmax(furthest, fabs(component(dem->start[i], axis)));
        if (setup->fixed && setup->fixed[i]) continue;
        dem->mobility[i][0] = 1 / dem->mass[i];
        dem->mobility[i][1] = 1 / (0.4 * dem->mass[i] * radius * radius);
    }
    dem->coordinate_error = 16 * 0x1p-53 * furthest;
    for (int axis = 0; axis < 3; axis++) {
        dem->box_lower[axis] = component(packing->lower, axis) / dem->unit.length;
        if (packing->periodic[axis])
            dem->period[axis] = component(packing->upper, axis) / dem->unit.length -
                                dem->box_lower[axis];
    }
}

static void take_bonds(struct dem *dem, const struct dem_setup *setup)
{
    const int n = dem->n_bond = setup->packing->n_bond;
    const double stress = dem->unit.stiffness / dem->unit.length;
    dem->bond_particle = allocate((size_t)n, sizeof *dem->bond_particle);
    dem->bond_radius = NEW_ARRAY(double, n);
    dem->bond_strength[DEM_CRACK_NORMAL] = NEW_ARRAY(double, n);
    dem->bond_strength[DEM_CRACK_SHEAR] = NEW_ARRAY(double, n);
    for (int b = 0; b < n; b++) {
        const int32_t *end = setup->packing->bond[b];
        dem->bond_particle[b][0] = end[0] < end[1] ? end[0] : end[1];
        dem->bond_particle[b][1] = end[0] < end[1] ? end[1] : end[0];
        dem->bond_radius[b] = bond_radius(setup, b) / dem->unit.length;
        dem->bond_strength[DEM_CRACK_NORMAL][b] = setup->bond.normal_strength / stress;
        dem->bond_strength[DEM_CRACK_SHEAR][b] = setup->bond.shear_strength / stress;
    }
}

static void take_walls(struct dem *dem, const struct dem_setup *setup)
{
    dem->n_wall = setup->n_wall;
    dem->wall = NEW_ARRAY(struct dem_wall, setup->n_wall);
    for (int w = 0; w < setup->n_wall; w++) {
        const struct dem_wall *wall = &setup->wall[w];
        const double length = dem->unit.length;
        dem->wall[w] =
            (struct dem_wall){.point = {wall->point.x / length, wall->point.y / length,
                                        wall->point.z / length},
                              .normal = scale(1 / norm(wall->normal), wall->normal)};
    }
}

static void choose_time_step(struct dem *dem, double safety)
{
    double lightest = 1;
    for (int i = 0; i < dem->n_particle; i++)
        lightest = fmin(lightest, dem->mass[i]);
    dem->time_step = safety * 2 * sqrt(lightest); // [K 4.47]; the stiffness is 1
}

// Each pair must meet in one image only.
static enum status check_periods(const struct dem *dem, struct reason *reason)
{
    const double least = 2 * (2 * dem->largest_radius + SEARCH_SKIN);
    for (int axis = 0; axis < 3; axis++)
        if (dem->period[axis] != 0 && !(dem->period[axis] >= least))
            return refuse(reason, STATUS_BAD_DATA,
                          "periodic box is %g m along %c, needs at least %g m",
                          dem->period[axis] * dem->unit.length, "xyz"[axis],
                          least * dem -> unit.length);
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
            return refuse(reason, STATUS_BAD_DATA, "grains %d and %d coincide", end[0],
                          end[1]);
        n_bonded += dem->pairs.bond[p] >= 0;
    }
    if (n_bonded != dem->n_bond)
        return refuse(reason, STATUS_BAD_DATA, "%d bonds join only %d pairs of grains",
                      dem->n_bond, n_bonded);
    return STATUS_OK;
}

static enum status check_time_step(const struct dem *dem, double safety,
                                   struct reason *reason)
{
    if (dem->time_step <= dem->time_step_limit) return STATUS_OK;
    return refuse(
        reason, STATUS_NOT_CONVERGED,
        "time step %g s is past the stability limit of %g s: time_step_safety "
        "must be below %.3g, got %g",
        dem_time_step(dem), dem_time_step_limit(dem),
        safety * dem->time_step_limit / dem->time_step, safety);
}

static pair_sweep *choose_sweep(void)
{
    const bool wide = __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
    return wide ? pair_sweep_wide : pair_sweep_narrow;
}

static enum status build(struct dem *dem, const struct dem_setup *setup,
                         struct reason *reason)
{
    dem->unit = choose_units(setup);
    dem->law = contact_law(setup, &dem->unit, 0.5);
    dem->wall_law = contact_law(setup, &dem->unit, 1);
    dem->local_damping = setup->material.local_damping;
    dem->threads = setup->threads;
    dem->sweep = choose_sweep();
    take_grains(dem, setup);
    take_bonds(dem, setup);
    take_walls(dem, setup);
    choose_time_step(dem, setup->time_step_safety);
    enum status status = check_periods(dem, reason);
    if (status != STATUS_OK) return status;
    find_pairs(dem);
    status = check_pairs(dem, reason);
    if (status != STATUS_OK) return status;
    // Against the motion, local damping makes springs and dashpots stronger by its
    // share: springs would allow its square root, dashpots do not.
    dem->time_step_limit = stability_limit(dem) / (1 + dem->local_damping);
    if (setup->force_time_step) return STATUS_OK;
    return check_time_step(dem, setup->time_step_safety, reason);
}

enum status dem_create(struct dem **result, const struct dem_setup *setup,
                       struct reason *reason)
{
    *result = NULL;
    enum status status = check_numbers(setup, reason);
    if (status != STATUS_OK) return status;
    status = check_scene(setup, reason);
    if (status != STATUS_OK) return status;
    if (!(largest_stiffness(setup) > 0))
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
