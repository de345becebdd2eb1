// SPDX-License-Identifier: GPL-3.0-or-later
// Names become numbers: that of a material is its place among the sorted names, that of
// a wall its place behind the walls of the box, that of a group its place from 1. So
// results do not depend on the order in which a scene lists them.
//
// Numbers that the user may leave out, for a material of restitution e and normal
// stiffness k_n:
//
//     zeta = -ln e / sqrt(pi^2 + ln^2 e)        damping ratio [K 4.28]
//     k_s  = 2/7 k_n                            shear stiffness [G 2]
//
// The first makes a linear contact rebound at e: half a period of a damped oscillator
// leaves exp(-pi zeta / sqrt(1 - zeta^2)) of its speed. The second gives a solid sphere
// (inertia 2/5 m R^2, so an effective mass of 2/7 m at its surface) one period along
// and across the contact.
//
// Friction, restitution and rolling friction of two materials are the smaller of theirs
// [K 4.25], unless `pairs` says otherwise.
#include "scene.h"

#include "basics/memory.h"
#include "fluids/fluids.h"
#include "groups.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- materials ----------------------------------------------------------------------

// Damping ratio zeta of a linear contact that rebounds with RESTITUTION e: ln e = -pi
// zeta / sqrt(1 - zeta^2).
static double damping_ratio(double restitution)
{
    const double logarithm = log(restitution);
    return -logarithm / sqrt(M_PI * M_PI + logarithm * logarithm);
}

static double given_or(double given, double otherwise)
{
    return isnan(given) ? otherwise : given;
}

// Members that the law does not use are passed on as they are, a modulus that was not
// given as NAN.
static struct dem_material make_material(const struct material_parameters *row,
                                         const struct simulate_parameters *parameters)
{
    return (struct dem_material){
        .density = row->density,
        .normal_stiffness = given_or(row->normal_stiffness, 0),
        .shear_stiffness = given_or(row->shear_stiffness,
                                    2.0 / 7 * given_or(row->normal_stiffness, 0)),
        .friction = row->friction,
        .damping_ratio = given_or(row->damping_ratio, damping_ratio(row->restitution)),
        .local_damping = parameters->local_damping,
        .contact_time = parameters->contact_time,
        .restitution = row->restitution,
        .rolling_friction = row->rolling_friction,
        .rolling_damping = row->rolling_friction > 0 ? row->rolling_damping : 0,
        .young_modulus = row->young_modulus,
        .poisson_ratio = row->poisson_ratio};
}

// The number of material NAME, said at KEY; below 0: there is none.
static int find_material(const struct simulate_parameters *parameters, const char *name,
                         const char *key, struct reason *reason)
{
    const int k = named_row(&parameters->materials, name);
    if (k < 0)
        refuse(reason, STATUS_BAD_DATA, "simulate.%s: there is no material %s", key,
               name);
    return k;
}

// Every pair first by the rule of the smaller one; read_pairs then replaces what was
// given.
static void make_pair_tables(struct scene *scene)
{
    const int n = scene->n_material;
    const struct dem_material *material = scene->material;
    scene->pair_friction = NEW_ARRAY(double, n *n);
    scene->pair_restitution = NEW_ARRAY(double, n *n);
    scene->pair_rolling = NEW_ARRAY(double, n *n);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            scene->pair_friction[a * n + b] =
                fmin(material[a].friction, material[b].friction);
            scene->pair_restitution[a * n + b] =
                fmin(material[a].restitution, material[b].restitution);
            scene->pair_rolling[a * n + b] =
                fmin(material[a].rolling_friction, material[b].rolling_friction);
        }
}

// Both halves of the symmetric tables are set. A pair of names that occurs twice: the
// later row, by name, wins.
static enum status read_pairs(const struct simulate_parameters *parameters,
                              struct scene *scene, struct reason *reason)
{
    const int n = scene->n_material;
    for (int k = 0; k < parameters->pairs.count; k++) {
        const struct pair_parameters *row =
            (const struct pair_parameters *)parameters->pairs.row + k;
        char key[300];
        snprintf(key, sizeof key, "pairs.%s", parameters->pairs.name[k]);
        const int a = find_material(parameters, row->first, key, reason);
        if (a < 0) return STATUS_BAD_DATA;
        const int b = find_material(parameters, row->second, key, reason);
        if (b < 0) return STATUS_BAD_DATA;
        double *friction = scene->pair_friction, *rebound = scene->pair_restitution;
        friction[a * n + b] = friction[b * n + a] =
            given_or(row->friction, friction[a * n + b]);
        rebound[a * n + b] = rebound[b * n + a] =
            given_or(row->restitution, rebound[a * n + b]);
        double *rolling = scene->pair_rolling;
        rolling[a * n + b] = rolling[b * n + a] =
            given_or(row->rolling_friction, rolling[a * n + b]);
    }
    return STATUS_OK;
}

// Materials of grains are bytes.
static enum status read_materials(const struct simulate_parameters *parameters,
                                  struct scene *scene, struct reason *reason)
{
    const int n = scene->n_material = parameters->materials.count;
    if (n > 255)
        return refuse(reason, STATUS_BAD_DATA,
                      "simulate.materials: at most 255, got %d", n);
    scene->material = NEW_ARRAY(struct dem_material, n);
    for (int k = 0; k < n; k++)
        scene->material[k] = make_material(
            (const struct material_parameters *)parameters->materials.row + k,
            parameters);
    make_pair_tables(scene);
    return read_pairs(parameters, scene, reason);
}

// The material of its group, else that of the scene, else the only one. A guess among
// several would change densities silently.
static enum status give_materials(const struct simulate_parameters *parameters,
                                  const struct packing *packing, struct scene *scene,
                                  struct reason *reason)
{
    int usual = 0;
    if (parameters->material)
        usual = find_material(parameters, parameters->material, "material", reason);
    if (usual < 0) return STATUS_BAD_DATA;
    scene->material_of = NEW_ARRAY(uint8_t, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++) {
        const int group = scene->group_of[i] - 1;
        const char *name = group >= 0 ? group_row(parameters, group)->material : NULL;
        char key[300];
        if (group >= 0)
            snprintf(key, sizeof key, "groups.%s.material",
                     parameters->groups.name[group]);
        const int k = name ? find_material(parameters, name, key, reason) : usual;
        if (k < 0) return STATUS_BAD_DATA;
        if (!name && !parameters->material && scene->n_material > 1)
            return refuse(reason, STATUS_BAD_DATA,
                          "simulate.material: grain %d has none: name one of the %d "
                          "materials, here or in its group",
                          i, scene->n_material);
        scene->material_of[i] = (uint8_t)k;
    }
    return STATUS_OK;
}

// ---- walls --------------------------------------------------------------------------

// A wall without one is rigid: a grain feels its own stiffness alone.
static enum status set_wall_material(const struct simulate_parameters *parameters,
                                     const char *material, const char *key,
                                     struct dem_wall *wall, struct reason *reason)
{
    wall->elastic = material != NULL;
    if (!material) return STATUS_OK;
    wall->material = find_material(parameters, material, key, reason);
    return wall->material < 0 ? STATUS_BAD_DATA : STATUS_OK;
}

// The engine's next wall, which is set, has MORE too, and a name for messages.
static void add_wall(struct scene *scene, struct scene_wall more)
{
    const int w = scene->setup.n_wall++;
    scene->wall_more[w] = more;
    char *key = scene->wall_more[w].key;
    snprintf(key, sizeof more.key, "simulate.walls.%s", more.name);
    scene->wall[w].name = key;
}

// The normal points into the box, where the grains are.
static enum status add_box_walls(const struct simulate_parameters *parameters,
                                 const struct packing *packing, struct scene *scene,
                                 struct reason *reason)
{
    static const char *const names[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    for (int side = 0; side < WALL_COUNT; side++) {
        if (!(parameters->box_walls >> side & 1)) continue;
        const bool upper = side % 2;
        if (packing->periodic[side / 2])
            return refuse(
                reason, STATUS_BAD_DATA,
                "simulate.box.walls: the box repeats across %s, where no wall "
                "can be",
                names[side]);
        struct dem_wall *wall = &scene->wall[scene->setup.n_wall];
        *wall = (struct dem_wall){.point = upper ? packing->upper : packing->lower,
                                  .friction = given_or(parameters->box_friction, 0),
                                  .has_friction = !isnan(parameters->box_friction)};
        set_component(&wall->normal, side / 2, upper ? -1 : 1);
        add_wall(scene, (struct scene_wall){.name = names[side],
                                            .servo_pressure = NAN,
                                            .servo_area = NAN});
        const enum status status = set_wall_material(
            parameters, parameters->box_material, "box.material", wall, reason);
        if (status) return status;
    }
    return STATUS_OK;
}

// A friction that was not given is that of the materials in contact; 0 would be a
// smooth wall. So it needs a flag of its own.
static struct dem_wall make_wall(const struct wall_parameters *row)
{
    return (struct dem_wall){
        .point = as_vector(row->point),
        .normal = as_vector(row->normal),
        .shape = (enum dem_wall_shape)row->shape,
        .outside = row->outside,
        .radius = given_or(row->radius, 0),
        .inner_radius = row->inner_radius,
        .half_edge = isnan(row->half_edge[0]) ? (struct vector){0, 0, 0}
                                              : as_vector(row->half_edge),
        .friction = given_or(row->friction, 0),
        .has_friction = !isnan(row->friction),
        .velocity = as_vector(row->velocity),
        .spin = as_vector(row->spin),
        .servo_force = given_or(row->servo_force, 0),
        .servo_largest_speed = given_or(row->servo_largest_speed, 0)};
}

static enum status read_walls(const struct simulate_parameters *parameters,
                              const struct packing *packing, struct scene *scene,
                              struct reason *reason)
{
    const int most = WALL_COUNT + parameters->walls.count;
    scene->wall = NEW_ARRAY(struct dem_wall, most);
    scene->wall_more = NEW_ARRAY(struct scene_wall, most);
    enum status status = add_box_walls(parameters, packing, scene, reason);
    for (int k = 0; k < parameters->walls.count && !status; k++) {
        const struct wall_parameters *row =
            (const struct wall_parameters *)parameters->walls.row + k;
        struct dem_wall *wall = &scene->wall[scene->setup.n_wall];
        *wall = make_wall(row);
        add_wall(scene, (struct scene_wall){.name = parameters->walls.name[k],
                                            .motion = &row->motion,
                                            .servo_pressure = row->servo_pressure,
                                            .servo_area = row->servo_area});
        char key[300];
        snprintf(key, sizeof key, "walls.%s.material", parameters->walls.name[k]);
        status = set_wall_material(parameters, row->material, key, wall, reason);
    }
    scene->setup.wall = scene->wall;
    return status;
}

// ---- the rest -----------------------------------------------------------------------

// A scene has no temperature or pressure of its own: 20 degrees Celsius and 1 bar.
static void read_liquid(const struct simulate_parameters *parameters,
                        struct scene *scene)
{
    if (!(parameters->liquid.volume > 0)) return;
    scene->liquid = parameters->liquid;
    scene->liquid.model = (enum bridge_model)parameters->bridge_model;
    scene->liquid.contact_angle = parameters->contact_angle * (M_PI / 180);
    scene->liquid.surface_tension =
        given_or(parameters->surface_tension,
                 fluid_value(FLUID_WATER, FLUID_SURFACE_TENSION, 293.15, 1e5));
    scene->setup.liquid = &scene->liquid;
}

// A contact bond has one strength, in tension and in shear [K 4.2].
static void read_bonds(const struct simulate_parameters *parameters,
                       const struct packing *packing, struct scene *scene)
{
    struct dem_bond_material *bond = &scene->setup.bond;
    *bond = parameters->bond;
    bond->kind =
        parameters->bond_kind == BOND_CONTACT ? DEM_CONTACT_BOND : DEM_PARALLEL_BOND;
    if (parameters->bond_kind == BOND_CONTACT)
        bond->normal_strength = bond->shear_strength =
            given_or(parameters->bond_contact_strength, INFINITY);
    scene->normal_strength = scale_bond_strengths(packing, bond->normal_strength);
    scene->shear_strength = scale_bond_strengths(packing, bond->shear_strength);
    scene->setup.normal_strength = scene->normal_strength;
    scene->setup.shear_strength = scene->shear_strength;
}

// NAN for the safety leaves the step to the engine's stability limit, unless time_step
// is given. That limit knows rotation, dashpots and several contacts a grain; [K 4.47]
// does not.
static void set_engine(const struct simulate_parameters *parameters,
                       const struct packing *packing, struct scene *scene)
{
    static const enum dem_law laws[] = {DEM_HERTZ, DEM_LINEAR, DEM_TIMED};
    struct dem_setup *setup = &scene->setup;
    setup->packing = packing;
    setup->law = laws[parameters->law];
    setup->material = scene->material[0];
    setup->n_other = scene->n_material - 1;
    setup->other = scene->material + 1;
    setup->material_of = scene->material_of;
    setup->pair_friction = scene->pair_friction;
    setup->pair_restitution = scene->pair_restitution;
    setup->pair_rolling_friction = scene->pair_rolling;
    setup->n_group = scene->n_driven;
    setup->group = scene->driven;
    setup->group_of = scene->driven_of;
    setup->gravity = as_vector(parameters->gravity);
    setup->density_scaling = parameters->density_scaling;
    setup->time_step_safety = NAN;
    setup->automatic_share = parameters->time_step_share;
    setup->time_step = given_or(parameters->time_step, 0);
    setup->largest_overlap = parameters->expected_overlap;
    setup->force_time_step = parameters->allow_unstable;
    setup->unstressed = !parameters->prestress;
    setup->adhesion = parameters->adhesion;
    setup->friction_feels_dashpot = parameters->friction_limit == 1;
    setup->no_tensile_damping = !parameters->tensile_damping;
    setup->balance_energy = parameters->record_energy;
}

// Bonds and driven groups do not follow a box that is strained. The engine rescales
// neither of them (dem_rescale): a bond accumulates its load from velocities, of which
// a rescaling has none. And in a direction that does not repeat the strain would move
// no wall. Overlaps at rest with walls are those of the starts, which a rescaling
// moves.
static enum status check_strain(const struct simulate_parameters *parameters,
                                const struct scene *scene, struct reason *reason)
{
    const struct packing *packing = scene->setup.packing;
    for (int axis = 0; axis < 3; axis++) {
        if (!(fabs(parameters->strain_rate[axis]) > 0)) continue;
        if (!packing->periodic[axis])
            return refuse(reason, STATUS_BAD_DATA,
                          "simulate.box.strain_rate: the box does not repeat along %c: "
                          "let walls move there",
                          "xyz"[axis]);
        if (packing->n_bond > 0 || scene->n_driven > 0)
            return refuse(reason, STATUS_BAD_DATA,
                          "simulate.box.strain_rate: must be 0 with bonds (bond.kind) "
                          "or driven groups");
        if (!parameters->prestress && scene->setup.n_wall > 0)
            return refuse(reason, STATUS_BAD_DATA,
                          "simulate.prestress: must be true with box.strain_rate and "
                          "walls");
    }
    return STATUS_OK;
}

// In this order because each needs the one before: groups name materials, grains take
// them from groups.
enum status scene_init(const struct simulate_parameters *parameters,
                       const struct packing *packing, const struct vector *velocity,
                       struct scene *scene, struct reason *reason)
{
    *scene = (struct scene){0};
    enum status status = read_materials(parameters, scene, reason);
    if (!status) status = read_groups(parameters, packing, velocity, scene, reason);
    if (!status) status = give_materials(parameters, packing, scene, reason);
    if (!status) status = read_walls(parameters, packing, scene, reason);
    if (status) return status;
    read_liquid(parameters, scene);
    read_bonds(parameters, packing, scene);
    set_engine(parameters, packing, scene);
    return check_strain(parameters, scene, reason);
}

void scene_free(struct scene *scene)
{
    void *const owned[] = {
        scene->material,         scene->pair_friction,   scene->material_of,
        scene->pair_restitution, scene->group_of,        scene->driven_of,
        scene->driven_group,     scene->driven,          scene->wall,
        scene->wall_more,        scene->velocity,        scene->spin,
        scene->pair_rolling,     scene->normal_strength, scene->shear_strength};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    *scene = (struct scene){0};
}
