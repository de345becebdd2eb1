// SPDX-License-Identifier: GPL-3.0-or-later
// Which parameters a choice leaves without use, as the texts of the tables say it
// ("law=hertz: ..."). parameters.h says why 0, of bridges.volume or rolling_friction,
// is no such choice.
#include "unused.h"

#include <math.h>
#include <stdio.h>

#define COUNT(rules) (sizeof(rules) / sizeof *(rules))

// WHERE: "" or "walls.floor.", for the message.
static void check(const struct parameter *table, const json_t *effective,
                  const char *where, const struct unused_keys *rules, size_t count)
{
    struct reason reason;
    if (refuse_unused(table, effective, rules, count, &reason))
        die(STATUS_BAD_DATA, "simulate.%s%s", where, reason.text);
}

// In the table KIND, "walls", the row NAME.
static void check_row(const struct parameter *table, const json_t *effective,
                      const char *kind, const char *name,
                      const struct unused_keys *rules, size_t count)
{
    char where[300];
    snprintf(where, sizeof where, "%s.%s.", kind, name);
    check(table, json_object_get(json_object_get(effective, kind), name), where, rules,
          count);
}

static void check_materials(const struct simulate_parameters *parameters,
                            const json_t *effective)
{
    const bool hertz = parameters->law == LAW_HERTZ;
    const bool linear = parameters->law == LAW_LINEAR;
    for (int k = 0; k < parameters->materials.count; k++) {
        const struct material_parameters *row =
            (const struct material_parameters *)parameters->materials.row + k;
        const struct unused_keys rules[] = {
            {!hertz, "young_modulus|poisson_ratio", "without law=hertz"},
            {!linear, "normal_stiffness|shear_stiffness|damping_ratio",
             "without law=linear"},
            {linear && !isnan(row->damping_ratio), "restitution",
             "with damping_ratio, which says how contacts rebound"}};
        check_row(simulate_materials, effective, "materials",
                  parameters->materials.name[k], rules, COUNT(rules));
    }
    const struct unused_keys of_pairs[] = {
        {linear, "restitution", "with law=linear: each material has its own"}};
    for (int k = 0; k < parameters->pairs.count; k++)
        check_row(simulate_pairs, effective, "pairs", parameters->pairs.name[k],
                  of_pairs, COUNT(of_pairs));
}

static void check_walls(const struct simulate_parameters *parameters,
                        const json_t *effective)
{
    for (int k = 0; k < parameters->walls.count; k++) {
        const struct wall_parameters *row =
            (const struct wall_parameters *)parameters->walls.row + k;
        const bool plane = row->shape == DEM_PLANE, block = row->shape == DEM_BLOCK,
                   ring = row->shape == DEM_RING, sphere = row->shape == DEM_SPHERE;
        const bool pressure = !isnan(row->servo_pressure);
        const struct unused_keys rules[] = {
            {plane || block, "radius|outside", "with shape=plane or block"},
            {ring, "outside", "with shape=ring"},
            {!ring, "inner_radius", "without shape=ring"},
            {!block, "half_edge", "without shape=block"},
            {sphere || block, "normal", "with shape=sphere or block"},
            {!pressure && isnan(row->servo_force), "servo",
             "without servo.force or servo.pressure"},
            {!pressure, "servo.area", "without servo.pressure"}};
        check_row(simulate_walls, effective, "walls", parameters->walls.name[k], rules,
                  COUNT(rules));
    }
}

void check_unused(const struct simulate_parameters *parameters, const json_t *effective,
                  bool has_forces)
{
    const int bond = parameters->bond_kind;
    const struct unused_keys rules[] = {
        {parameters->law != LAW_TIMED, "contact_time", "without law=timed"},
        {parameters->law != LAW_HERTZ, "expected_overlap", "without law=hertz"},
        {!parameters->box_walls, "box.material|box.friction", "without box.walls"},
        {bond == BOND_NONE, "bond", "with bond.kind=none"},
        {bond == BOND_PARALLEL, "bond.contact_strength", "with bond.kind=parallel"},
        {bond == BOND_CONTACT,
         "bond.normal_stiffness|bond.shear_stiffness|bond.normal_strength|"
         "bond.shear_strength|bond.radius_fraction",
         "with bond.kind=contact"},
        {!has_forces, "forces", "without a second input, of forces"},
        {isnan(parameters->stop_ratio), "stop.after", "without stop.unbalanced_ratio"}};
    check(simulate_table, effective, "", rules, COUNT(rules));
    check_materials(parameters, effective);
    check_walls(parameters, effective);
}
