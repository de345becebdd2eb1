// SPDX-License-Identifier: GPL-3.0-or-later
// One impact of a grain on a plane or on another grain, run by the engine and watched
// through displacements and velocities only: forces are m dv/dt.
//
// Grain 0 comes from above (z > 0) onto the plane z = 0, or onto grain 1 below it. They
// touch at the start, or ONSET time steps later.
#pragma once

#include "basics/memory.h"
#include "dem/dem.h"

#include <math.h>
#include <stdlib.h>

struct impact {
    enum dem_law law;
    struct dem_material material, other; // of grains 0 and 1; OTHER.density 0: the same
    double radius[2];                    // m; the second 0: a plane
    bool elastic_plane;                  // of the grain's material; otherwise rigid
    bool friction_feels_dashpot;
    struct vector velocity[2], spin[2];
    double time_step; // s
    double onset;     // time steps
    bool no_tensile_damping;
};

struct outcome {
    double peak_force; // N, normal
    double peak_overlap;
    double largest_pull; // N, of the attraction when a damped contact ends
    double contact_time; // s
    struct vector velocity[2], spin[2];
    int steps; // with contact
};

static inline double sphere_mass(double density, double radius)
{
    return density * 4.0 / 3 * M_PI * radius * radius * radius;
}

static inline double closing_speed(const struct impact *is)
{
    return is->velocity[1].z - is->velocity[0].z;
}

static inline struct dem *start_impact(const struct impact *is, double gap)
{
    const bool pair = is->radius[1] > 0;
    struct vector position[2] = {{0, 0, is->radius[0] + gap}, {0, 0, -is->radius[1]}};
    double radius[2] = {is->radius[0], is->radius[1]};
    const double far = 8 * (is->radius[0] + is->radius[1]);
    const struct packing packing = {.n_particle = pair ? 2 : 1,
                                    .position = position,
                                    .radius = radius,
                                    .lower = {-far, -far, -far},
                                    .upper = {far, far, far}};
    const bool differ = is->other.density > 0;
    const struct dem_material other = differ ? is->other : is->material;
    const uint8_t material_of[2] = {0, differ};
    const struct dem_wall plane = {.normal = {0, 0, 1},
                                   .shape = DEM_PLANE,
                                   .elastic = is->elastic_plane > 0,
                                   .material = is->elastic_plane};
    const struct dem_setup setup = {.packing = &packing,
                                    .law = is->law,
                                    .material = is->material,
                                    .n_other = differ || is->elastic_plane,
                                    .other = &other,
                                    .material_of = material_of,
                                    .n_wall = !pair,
                                    .wall = &plane,
                                    .time_step = is->time_step,
                                    .force_time_step = true,
                                    .friction_feels_dashpot =
                                        is->friction_feels_dashpot,
                                    .no_tensile_damping = is->no_tensile_damping,
                                    .threads = 1};
    struct dem *dem;
    struct reason reason = {""};
    const enum status status = dem_create(&dem, &setup, &reason);
    if (status != STATUS_OK) die(status, "%s", reason.text);
    dem_set_velocity(dem, is->velocity, is->spin);
    return dem;
}

// From displacements, so that it keeps all its digits.
static inline double overlap_now(const struct impact *is, const struct vector *moved,
                                 double gap)
{
    if (is->radius[1] <= 0) return -moved[0].z - gap;
    const struct vector by = subtract(moved[0], moved[1]);
    const struct vector start = {0, 0, is->radius[0] + is->radius[1] + gap};
    const struct vector now = add(start, by);
    return -dot(by, add(start, now)) / (norm(start) + norm(now)) - gap;
}

// Runs until they part.
static inline struct outcome run_impact(const struct impact *is)
{
    const double gap = is->onset * is->time_step * closing_speed(is);
    const double mass = sphere_mass(is->material.density, is->radius[0]);
    struct dem *dem = start_impact(is, gap);
    struct outcome out = {.peak_force = 0};
    struct reason reason = {""};
    struct vector moved[2] = {{0}};
    double overlap = -gap, before = is->velocity[0].z;
    for (;;) {
        const double last = overlap;
        if (dem_run(dem, 1, &reason) != STATUS_OK)
            die(STATUS_INTERNAL, "%s", reason.text);
        dem_displacements(dem, moved);
        dem_velocities(dem, out.velocity);
        overlap = overlap_now(is, moved, gap);
        const double force = mass * (out.velocity[0].z - before) / is->time_step;
        before = out.velocity[0].z;
        out.peak_force = fmax(out.peak_force, force);
        out.largest_pull = fmax(out.largest_pull, -force);
        out.peak_overlap = fmax(out.peak_overlap, overlap);
        out.steps += last >= 0;
        if (last <= 0 && overlap > last) continue; // still coming
        if (overlap > 0) continue;
        out.contact_time = is->time_step * ((double)dem_cycle(dem) - is->onset -
                                            overlap / (overlap - last));
        break;
    }
    dem_run(dem, 1, &reason); // the force of the last overlap has acted
    dem_velocities(dem, out.velocity);
    dem_spins(dem, out.spin);
    dem_free(dem);
    return out;
}
