// SPDX-License-Identifier: GPL-3.0-or-later
// A steel ball shot into a bed of beads: the third case of Dosta et al. (2024), Comput.
// Phys. Commun. 296, 109066. Prints time, height and velocity of the ball.
//
//     penetration_study BED.h5 M1|M2 [SECONDS [THREADS [TIME_STEP [START]]]]
//
// BED.h5 is a packing of beads at rest in the box below, by pack. The ball sets out at
// START (s) from where it has fallen to by then; up to 0.0207 it falls freely.
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "dem/dem.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The inner faces of the benchmark's box, m.
static const struct vector box_lower = {-0.049, -0.03, -0.0902431};
static const struct vector box_upper = {0.049, 0.03, 0.107757};
static const double ball_height = 0.06, ball_speed = 5; // at 0 s, downwards
static const double ball_radius = 0.01, gravity = 9.81;

struct beads {
    const char *name;
    double density, young_modulus, friction, restitution; // of bead on bead
};

static const struct beads kinds[] = {{"M1", 2500, 1e9, 0.3, 0.5},
                                     {"M2", 2000, 0.5e9, 0.4, 0.4}};
// Of bead on steel, and of steel on steel, which never meets here.
static const double steel_friction[2] = {0.2, 0.5}, steel_restitution[2] = {0.4, 0.6};

static const struct beads *beads_of(const char *name)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (!strcmp(name, kinds[k].name)) return &kinds[k];
    die(STATUS_USAGE, "%s: M1 or M2", name);
}

static struct packing read_bed(const char *path)
{
    struct artifact *bed = artifact_open(path, "packing");
    struct packing packing = artifact_get_packing(bed);
    artifact_close(bed);
    packing.n_bond = 0;
    for (int i = 0; i < packing.n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = component(packing.position[i], axis);
            if (x < component(box_lower, axis) || x > component(box_upper, axis))
                die(STATUS_BAD_DATA, "%s: grain %d is outside the box", path, i);
        }
    return packing;
}

// Of the bed as high as twice its mean height.
static double solid_fraction(const struct packing *packing)
{
    double volume = 0, height = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double radius = packing->radius[i];
        volume += 4.0 / 3 * M_PI * radius * radius * radius;
        height += 2 * (packing->position[i].z - box_lower.z) / packing->n_particle;
    }
    return volume /
           (height * (box_upper.x - box_lower.x) * (box_upper.y - box_lower.y));
}

// The ball comes last.
static void add_ball(struct packing *packing, double start)
{
    const size_t n = (size_t)packing->n_particle++;
    packing->position = reallocate(packing->position, n + 1, sizeof *packing->position);
    packing->radius = reallocate(packing->radius, n + 1, sizeof *packing->radius);
    packing->position[n] = (struct vector){
        0, 0, ball_height - ball_speed * start - 0.5 * gravity * start * start};
    packing->radius[n] = ball_radius;
    packing->lower = box_lower;
    packing->upper = box_upper;
}

static struct dem_material material(double density, double young_modulus)
{
    // Friction and restitution are those of pairs.
    return (struct dem_material){.density = density,
                                 .young_modulus = young_modulus,
                                 .poisson_ratio = 0.2,
                                 .friction = 0,
                                 .restitution = 1};
}

// Five faces, all but the top, of steel.
static void make_walls(struct dem_wall wall[5])
{
    for (int w = 0; w < 5; w++) {
        const bool upper = w % 2;
        wall[w] = (struct dem_wall){
            .point = upper ? box_upper : box_lower, .elastic = true, .material = 1};
        set_component(&wall[w].normal, w / 2, upper ? -1 : 1);
    }
}

static struct dem *build(const struct packing *packing, const struct beads *beads,
                         int threads, double time_step)
{
    const struct dem_material steel = material(7200, 210e9);
    struct dem_wall wall[5];
    make_walls(wall);
    uint8_t *material_of = NEW_ARRAY(uint8_t, packing->n_particle);
    material_of[packing->n_particle - 1] = 1;
    const double friction[4] = {beads->friction, steel_friction[0], steel_friction[0],
                                steel_friction[1]};
    const double restitution[4] = {beads->restitution, steel_restitution[0],
                                   steel_restitution[0], steel_restitution[1]};
    const struct dem_setup setup = {.packing = packing,
                                    .law = DEM_HERTZ,
                                    .material =
                                        material(beads->density, beads->young_modulus),
                                    .n_other = 1,
                                    .other = &steel,
                                    .material_of = material_of,
                                    .pair_friction = friction,
                                    .pair_restitution = restitution,
                                    .n_wall = 5,
                                    .wall = wall,
                                    .gravity = {0, 0, -gravity},
                                    .time_step = time_step,
                                    .largest_overlap = 0.05,
                                    .friction_feels_dashpot = true,
                                    .threads = threads};
    struct dem *dem;
    struct reason reason;
    const enum status status = dem_create(&dem, &setup, &reason);
    if (status != STATUS_OK) die(status, "%s", reason.text);
    free(material_of);
    return dem;
}

static void shoot(struct dem *dem, int n, double start)
{
    struct vector *velocity = NEW_ARRAY(struct vector, n);
    velocity[n - 1].z = -ball_speed - gravity * start;
    dem_set_velocity(dem, velocity, NULL);
    free(velocity);
}

static double time_of(const struct dem *dem, double start)
{
    return start + (double)dem_cycle(dem) * dem_time_step(dem);
}

static void print_ball(const struct dem *dem, int n, double start,
                       struct vector *scratch)
{
    dem_positions(dem, scratch);
    const double height = scratch[n - 1].z;
    dem_velocities(dem, scratch);
    printf("%.4f %.7f %.5f\n", time_of(dem, start), height, scratch[n - 1].z);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 7)
        die(STATUS_USAGE,
            "penetration_study BED.h5 M1|M2 [SECONDS [THREADS [TIME_STEP [START]]]]");
    const struct beads *beads = beads_of(argv[2]);
    const double seconds = argc > 3 ? atof(argv[3]) : 0.1;
    const double time_step = argc > 5 ? atof(argv[5]) : 5e-7; // s, as the benchmark's
    const double start = argc > 6 ? atof(argv[6]) : 0;
    struct packing packing = read_bed(argv[1]);
    printf("# %d beads of %s, solid fraction %.4f\n", packing.n_particle, beads->name,
           solid_fraction(&packing));
    add_ball(&packing, start);
    const int n = packing.n_particle;
    struct dem *dem = build(&packing, beads, argc > 4 ? atoi(argv[4]) : 1, time_step);
    shoot(dem, n, start);
    printf("# stable below %.3g s\n# time (s), height of the ball (m), velocity "
           "(m/s)\n",
           dem_time_step_limit(dem));

    const int64_t between = llround(5e-4 / time_step);
    struct vector *scratch = NEW_ARRAY(struct vector, n);
    struct reason reason;
    print_ball(dem, n, start, scratch);
    while (dem_cycle(dem) < llround((seconds - start) / time_step)) {
        const enum status status = dem_run(dem, between, &reason);
        if (status != STATUS_OK) die(status, "%s", reason.text);
        print_ball(dem, n, start, scratch);
    }
    free(scratch);
    dem_free(dem);
    packing_free(&packing);
    return 0;
}
