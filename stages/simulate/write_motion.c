// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded columns go to the datasets of their names. The symbols among the extents of
// a dataset (n_particle, n_wall, n_group) are the width of its column over the fixed
// extents.
//
// Masses are those of the material, 4/3 pi R^3 rho, also with density_scaling, which
// gives grains another inertia: they are for those who average momentum or density over
// the grains.
#include "write_motion.h"

#include "basics/memory.h"
#include "control.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_particles(struct artifact *artifact, const struct scene *scene)
{
    const struct packing *packing = scene->setup.packing;
    const int n = packing->n_particle;
    uint8_t *driven = NEW_ARRAY(uint8_t, n);
    double *mass = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++) {
        const double r = packing->radius[i];
        driven[i] = scene->driven_of[i] > 0;
        mass[i] =
            4.0 / 3 * M_PI * r * r * r * scene->material[scene->material_of[i]].density;
    }
    artifact_put(artifact, "/particles/material", scene->material_of, n);
    artifact_put(artifact, "/particles/group", scene->group_of, n);
    artifact_put(artifact, "/particles/driven", driven, n);
    artifact_put(artifact, "/particles/mass", mass, n);
    free(driven);
    free(mass);
}

// Spheres and blocks need none, and keep the zero they may have.
static struct vector unit_normal(const struct dem_wall *wall)
{
    const double length = norm(wall->normal);
    return length > 0 ? scale(1 / length, wall->normal) : wall->normal;
}

static void put_walls(struct artifact *artifact, const struct scene *scene)
{
    const int n = scene->setup.n_wall;
    uint8_t *shape = NEW_ARRAY(uint8_t, n), *outside = NEW_ARRAY(uint8_t, n);
    struct vector *point = NEW_ARRAY(struct vector, n);
    struct vector *normal = NEW_ARRAY(struct vector, n);
    struct vector *half_edge = NEW_ARRAY(struct vector, n);
    double *radius = NEW_ARRAY(double, n), *inner = NEW_ARRAY(double, n);
    for (int w = 0; w < n; w++) {
        const struct dem_wall *wall = &scene->wall[w];
        shape[w] = (uint8_t)wall->shape;
        outside[w] = wall->outside;
        point[w] = wall->point;
        normal[w] = unit_normal(wall);
        half_edge[w] = wall->half_edge;
        radius[w] = wall->radius;
        inner[w] = wall->inner_radius;
    }
    artifact_put(artifact, "/walls/shape", shape, n);
    artifact_put(artifact, "/walls/outside", outside, n);
    artifact_put(artifact, "/walls/point", point, n);
    artifact_put(artifact, "/walls/normal", normal, n);
    artifact_put(artifact, "/walls/half_edge", half_edge, n);
    artifact_put(artifact, "/walls/radius", radius, n);
    artifact_put(artifact, "/walls/inner_radius", inner, n);
    void *const owned[] = {shape, outside, point, normal, half_edge, radius, inner};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
}

static void put_cracks(struct artifact *artifact, const struct dem *dem)
{
    int n;
    const struct dem_crack *crack = dem_cracks(dem, &n);
    int32_t *bond = NEW_ARRAY(int32_t, n);
    double *time = NEW_ARRAY(double, n);
    uint8_t *mode = NEW_ARRAY(uint8_t, n);
    struct vector *position = NEW_ARRAY(struct vector, n);
    for (int k = 0; k < n; k++) {
        bond[k] = crack[k].bond;
        time[k] = crack[k].time;
        mode[k] = crack[k].mode;
        position[k] = crack[k].position;
    }
    artifact_put(artifact, "/cracks/bond", bond, n);
    artifact_put(artifact, "/cracks/time", time, n);
    artifact_put(artifact, "/cracks/mode", mode, n);
    artifact_put(artifact, "/cracks/position", position, n);
    artifact_put_number(artifact, "/summary/cracks", n);
    free(bond);
    free(time);
    free(mode);
    free(position);
}

// The limit is infinite where nothing touches; 0 says so in a number that every reader
// takes.
static void put_summary(struct artifact *artifact, const struct outcome *outcome)
{
    const struct dem *dem = outcome->dem;
    artifact_put_number(artifact, "/summary/time", dem_time(dem));
    artifact_put_number(artifact, "/summary/cycles", (double)dem_cycle(dem));
    artifact_put_number(artifact, "/summary/time_step", dem_time_step(dem));
    const double limit = dem_time_step_limit_now(dem);
    artifact_put_number(artifact, "/summary/time_step_limit",
                        isfinite(limit) ? limit : 0);
    artifact_put_number(artifact, "/summary/ended", outcome->ending == ENDED_AT_REST);
    artifact_put_number(artifact, "/summary/largest_overlap",
                        outcome->record.largest_overlap);
}

// The extent of COLUMN that a symbol of the schema stands for; 0: it has none.
static int symbol_of(const struct recorded_column *column, const struct scene *scene)
{
    if (!strncmp(column->dataset, "/history/wall_", 14)) return scene->setup.n_wall;
    if (!strncmp(column->dataset, "/history/group_", 15)) return scene->n_group;
    return scene->setup.packing->n_particle;
}

void put_motion(struct artifact *artifact, const struct scene *scene,
                const struct outcome *outcome)
{
    artifact_put_packing(artifact, scene->setup.packing);
    put_particles(artifact, scene);
    put_walls(artifact, scene);
    put_cracks(artifact, outcome->dem);
    put_summary(artifact, outcome);
    for (int k = 0; k < outcome->record.n_column; k++) {
        const struct recorded_column *column = &outcome->record.column[k];
        artifact_put_table(artifact, column->dataset, column->data, (int)column->rows,
                           symbol_of(column, scene));
    }
}

// In place, in order; memmove because a row may be copied onto itself.
static void keep_intact_bonds(const struct dem *dem, struct packing *packing)
{
    uint8_t *intact = NEW_ARRAY(uint8_t, packing->n_bond);
    dem_bonds_intact(dem, intact);
    int kept = 0;
    for (int b = 0; b < packing->n_bond; b++) {
        if (!intact[b]) continue;
        if (packing->bond_strength)
            packing->bond_strength[kept] = packing->bond_strength[b];
        memmove(packing->bond[kept++], packing->bond[b], sizeof *packing->bond);
    }
    packing->n_bond = kept;
    free(intact);
}

// m3, of what bounds the grains: a body that they lie in, or the box, without those
// that they lie around. A round one has the edges of its box: pi/4 of it where round
// about an axis, pi/6 in a sphere.
static double bounded_volume(const struct packing *packing)
{
    static const double share[BODY_SHAPES] = {[BODY_BOX] = 1,
                                              [BODY_CYLINDER] = M_PI / 4,
                                              [BODY_SPHERE] = M_PI / 6,
                                              [BODY_DISC] = M_PI / 4};
    const struct vector edge = subtract(packing->upper, packing->lower);
    const double around = box_volume(edge);
    double within = 0, left_out = 0;
    for (int k = 0; k < packing->n_body; k++) {
        const struct body *body = &packing->body[k];
        const struct vector e = subtract(body->upper, body->lower);
        *(body->within ? &within : &left_out) += share[body->shape] * e.x * e.y * e.z;
    }
    return (within > 0 ? within : around) - left_out;
}

// Porosity over that volume, overlaps counted twice, and the contacts of grains. The
// same numbers as those of `pack`, by the same names, so that what reads a packing
// finds them. Pairs across a gap (bonds, bridges) are no contacts.
static void put_packing_summary(struct artifact *artifact,
                                const struct packing *packing, const struct dem *dem)
{
    double solid = 0, largest = 0;
    for (int i = 0; i < packing->n_particle; i++)
        solid += 4.0 / 3 * M_PI * pow(packing->radius[i], 3);
    int n, touching = 0;
    struct dem_contact *contact = dem_contacts(dem, &n);
    for (int k = 0; k < n; k++) {
        const int32_t *of = contact[k].particle;
        if (of[1] < 0 || contact[k].overlap < 0) continue;
        touching++;
        largest = fmax(largest, contact[k].overlap / fmin(packing->radius[of[0]],
                                                          packing->radius[of[1]]));
    }
    free(contact);
    const double ratio = dem_unbalanced_ratio(dem);
    artifact_put_number(artifact, "/summary/porosity",
                        1 - solid / bounded_volume(packing));
    artifact_put_number(artifact, "/summary/max_overlap", largest);
    artifact_put_number(artifact, "/summary/coordination",
                        packing->n_particle > 0 ? 2.0 * touching / packing->n_particle
                                                : 0);
    artifact_put_number(artifact, "/summary/unbalanced_ratio",
                        isfinite(ratio) ? ratio : 0);
}

void put_final_packing(struct artifact *artifact,
                       const struct simulate_parameters *parameters,
                       const struct scene *scene, const struct outcome *outcome)
{
    const struct packing *before = scene->setup.packing;
    const int n = before->n_particle;
    struct packing packing = *before;
    packing.position = NEW_ARRAY(struct vector, n);
    packing.bond =
        duplicate(before->bond, (size_t)before->n_bond, sizeof *before->bond);
    packing.bond_strength = copy_bond_strengths(before);
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    dem_positions(outcome->dem, packing.position);
    dem_box(outcome->dem, &packing.lower, &packing.upper);
    dem_velocities_at_places(outcome->dem, velocity);
    const bool began = dem_cycle(outcome->dem) > 0;
    for (int i = 0; i < n && !began; i++) // those given: no force has acted yet
        if (!scene->driven_of[i]) velocity[i] = scene->velocity[i];
    for (int i = 0; i < n; i++)
        velocity[i] = add(velocity[i], strain_velocity(parameters, packing.lower,
                                                       packing.position[i]));
    keep_intact_bonds(outcome->dem, &packing);
    artifact_put_packing(artifact, &packing);
    put_packing_summary(artifact, &packing, outcome->dem);
    artifact_put(artifact, "/particles/velocity", velocity, n);
    free(packing.position);
    free(packing.bond);
    free(packing.bond_strength);
    free(velocity);
}
