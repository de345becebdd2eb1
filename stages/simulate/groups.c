// SPDX-License-Identifier: GPL-3.0-or-later
// Who belongs to a group: for grain i with centre x,
//
//     in_box:    lower <= x <= upper, component by component
//     in_ring:   along = (x - centre) . axis / |axis|,
//                inner <= sqrt(|x - centre|^2 - along^2) < outer
//     listed:    i is in the group's list
//
// A grain is a member when it is listed, or lies in both box and ring. A group that
// only lists grains has no others: its box and ring have no bounds, and would hold
// every grain.
//
// The trap: bounds that are not given are NAN, and each comparison is written so that
// NAN excludes no grain. `at >= lower` in place of `!(at < lower)` would empty the
// group.
#include "groups.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool in_box(const struct group_parameters *group, struct vector x)
{
    for (int axis = 0; axis < 3; axis++) {
        const double at = component(x, axis);
        // NAN, not given, bounds nothing.
        if (at < group->lower[axis] || at > group->upper[axis]) return false;
    }
    return true;
}

// Rounding can leave a small negative square for a grain on the axis. Half open, inner
// to outer, so that nested rings share no grain.
static bool in_ring(const struct group_parameters *group, struct vector x)
{
    const struct vector axis = as_vector(group->ring_axis);
    const struct vector from = subtract(x, as_vector(group->ring_centre));
    const double along = dot(from, axis) / norm(axis);
    const double distance = sqrt(fmax(dot(from, from) - along * along, 0));
    return distance >= group->ring_inner && !(distance >= group->ring_outer);
}

static bool is_by_place(const struct group_parameters *group)
{
    return !isnan(group->lower[0]) || !isnan(group->upper[0]) ||
           group->ring_inner > 0 || !isnan(group->ring_outer);
}

// Two groups that want one grain would each set its material and motion; which of them
// wins would depend on their names. So that is refused, not resolved.
static enum status claim(const struct simulate_parameters *parameters, int group,
                         int grain, struct scene *scene, struct reason *reason)
{
    const int before = scene->group_of[grain] - 1;
    if (before >= 0 && before != group)
        return refuse(reason, STATUS_BAD_DATA,
                      "simulate.groups.%s: grain %d is in group %s already",
                      parameters->groups.name[group], grain,
                      parameters->groups.name[before]);
    scene->group_of[grain] = (uint8_t)(group + 1);
    return STATUS_OK;
}

// Numbers come as doubles from JSON. They are at least 0 (the parameter's bound).
static enum status claim_listed(const struct simulate_parameters *parameters, int group,
                                const struct packing *packing, struct scene *scene,
                                struct reason *reason)
{
    const struct number_list *list = &group_row(parameters, group)->grains;
    enum status status = STATUS_OK;
    for (int k = 0; k < list->count && !status; k++) {
        const double grain = list->value[k];
        if (grain != rint(grain) || grain >= packing->n_particle)
            return refuse(reason, STATUS_BAD_DATA,
                          "simulate.groups.%s.grains: there is no grain %g among %d",
                          parameters->groups.name[group], grain, packing->n_particle);
        status = claim(parameters, group, (int)grain, scene, reason);
    }
    return status;
}

static enum status find_members(const struct simulate_parameters *parameters, int group,
                                const struct packing *packing, struct scene *scene,
                                struct reason *reason)
{
    const struct group_parameters *row = group_row(parameters, group);
    const char *name = parameters->groups.name[group];
    const struct vector axis = as_vector(row->ring_axis);
    if (!(norm(axis) > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "simulate.groups.%s.ring.axis: must not be 0", name);
    enum status status = claim_listed(parameters, group, packing, scene, reason);
    const bool by_place = row->grains.count == 0 || is_by_place(row);
    for (int i = 0; i < packing->n_particle && by_place && !status; i++)
        if (in_box(row, packing->position[i]) && in_ring(row, packing->position[i]))
            status = claim(parameters, group, i, scene, reason);
    if (status) return status;
    if (packing->n_particle > 0 &&
        !memchr(scene->group_of, group + 1, (size_t)packing->n_particle))
        return refuse(reason, STATUS_BAD_DATA,
                      "simulate.groups.%s: no grain has its centre there", name);
    return STATUS_OK;
}

// A velocity that nothing would use is a slip: of free grains or of driven ones.
static enum status check_motion(const struct group_parameters *row, const char *name,
                                struct reason *reason)
{
    const bool moves = norm(as_vector(row->velocity)) > 0 ||
                       norm(as_vector(row->spin)) > 0 || row->motion.times.count > 0;
    const bool begins =
        !isnan(row->initial_velocity[0]) || norm(as_vector(row->initial_spin)) > 0;
    if (!row->driven && moves)
        return refuse(
            reason, STATUS_BAD_DATA,
            "simulate.groups.%s: velocity, spin and motion are for driven=true; "
            "free grains begin with initial.velocity and initial.spin",
            name);
    if (row->driven && begins)
        return refuse(reason, STATUS_BAD_DATA,
                      "simulate.groups.%s.initial: must be null or 0 with driven=true, "
                      "where velocity and spin move the grains",
                      name);
    return STATUS_OK;
}

// The spin is a vector to the user and an axis with a signed rate to the engine, so
// that a table of time scales one number. Axis and rate of a group that does not turn
// are 0.
static void add_driven(const struct group_parameters *row, int group,
                       struct scene *scene)
{
    scene->driven_group[group] = row->driven ? scene->n_driven : -1;
    if (!row->driven) return;
    const struct vector spin = as_vector(row->spin);
    scene->driven[scene->n_driven++] =
        (struct dem_group){.point = as_vector(row->point),
                           .axis = spin,
                           .velocity = as_vector(row->velocity),
                           .spin = norm(spin)};
}

// Spins are not in a packing, so grains without a group begin without.
static void set_start(const struct simulate_parameters *parameters,
                      const struct packing *packing, const struct vector *velocity,
                      struct scene *scene)
{
    const int n = packing->n_particle;
    scene->velocity = NEW_ARRAY(struct vector, n);
    scene->spin = NEW_ARRAY(struct vector, n);
    scene->driven_of = NEW_ARRAY(uint8_t, n);
    for (int i = 0; i < n; i++) {
        if (velocity) scene->velocity[i] = velocity[i];
        const int group = scene->group_of[i] - 1;
        if (group < 0) continue;
        const struct group_parameters *row = group_row(parameters, group);
        if (!isnan(row->initial_velocity[0]))
            scene->velocity[i] = as_vector(row->initial_velocity);
        scene->spin[i] = as_vector(row->initial_spin);
        scene->driven_of[i] = (uint8_t)(scene->driven_group[group] + 1);
    }
}

// Group numbers are bytes, and 0 is no group.
enum status read_groups(const struct simulate_parameters *parameters,
                        const struct packing *packing, const struct vector *velocity,
                        struct scene *scene, struct reason *reason)
{
    const int n = scene->n_group = parameters->groups.count;
    if (n > 254)
        return refuse(reason, STATUS_BAD_DATA, "simulate.groups: at most 254, got %d",
                      n);
    scene->group_of = NEW_ARRAY(uint8_t, packing->n_particle);
    scene->driven_group = NEW_ARRAY(int, n);
    scene->driven = NEW_ARRAY(struct dem_group, n);
    enum status status = STATUS_OK;
    for (int k = 0; k < n && !status; k++) {
        const struct group_parameters *row = group_row(parameters, k);
        status = check_motion(row, parameters->groups.name[k], reason);
        if (!status) status = find_members(parameters, k, packing, scene, reason);
        add_driven(row, k, scene);
    }
    if (!status) set_start(parameters, packing, velocity, scene);
    return status;
}
