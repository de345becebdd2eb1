// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the discrete elements go, and against what: particle-steps a second on
// bonded lattices, beside the arithmetic and the memory of the same core in the same
// run. Ratios mean something, absolute figures drift with the machine.
//
//     bench_dem [THREADS]               the table
//     bench_dem --lattice NX NY NZ      particle-steps a second of one lattice
//     bench_dem --packing FILE KIND THREADS
//                                       of grains at rest, read from FILE: lines x y z
//                                       r and a comment "# box LX LY LZ periodic"; KIND
//                                       is smooth, grip, hertz, bonded, wet,
//                                       wet-exact, rolling (grip that resists
//                                       it), walled (grip between six planes), or
//                                       driven: grip with a layer of a sixth of the
//                                       grains in a group that turns
#include "basics/memory.h"
#include "basics/progress.h"
#include "dem/engine.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Counted from pair_*.h and grains.c: operations, a fused one as two, and the
// bytes that stream through, written ones twice. What a pair reads of its grains and
// adds to their sums (2 x 224 bytes) stays in a cache near by and is not among them.
// Every pair takes a root and a quotient (parallel bonds: neither; Hertz: four roots
// and a quotient more), counted as one operation each. Half of the instructions of the
// pair sweep are not arithmetic but fetch records and bring them from rows into lanes
// and back, so no kind can come near the peak.
struct cost {
    double flops, bytes;
};
static const struct cost bonded_pair = {299, 56 + 24 + 2 * 80};
static const struct cost gripping_pair = {165, 48 + 2 * 24};
static const struct cost hertz_pair = {165 + 14, 48 + 2 * 24};
static const struct cost smooth_pair = {51, 48};
static const struct cost turning_grain = {35, 1 + 2 * 160};
static const struct cost smooth_grain = {18, 1 + 2 * 96};

static struct cost cost_of_step(const struct dem *dem)
{
    const unsigned features = dem->features;
    const struct cost pair = features & FEATURE_PARALLEL_BOND ? bonded_pair
                             : !(features & FEATURE_ROTATION) ? smooth_pair
                             : features & FEATURE_HERTZ       ? hertz_pair
                                                              : gripping_pair;
    const struct cost grain =
        features & FEATURE_ROTATION ? turning_grain : smooth_grain;
    const double pairs = (double)dem->pairs.n_pair / dem->n_particle;
    const double as_needed = (dem->has_external ? 32 : 0) +
                             (dem->equal_mobility ? 0 : 16) +
                             (dem->n_wall_pair > 0 ? 4 : 0);
    return (struct cost){grain.flops + pairs * pair.flops,
                         grain.bytes + as_needed + pairs * pair.bytes};
}

static struct packing cubic_lattice(int nx, int ny, int nz)
{
    const int n = nx * ny * nz, count[3] = {nx, ny, nz}, stride[3] = {1, nx, nx * ny};
    struct packing packing = {.n_particle = n};
    packing.position = NEW_ARRAY(struct vector, n);
    packing.radius = NEW_ARRAY(double, n);
    packing.bond = allocate(3 * (size_t)n, sizeof *packing.bond);
    for (int i = 0; i < n; i++) {
        const int at[3] = {i % nx, i / nx % ny, i / (nx * ny)};
        packing.radius[i] = 250e-9;
        packing.position[i] = (struct vector){5e-7 * at[0], 5e-7 * at[1], 5e-7 * at[2]};
        for (int axis = 0; axis < 3; axis++) {
            if (at[axis] == count[axis] - 1) continue;
            packing.bond[packing.n_bond][0] = i;
            packing.bond[packing.n_bond++][1] = i + stride[axis];
        }
    }
    return packing;
}

static struct dem *build(const struct packing *packing, int threads)
{
    const struct dem_setup setup = {.packing = packing,
                                    .material = {3230, 3e4, 3e4, 0.5, 0.7},
                                    .bond = {8e14, 8e14, INFINITY, INFINITY, 0.5858},
                                    .time_step_safety = 0.04,
                                    .threads = threads};
    struct dem *dem;
    struct reason reason;
    if (dem_create(&dem, &setup, &reason) != STATUS_OK)
        die(STATUS_INTERNAL, "%s", reason.text);
    struct vector *force = NEW_ARRAY(struct vector, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        force[i] =
            (struct vector){1e-10 * sin(i), 1e-10 * sin(1.7 * i), 1e-10 * cos(2.3 * i)};
    dem_set_force(dem, force);
    free(force);
    return dem;
}

// Particle-steps a second, the best of so many TURNS.
static double particle_steps(struct dem *dem, int turns)
{
    struct reason reason;
    const int cycles = 1 + 4000000 / dem->n_particle;
    double best = 0;
    for (int k = 0; k < turns; k++) {
        const double start = seconds_now();
        if (dem_run(dem, cycles, &reason) != STATUS_OK)
            die(STATUS_INTERNAL, "%s", reason.text);
        best = fmax(best, (double)cycles * dem->n_particle / (seconds_now() - start));
    }
    return best;
}

typedef double narrow __attribute__((vector_size(32)));
typedef double wide __attribute__((vector_size(64)));

// a*x + b on 12 chains that stay in registers: as two operations, as the kernel must,
// and fused.
#define EACH(step)                                                                     \
    step(0) step(1) step(2) step(3) step(4) step(5) step(6) step(7) step(8) step(9)    \
        step(10) step(11)
#define BEGIN(k) vector x##k = {(k)};
#define APART(k)                                                                       \
    x##k = x##k * a + b;                                                               \
    __asm__ volatile("" : "+v"(x##k));
#define FUSED(k)                                                                       \
    __asm__ volatile("vfmadd132pd %1, %2, %0" : "+v"(x##k) : "v"(a), "v"(b));
#define PEAK(name, type, step)                                                         \
    static double name(void)                                                           \
    {                                                                                  \
        typedef type vector;                                                           \
        const vector a = (vector){0} + 0.999999, b = (vector){0} + 1e-9;               \
        EACH(BEGIN)                                                                    \
        const int turns = 10000000;                                                    \
        const double start = seconds_now();                                            \
        for (int i = 0; i < turns; i++) {                                              \
            EACH(step)                                                                 \
        }                                                                              \
        return 12.0 * 2 * turns * (sizeof(vector) / 8) / (seconds_now() - start);      \
    }

PEAK(peak_narrow, narrow, APART)
PEAK(peak_narrow_fused, narrow, FUSED)
#pragma GCC push_options
#pragma GCC target("avx512f")
PEAK(peak_wide, wide, APART)
PEAK(peak_wide_fused, wide, FUSED)
#pragma GCC pop_options

// Bytes a second of a = b + s c over arrays of BYTES in all.
static double triad(size_t bytes)
{
    const size_t n = bytes / 3 / sizeof(double);
    double *a = NEW_ARRAY(double, n), *b = NEW_ARRAY(double, n);
    double *c = NEW_ARRAY(double, n), best = 0;
    for (size_t k = 0; k < n; k++)
        b[k] = c[k] = (double)k;
    const int turns = (int)(1 + (size_t)400000000 / bytes);
    for (int again = 0; again < 5; again++) {
        const double start = seconds_now();
        for (int i = 0; i < turns; i++) {
            for (size_t k = 0; k < n; k++)
                a[k] = b[k] + 3.0 * c[k];
            __asm__ volatile("" ::"r"(a) : "memory");
        }
        best = fmax(best, (double)turns * (double)n * 24 / (seconds_now() - start));
    }
    free(a);
    free(b);
    free(c);
    return best;
}

// With the instructions that dem_create chose, after a tenth of the run to warm up.
static int one_lattice(int nx, int ny, int nz)
{
    struct packing packing = cubic_lattice(nx, ny, nz);
    struct dem *dem = build(&packing, 1);
    struct reason reason;
    if (dem_run(dem, 400000 / dem->n_particle, &reason) != STATUS_OK)
        die(STATUS_INTERNAL, "%s", reason.text);
    printf("%.0f\n", particle_steps(dem, 1));
    dem_free(dem);
    packing_free(&packing);
    return 0;
}

static struct packing read_packing(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) die(STATUS_NO_INPUT, "%s: cannot open", path);
    struct packing packing = {.periodic = {1, 1, 1}};
    char line[256];
    int capacity = 0;
    struct vector upper = {0, 0, 0};
    while (fgets(line, sizeof line, file)) {
        struct vector x;
        double radius;
        if (sscanf(line, "# box %lf %lf %lf", &upper.x, &upper.y, &upper.z) == 3)
            packing.upper = upper;
        if (sscanf(line, "%lf %lf %lf %lf", &x.x, &x.y, &x.z, &radius) != 4) continue;
        const int room = capacity;
        GROW_ARRAY(packing.position, packing.n_particle, capacity);
        if (capacity != room)
            packing.radius =
                reallocate(packing.radius, (size_t)capacity, sizeof(double));
        packing.position[packing.n_particle] = x;
        packing.radius[packing.n_particle++] = radius;
    }
    fclose(file);
    return packing;
}

// The pair stiffness 1e4 N/m, density, friction, damping and time step of
// tests/bench/dem.
static struct dem_setup at_rest(const struct packing *packing, const char *kind,
                                int threads)
{
    const bool smooth = strcmp(kind, "smooth") == 0;
    return (struct dem_setup){
        .packing = packing,
        .law = strcmp(kind, "hertz") == 0 || strncmp(kind, "wet", 3) == 0 ? DEM_HERTZ
                                                                          : DEM_LINEAR,
        .material = {.density = 2500,
                     .normal_stiffness = 2e4,
                     .shear_stiffness = 2e4 * 2 / 7,
                     .friction = smooth ? 0 : 0.5,
                     .damping_ratio = 0.2,
                     .young_modulus = 2.88e8,
                     .poisson_ratio = 0.25,
                     .restitution = 0.5},
        .bond = {.normal_stiffness = 1e9,
                 .shear_stiffness = 1e9,
                 .normal_strength = INFINITY,
                 .shear_strength = INFINITY,
                 .radius_fraction = 0.5},
        .time_step = 4.85e-6,
        .force_time_step = true,
        .threads = threads};
}

// For some seconds after a tenth of that to warm up.
static int one_packing(const char *path, const char *kind, int threads)
{
    struct packing packing = read_packing(path);
    if (strcmp(kind, "bonded") == 0)
        packing.bond = neighbour_pairs(&packing, 0, &packing.n_bond);
    struct dem_setup setup = at_rest(&packing, kind, threads);
    const bool exact = strcmp(kind, "wet-exact") == 0;
    const struct dem_liquid liquid = {.model =
                                          exact ? BRIDGE_TABLE : BRIDGE_WILLETT_FULL,
                                      .surface_tension = 0.0728,
                                      .volume = 1e-12, // 1e-3 of the radius cubed
                                      .pulls_in_contact = true};
    if (exact || strcmp(kind, "wet") == 0) setup.liquid = &liquid;
    uint8_t *group_of = NEW_ARRAY(uint8_t, packing.n_particle);
    for (int i = 0; i < packing.n_particle; i++)
        group_of[i] = packing.position[i].z < packing.upper.z / 6;
    const struct dem_group group = {
        .point = scale(0.5, packing.upper), .axis = {0, 0, 1}, .spin = 1e-6};
    if (strcmp(kind, "rolling") == 0) setup.material.rolling_friction = 0.1;
    if (strcmp(kind, "driven") == 0) {
        setup.n_group = 1;
        setup.group = &group;
        setup.group_of = group_of;
    }
    struct dem_wall wall[6];
    for (int w = 0; w < 6; w++) {
        wall[w] = (struct dem_wall){.point = w % 2 ? packing.upper : packing.lower};
        set_component(&wall[w].normal, w / 2, w % 2 ? -1 : 1);
    }
    if (strcmp(kind, "walled") == 0) {
        setup.n_wall = 6;
        setup.wall = wall;
        setup.unstressed = true;
        memset(packing.periodic, 0, sizeof packing.periodic);
    }
    struct dem *dem;
    struct reason reason;
    if (dem_create(&dem, &setup, &reason) != STATUS_OK)
        die(STATUS_INTERNAL, "%s", reason.text);
    free(group_of);
    const double rough = 12e6 * threads;
    const int64_t cycles = 1 + (int64_t)(3 * rough / dem->n_particle);
    if (dem_run(dem, 1 + cycles / 10, &reason) != STATUS_OK)
        die(STATUS_INTERNAL, "%s", reason.text);
    const double start = seconds_now();
    if (dem_run(dem, cycles, &reason) != STATUS_OK)
        die(STATUS_INTERNAL, "%s", reason.text);
    const double rate = (double)cycles * dem->n_particle / (seconds_now() - start);
    const struct cost step = cost_of_step(dem);
    printf("%.0f particle-steps/s, %.2f pairs a grain, %.1f Gflop/s, %.1f GB/s\n", rate,
           (double)dem->pairs.n_pair / dem->n_particle, 1e-9 * rate * step.flops,
           1e-9 * rate * step.bytes);
    dem_free(dem);
    packing_free(&packing);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 5 && strcmp(argv[1], "--lattice") == 0)
        return one_lattice(atoi(argv[2]), atoi(argv[3]), atoi(argv[4]));
    if (argc == 5 && strcmp(argv[1], "--packing") == 0)
        return one_packing(argv[2], argv[3], atoi(argv[4]));
    const int threads = argc > 1 ? atoi(argv[1]) : 1;
    const bool has_wide = __builtin_cpu_supports("avx512f");
    printf("triad: %.0f GB/s at 300 kB, %.0f at 1 MB, %.0f at 8 MB, %.0f at 300 MB\n",
           triad(300000) / 1e9, triad(1000000) / 1e9, triad(8000000) / 1e9,
           triad(300000000) / 1e9);
    const double peak[2] = {peak_narrow(), has_wide ? peak_wide() : 0};
    printf("multiply and add: %.0f Gflop/s 4 wide (fused %.0f)", peak[0] / 1e9,
           peak_narrow_fused() / 1e9);
    if (has_wide)
        printf(", %.0f Gflop/s 8 wide (fused %.0f)", peak[1] / 1e9,
               peak_wide_fused() / 1e9);
    printf("\n\n%-10s %8s %8s %5s %10s %9s %9s %9s %9s\n", "lattice", "grains", "pairs",
           "width", "Mpsteps/s", "flop/step", "B/step", "of flops", "GB/s");

    const int size[3][3] = {{5, 5, 10}, {10, 10, 20}, {40, 40, 80}};
    for (int s = 0; s < 3; s++) {
        struct packing packing = cubic_lattice(size[s][0], size[s][1], size[s][2]);
        for (int w = 0; w < 1 + has_wide; w++) {
            struct dem *dem = build(&packing, threads);
            dem->sweep = (w ? pair_sweeps_avx512 : pair_sweeps_avx2)[dem->features];
            const double rate = particle_steps(dem, 5);
            const struct cost step = cost_of_step(dem);
            char name[32];
            snprintf(name, sizeof name, "%dx%dx%d", size[s][0], size[s][1], size[s][2]);
            printf("%-10s %8d %8d %5d %10.2f %9.0f %9.0f %8.0f%% %9.1f\n", name,
                   dem->n_particle, dem->pairs.n_pair, w ? 8 : 4, rate / 1e6,
                   step.flops, step.bytes,
                   100 * step.flops * rate / (threads * peak[w]),
                   step.bytes * rate / 1e9);
            dem_free(dem);
        }
        packing_free(&packing);
    }
    return 0;
}
