// SPDX-License-Identifier: GPL-3.0-or-later
// Diagrams of scattered grains, for the test of wedges: in boxes, in layers, below
// auxiliary grains, in a sphere and around one.
#pragma once

#include "../../random.h"
#include "../../test.h"
#include "basics/memory.h"
#include "tessellate/diagram.h"

#include <string.h>

enum surroundings {
    IN_A_BOX,
    IN_A_NARROW_BOX,
    BELOW_AUXILIARY,
    IN_A_SPHERE,
    AROUND_A_SPHERE
};

struct scene {
    bool layer;
    uint8_t periodic[3];
    enum boundary boundary;
    enum surroundings where;
};

static const struct scene scenes[] = {
    {false, {0, 0, 0}, BOUNDARY_TRUNCATE, IN_A_BOX},
    {false, {1, 1, 0}, BOUNDARY_TRUNCATE, IN_A_BOX},
    {false, {0, 0, 0}, BOUNDARY_ELIMINATE, IN_A_BOX},
    {false, {1, 1, 0}, BOUNDARY_ELIMINATE, IN_A_BOX},
    {true, {0, 0, 0}, BOUNDARY_TRUNCATE, IN_A_BOX},
    {true, {1, 0, 0}, BOUNDARY_TRUNCATE, IN_A_BOX},
    {true, {0, 0, 0}, BOUNDARY_ELIMINATE, IN_A_BOX},
    {true, {1, 0, 0}, BOUNDARY_ELIMINATE, IN_A_BOX},
    {true, {0, 0, 1}, BOUNDARY_ELIMINATE, IN_A_BOX},
    {false, {0, 0, 0}, BOUNDARY_TRUNCATE, BELOW_AUXILIARY},
    {true, {1, 0, 0}, BOUNDARY_TRUNCATE, BELOW_AUXILIARY},
    {false, {0, 0, 0}, BOUNDARY_TRUNCATE, IN_A_SPHERE},
    {false, {0, 0, 0}, BOUNDARY_ELIMINATE, IN_A_SPHERE},
    {false, {1, 1, 0}, BOUNDARY_TRUNCATE, AROUND_A_SPHERE}};
enum { N_SCENE = sizeof scenes / sizeof *scenes };

// Of x from the nearest copy of y.
static inline struct vector nearest(const struct packing *packing, struct vector y,
                                    struct vector x)
{
    struct vector apart = subtract(x, y);
    for (int axis = 0; axis < 3; axis++) {
        const double edge = component(packing->upper, axis);
        const double way = component(apart, axis);
        if (packing->periodic[axis])
            set_component(&apart, axis, way - edge * rint(way / edge));
    }
    return apart;
}

// Of X above the sphere.
static inline double height_above(const struct packing *packing, struct vector x)
{
    const struct body *body = packing->body;
    const struct vector middle = scale(0.5, add(body->lower, body->upper));
    return distance(x, middle) - 0.5 * (body->upper.x - body->lower.x);
}

// Far enough from the others, and from walls that the box does not repeat at.
static inline bool is_free(const struct packing *packing, struct vector x,
                           double radius)
{
    for (int axis = 0; axis < 3; axis++) {
        const double at = component(x, axis), edge = component(packing->upper, axis);
        if (!packing->periodic[axis] && fmin(at, edge - at) < radius) return false;
    }
    if (packing->n_body > 0) {
        const double above = height_above(packing, x);
        if ((packing->body->within ? -above : above) < radius) return false;
    }
    for (int j = 0; j < packing->n_particle; j++)
        if (norm(nearest(packing, packing->position[j], x)) <
            packing->radius[j] + radius)
            return false;
    return true;
}

static inline void add_sphere(const struct scene *scene, struct packing *packing)
{
    const bool within = scene->where == IN_A_SPHERE;
    const struct vector middle = scale(0.5, packing->upper);
    const double radius = within ? 2.5 : 1;
    const struct vector reach = {radius, radius, radius};
    packing->n_body = 1;
    packing->body[0] = (struct body){.shape = BODY_SPHERE,
                                     .within = within,
                                     .lower = subtract(middle, reach),
                                     .upper = add(middle, reach)};
}

// On top of the box, which grows: one grain on each unit of its upper side.
static inline void add_auxiliary(struct packing *packing, uint64_t *seed)
{
    const int nx = (int)packing->upper.x, ny = (int)packing->upper.y;
    packing->kind = NEW_ARRAY(uint8_t, packing->n_particle + nx * ny);
    packing->upper.z += 1;
    for (int k = 0; k < nx * ny; k++) {
        const int i = packing->n_particle++;
        packing->kind[i] = GRAIN_AUXILIARY;
        packing->radius[i] = 0.4;
        packing->position[i] =
            (struct vector){0.4 + k % nx + 0.2 * next_random(seed),
                            ny > 1 ? 0.4 + k / nx + 0.2 * next_random(seed) : 0.5,
                            packing->upper.z - 0.5};
    }
}

// Grains of radii from 0.25 to 0.5 that do not touch.
static inline struct packing scattered(const struct scene *scene, uint64_t seed)
{
    const bool is_narrow = scene->where == IN_A_NARROW_BOX;
    const int n = is_narrow                     ? 10
                  : scene->layer                ? 60
                  : scene->where == IN_A_SPHERE ? 50
                                                : 110;
    struct packing packing = {.position = NEW_ARRAY(struct vector, 2 * n),
                              .radius = NEW_ARRAY(double, 2 * n),
                              .upper = {5, 5, 6}};
    memcpy(packing.periodic, scene->periodic, sizeof packing.periodic);
    if (scene->layer) packing.upper = (struct vector){8, 1, 9};
    if (is_narrow) packing.upper = (struct vector){1.3, 1.2, 6};
    if (scene->where >= IN_A_SPHERE) add_sphere(scene, &packing);
    const struct vector edge = packing.upper;
    while (packing.n_particle < n) {
        const double radius = 0.25 * (1 + next_random(&seed));
        const struct vector x = {edge.x * next_random(&seed),
                                 scene->layer ? 0.5 : edge.y * next_random(&seed),
                                 edge.z * next_random(&seed)};
        if (!is_free(&packing, x, radius)) continue;
        packing.position[packing.n_particle] = x;
        packing.radius[packing.n_particle++] = radius;
    }
    if (scene->where == BELOW_AUXILIARY) add_auxiliary(&packing, &seed);
    return packing;
}

static inline struct network diagram_of(const struct scene *scene, uint64_t seed)
{
    struct packing packing = scattered(scene, seed);
    const struct tessellation how = {
        .power = true, .boundary = scene->boundary, .layer = scene->layer};
    struct network network;
    struct tessellation_report report;
    struct reason reason;
    if (tessellate(&packing, &how, &network, &report, &reason))
        fail_msg("%s", reason.text);
    packing_free(&packing);
    return network;
}

static inline void resize(struct network *network, double factor)
{
    struct packing *packing = &network->packing;
    packing->upper = scale(factor, packing->upper);
    for (int k = 0; k < packing->n_body; k++) {
        packing->body[k].lower = scale(factor, packing->body[k].lower);
        packing->body[k].upper = scale(factor, packing->body[k].upper);
    }
    for (int i = 0; i < packing->n_particle; i++) {
        packing->position[i] = scale(factor, packing->position[i]);
        packing->radius[i] *= factor;
    }
    for (int i = 0; i < network->n_node; i++)
        network->node_position[i] = scale(factor, network->node_position[i]);
    for (int t = 0; t < network->n_throat; t++)
        network->throat_length[t] *= factor;
}

// Every second face's loop runs the other way.
static inline void turn_loops(struct network *network)
{
    for (int face = 0; face < network->n_face; face += 2) {
        int64_t a = network->face_offset[face], b = network->face_offset[face + 1] - 1;
        for (; a < b; a++, b--) {
            const int32_t node = network->face_nodes[a];
            network->face_nodes[a] = network->face_nodes[b];
            network->face_nodes[b] = node;
            if (!network->face_node_image) continue;
            const struct image image = network->face_node_image[a];
            network->face_node_image[a] = network->face_node_image[b];
            network->face_node_image[b] = image;
        }
    }
}
