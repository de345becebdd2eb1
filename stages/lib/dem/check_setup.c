// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses an impossible setup: one line that names what is wrong, the row, the rule and
// the value. Everything is checked as given, in SI, before it is scaled. Comparisons
// are written so that NAN fails them.
//
// What is refused is what no later check could explain: a negative mass would first
// show as a time step that is not a number. What is only unwise (a step near the limit)
// is for others to judge.
#include "dem/engine.h"

#include <math.h>
#include <stdio.h>

static bool is_finite_vector(struct vector a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

// A number in [LOW, HIGH]; an infinite HIGH itself is not in it unless OR_INFINITE.
// Infinite strengths are fine, infinite stiffnesses are not.
struct quantity {
    const char *name;
    double value, low, high;
    bool above; // > LOW, not >=
    bool or_infinite;
};

// Messages in the words of intervals: "must be in (0,1], got 1.2".
static enum status check_quantity(const struct quantity *q, struct reason *reason)
{
    const bool low = q->above ? q->value > q->low : q->value >= q->low;
    const bool high = q->value <= q->high && (!isinf(q->value) || q->or_infinite);
    if (low && high) return STATUS_OK;
    if (isinf(q->high))
        return refuse(reason, STATUS_BAD_DATA, "%s must be %s %g, got %g", q->name,
                      q->above ? ">" : ">=", q->low, q->value);
    return refuse(reason, STATUS_BAD_DATA, "%s must be in %c%g,%g], got %g", q->name,
                  q->above ? '(' : '[', q->low, q->high, q->value);
}

static enum status check_quantities(const struct quantity *q, size_t count,
                                    struct reason *reason)
{
    enum status status = STATUS_OK;
    for (size_t k = 0; k < count && status == STATUS_OK; k++)
        status = check_quantity(&q[k], reason);
    return status;
}
#define CHECK(list, reason)                                                            \
    check_quantities(list, sizeof(list) / sizeof *(list), reason)

// Only the members that the law uses are looked at; the others may be anything. Local
// damping is below 1, by the last double before it: at 1 no force would be left.
static enum status check_material(const struct dem_material *m, enum dem_law law,
                                  struct reason *reason)
{
    const double no_limit = INFINITY;
    const struct quantity common[] = {
        {"density", m->density, 0, no_limit, true, false},
        {"friction", m->friction, 0, no_limit, false, false},
        {"local damping", m->local_damping, 0, 0x1.fffffffffffffp-1, false, false},
        {"rolling friction", m->rolling_friction, 0, no_limit, false, false},
        {"rolling damping", m->rolling_damping, 0, no_limit, false, false}};
    const struct quantity linear[] = {
        {"normal stiffness", m->normal_stiffness, 0, no_limit, false, false},
        {"shear stiffness", m->shear_stiffness, 0, no_limit, false, false},
        {"damping ratio", m->damping_ratio, 0, no_limit, false, false}};
    const struct quantity timed[] = {
        {"contact time", m->contact_time, 0, no_limit, true, false},
        {"restitution", m->restitution, 0, 1, true, false}};
    const struct quantity hertz[] = {
        {"Young's modulus", m->young_modulus, 0, no_limit, true, false},
        {"Poisson's ratio", m->poisson_ratio, 0, 0.5, false, false},
        {"restitution", m->restitution, 0, 1, true, false}};
    const enum status status = CHECK(common, reason);
    if (status != STATUS_OK) return status;
    return law == DEM_HERTZ   ? CHECK(hertz, reason)
           : law == DEM_TIMED ? CHECK(timed, reason)
                              : CHECK(linear, reason);
}

// Tables of pairs need not be symmetric to be safe, only in range; callers keep them
// so.
static enum status check_materials(const struct dem_setup *setup, struct reason *reason)
{
    const int n = 1 + setup->n_other;
    for (int k = 0; k < n; k++) {
        const enum status status =
            check_material(material(setup, k), setup->law, reason);
        if (status != STATUS_OK) return status;
    }
    for (int k = 0; k < n * n; k++) {
        const double friction = setup->pair_friction ? setup->pair_friction[k] : 0;
        const double rebound = setup->pair_restitution ? setup->pair_restitution[k] : 1;
        if (!(friction >= 0) || isinf(friction) || !(rebound > 0 && rebound <= 1))
            return refuse(reason, STATUS_BAD_DATA,
                          "materials %d and %d: friction must be >= 0 and restitution "
                          "in (0,1], got %g and %g",
                          k / n, k % n, friction, rebound);
        const double rolling =
            setup->pair_rolling_friction ? setup->pair_rolling_friction[k] : 0;
        if (!(rolling >= 0) || isinf(rolling))
            return refuse(reason, STATUS_BAD_DATA,
                          "materials %d and %d: rolling friction must be >= 0, got %g",
                          k / n, k % n, rolling);
    }
    for (int i = 0; setup->material_of && i < setup->packing->n_particle; i++)
        if (setup->material_of[i] >= n)
            return refuse(reason, STATUS_BAD_DATA, "grain %d: no material %d among %d",
                          i, setup->material_of[i], n);
    return STATUS_OK;
}

// A parallel bond resists rolling by its own bending, and the kernels have no set of
// features with both.
static enum status check_rolling(const struct dem_setup *setup, struct reason *reason)
{
    const int n = 1 + setup->n_other;
    bool rolls = false;
    for (int k = 0; k < n; k++)
        rolls = rolls || material(setup, k)->rolling_friction > 0;
    for (int k = 0; setup->pair_rolling_friction && k < n * n; k++)
        rolls = rolls || setup->pair_rolling_friction[k] > 0;
    if (!rolls || setup->packing->n_bond == 0) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "rolling friction does not go with bonds: leave out one of them");
}

// Stiffnesses and strengths are checked even without bonds; geometry and the law's fit
// only with them.
static enum status check_bonds(const struct dem_setup *setup, struct reason *reason)
{
    const struct dem_bond_material *b = &setup->bond;
    const double no_limit = INFINITY;
    const struct quantity quantity[] = {
        {"normal stiffness of bonds", b->normal_stiffness, 0, no_limit, false, false},
        {"shear stiffness of bonds", b->shear_stiffness, 0, no_limit, false, false},
        {"normal strength of bonds", b->normal_strength, 0, no_limit, false, true},
        {"shear strength of bonds", b->shear_strength, 0, no_limit, false, true}};
    const enum status status = CHECK(quantity, reason);
    if (status != STATUS_OK || setup->packing->n_bond == 0) return status;
    if (b->kind == DEM_PARALLEL_BOND &&
        !(b->radius_fraction > 0 && b->radius_fraction <= 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "radius fraction of bonds must be in (0,1], got %g",
                      b->radius_fraction);
    if (b->kind == DEM_CONTACT_BOND && setup->law == DEM_HERTZ)
        return refuse(reason, STATUS_BAD_DATA,
                      "contact bonds pull with the contact's springs, and a Hertz "
                      "contact has none in tension [K 4.2]");
    for (int k = 0; k < setup->packing->n_bond; k++)
        if ((setup->normal_strength && !(setup->normal_strength[k] >= 0)) ||
            (setup->shear_strength && !(setup->shear_strength[k] >= 0)))
            return refuse(reason, STATUS_BAD_DATA, "bond %d: strengths must be >= 0",
                          k);
    return STATUS_OK;
}

// At a contact angle of pi the liquid wets nothing, and there is no bridge.
static enum status check_liquid(const struct dem_liquid *l, struct reason *reason)
{
    const double no_limit = INFINITY;
    const struct quantity quantity[] = {
        {"surface tension", l->surface_tension, 0, no_limit, true, false},
        {"contact angle", l->contact_angle, 0, M_PI * (1 - 1e-9), false, false},
        {"volume of bridges", l->volume, 0, no_limit, true, false}};
    if (l->model == BRIDGE_EXACT)
        return refuse(reason, STATUS_BAD_DATA,
                      "bridges.model=exact is too slow for each bridge in each cycle: "
                      "bridges.model=table interpolates the same solution");
    return CHECK(quantity, reason);
}

static enum status check_adhesion(const struct dem_setup *setup, struct reason *reason)
{
    const struct quantity work = {"adhesion", setup->adhesion, 0,
                                  INFINITY,   false,           false};
    if (setup->adhesion > 0 &&
        (setup->law != DEM_HERTZ || setup->liquid || setup->shrinks))
        return refuse(
            reason, STATUS_BAD_DATA,
            "adhesion needs Hertz contacts, of dry grains that do not shrink");
    return check_quantity(&work, reason);
}

// The safety counts only where nothing else sets the step.
static enum status check_numbers(const struct dem_setup *setup, struct reason *reason)
{
    enum status status = check_materials(setup, reason);
    if (status == STATUS_OK) status = check_bonds(setup, reason);
    if (status == STATUS_OK) status = check_rolling(setup, reason);
    if (status == STATUS_OK && setup->liquid)
        status = check_liquid(setup->liquid, reason);
    if (status == STATUS_OK) status = check_adhesion(setup, reason);
    if (status != STATUS_OK) return status;
    const double no_limit = INFINITY;
    const bool is_automatic = setup->time_step > 0 || isnan(setup->time_step_safety);
    const struct quantity step[] = {
        {"time step safety", is_automatic ? 1 : setup->time_step_safety, 0, no_limit,
         true, false},
        {"time step", setup->time_step, 0, no_limit, false, false},
        {"largest overlap", setup->largest_overlap, 0, 1, false, false},
        {"threads", setup->threads, 1, no_limit, false, false}};
    if (!is_finite_vector(setup->gravity))
        return refuse(reason, STATUS_BAD_DATA, "gravity is not finite");
    return CHECK(step, reason);
}

struct wall_label wall_label(const struct dem_wall *wall, int w)
{
    struct wall_label label;
    if (wall->name)
        snprintf(label.text, sizeof label.text, "%s", wall->name);
    else
        snprintf(label.text, sizeof label.text, "wall %d", w);
    return label;
}

// A grain meets a wall in the nearest image. Across an axis that repeats this is a
// saw of a plane, and of a cylinder aslant to it.
static enum status check_images(const struct dem_setup *setup, int w,
                                struct reason *reason)
{
    static const double nearly = 1e-9;
    const struct dem_wall *wall = &setup->wall[w];
    const bool plane = wall->shape == DEM_PLANE;
    for (int axis = 0; axis < 3; axis++) {
        if (!setup->packing->periodic[axis]) continue;
        const double along = fabs(component(wall->normal, axis)) / norm(wall->normal);
        if (plane && along > nearly)
            return refuse(
                reason, STATUS_BAD_DATA,
                "%s: the box repeats along %c: a plane must be parallel to it",
                wall_label(wall, w).text, "xyz"[axis]);
        if (wall->shape == DEM_CYLINDER && along > nearly && along < 1 - nearly)
            return refuse(
                reason, STATUS_BAD_DATA,
                "%s: the box repeats along %c: the axis of a cylinder must be "
                "along or across",
                wall_label(wall, w).text, "xyz"[axis]);
    }
    return STATUS_OK;
}

// Sizes by shape: a plane has none, a block has edges, all others a radius. A servo
// moves along the normal, so only a plane can have one.
static enum status check_wall(const struct dem_setup *setup, int w,
                              struct reason *reason)
{
    const struct dem_wall *wall = &setup->wall[w];
    const enum dem_wall_shape shape = wall->shape;
    const struct vector edge = wall->half_edge;
    const struct wall_label label = wall_label(wall, w);
    const bool round = shape != DEM_PLANE && shape != DEM_BLOCK;
    if (!is_finite_vector(wall->point) ||
        (has_direction(shape) &&
         !(is_finite_vector(wall->normal) && norm(wall->normal) > 0)))
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: needs a point and a normal that is not zero", label.text);
    if ((round && !(wall->radius > 0 && isfinite(wall->radius))) ||
        (shape == DEM_RING &&
         !(wall->inner_radius >= 0 && wall->inner_radius < wall->radius)))
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: needs a radius > 0 and an inner one below it, got %g and "
                      "%g",
                      label.text, wall->radius, wall->inner_radius);
    if (shape == DEM_BLOCK &&
        !(is_finite_vector(edge) && edge.x > 0 && edge.y > 0 && edge.z > 0))
        return refuse(reason, STATUS_BAD_DATA, "%s: needs half edges > 0", label.text);
    if (wall->material < 0 || wall->material > setup->n_other ||
        (wall->has_friction && !(wall->friction >= 0 && isfinite(wall->friction))))
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: no such material (%d) or friction (%g)", label.text,
                      wall->material, wall->friction);
    if (!is_finite_vector(wall->velocity) || !is_finite_vector(wall->spin))
        return refuse(reason, STATUS_BAD_DATA, "%s: its motion is not finite",
                      label.text);
    if (wall->servo_force != 0 &&
        !(wall->servo_force > 0 && isfinite(wall->servo_force) && shape == DEM_PLANE &&
          wall->servo_largest_speed > 0 && isfinite(wall->servo_largest_speed)))
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: a servo moves a plane, by a force and a largest speed "
                      "> 0, got %g and %g",
                      label.text, wall->servo_force, wall->servo_largest_speed);
    return check_images(setup, w, reason);
}

// A grain has one master: it is fixed, or driven, or free.
static enum status check_groups(const struct dem_setup *setup, struct reason *reason)
{
    if (!(setup->n_group >= 0 && setup->n_group <= UINT8_MAX))
        return refuse(reason, STATUS_BAD_DATA,
                      "number of driven groups must be in [0,%d], got %d", UINT8_MAX,
                      setup->n_group);
    for (int g = 0; g < setup->n_group; g++) {
        const struct dem_group *group = &setup->group[g];
        if (!is_finite_vector(group->point) || !is_finite_vector(group->axis) ||
            !is_finite_vector(group->velocity) || !isfinite(group->spin))
            return refuse(reason, STATUS_BAD_DATA,
                          "driven group %d: its point, axis or motion is not finite",
                          g);
        if (group->spin != 0 && !(norm(group->axis) > 0))
            return refuse(reason, STATUS_BAD_DATA,
                          "driven group %d: needs an axis to turn about", g);
    }
    for (int i = 0; setup->group_of && i < setup->packing->n_particle; i++) {
        if (setup->group_of[i] > setup->n_group)
            return refuse(reason, STATUS_BAD_DATA,
                          "grain %d: no driven group %d among %d", i,
                          setup->group_of[i] - 1, setup->n_group);
        if (setup->group_of[i] && setup->fixed && setup->fixed[i])
            return refuse(reason, STATUS_BAD_DATA,
                          "grain %d: is fixed and in driven group %d", i,
                          setup->group_of[i] - 1);
    }
    return STATUS_OK;
}

// That bonds are not listed twice, and that their grains do not coincide, is checked
// once pairs are known (check_pairs).
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
    for (int w = 0; w < setup->n_wall; w++) {
        const enum status status = check_wall(setup, w, reason);
        if (status != STATUS_OK) return status;
    }
    return check_groups(setup, reason);
}

enum status check_setup(const struct dem_setup *setup, struct reason *reason)
{
    const enum status status = check_numbers(setup, reason);
    return status == STATUS_OK ? check_scene(setup, reason) : status;
}
