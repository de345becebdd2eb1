// SPDX-License-Identifier: GPL-3.0-or-later
// From the parameters, which go by names, to the setup of the engine, which goes by
// numbers: materials, walls and groups in the order of their names, walls of the box
// before those.
//
// Units stay SI. Defaults that depend on another parameter are filled in here (a
// stiffness in shear from the normal one, damping from the restitution, water as the
// liquid); the engine gets numbers only.
#pragma once

#include "basics/status.h"
#include "parameters.h"

// A wall with what its motion is scaled by, and the servo it was given. The engine has
// the values at the factor 1; `control` multiplies them.
struct scene_wall {
    const char *name;                  // not owned
    char key[200];                     // "simulate.walls.NAME"
    const struct time_table *motion;   // NULL: constant; of the parameters
    double servo_pressure, servo_area; // NAN: not given
};

// It owns its arrays. SETUP points into them, into the struct itself, which must not be
// copied, into the packing and the parameters. Free with scene_free. PAIR_* are
// (n_material, n_material), symmetric. GROUP_OF counts all groups in the order of their
// names, DRIVEN_OF only those that the engine moves.
struct scene {
    struct dem_setup setup;
    struct dem_material *material; // (n_material)
    double *pair_friction, *pair_restitution, *pair_rolling;
    int n_material;
    uint8_t *material_of, *group_of; // (n_particle) group: from 1, 0: none
    uint8_t *driven_of;              // (n_particle) 1 + driven group, 0: none
    int n_group, n_driven;
    int *driven_group;            // (n_group) its number among the driven ones, or -1
    struct dem_group *driven;     // (n_driven)
    struct dem_wall *wall;        // (setup.n_wall)
    struct scene_wall *wall_more; // (setup.n_wall)
    double *normal_strength, *shear_strength; // (n_bond) NULL: those of setup.bond
    struct dem_liquid liquid;
    struct vector *velocity, *spin; // (n_particle) at the start
};

// PACKING must last as long. VELOCITY (n_particle) m/s, may be NULL. STATUS_BAD_DATA,
// with the key: a name that is not there, a group that overlaps another, a wall that
// grains stand in. SCENE is to be freed with scene_free also after a failure. That a
// wall stands in grains is found later, by run_scene, when the engine knows the
// overlaps.
enum status scene_init(const struct simulate_parameters *parameters,
                       const struct packing *packing, const struct vector *velocity,
                       struct scene *scene, struct reason *reason);
void scene_free(struct scene *scene);

static inline const struct group_parameters *
group_row(const struct simulate_parameters *parameters, int k)
{
    return (const struct group_parameters *)parameters->groups.row + k;
}
