// SPDX-License-Identifier: GPL-3.0-or-later
// The times of the protocol, and what is said of its forces: grains whose forces go
// through given values, beside all moments looked at one by one.
#include "../../random.h"
#include "../../test.h"
#include "force-protocol/times.h"
#include "force_rows.h"

#include <stdlib.h>
#include <string.h>

static void assert_same(double got, double wanted)
{
    assert_within(got, wanted, 1e-12 * fmax(1, fabs(wanted)));
}

// ---- scenes -------------------------------------------------------------------------

enum { GRAINS = 2, MOST_STEPS = 8 };

// At the steps of a drying two grains feel the forces given, the last of them 0: throat
// K empties in step K, and pulls with what goes with it.
struct scene {
    struct network network;
    struct liquid_record record;
    struct suction_law law;
    struct throat_loads loads;
};

static struct process process_of(const struct scene *scene)
{
    return (struct process){&scene->network, &scene->record, &scene->law,
                            &scene->loads};
}

static void scene_free(struct scene *scene)
{
    network_free(&scene->network);
    drying_record_free(&scene->record.drying);
    free(scene->record.exposed);
    throat_loads_free(&scene->loads);
}

static struct scene forces_through(int n_step, const struct vector (*force)[GRAINS])
{
    const int n = n_step - 1;
    struct scene scene = {
        .network = {.packing = {.n_particle = GRAINS,
                                .position = NEW_ARRAY(struct vector, GRAINS)},
                    .n_node = n_step,
                    .n_throat = n,
                    .throat_nodes = allocate((size_t)n, sizeof(int32_t[2])),
                    .throat_radius = NEW_ARRAY(double, n),
                    .throat_kind = NEW_ARRAY(uint8_t, n)},
        .record = {.drying = {.n_step = n_step,
                              .time = NEW_ARRAY(double, n_step),
                              .saturation = NEW_ARRAY(double, n_step),
                              .offset = NEW_ARRAY(int64_t, n_step + 1),
                              .throat = NEW_ARRAY(int32_t, n),
                              .throat_saturation = NEW_ARRAY(double, n)},
                   .exposed = NEW_ARRAY(bool, n_step)},
        .law = {.rule = SUCTION_UNIFORM, .uniform = 1, .meniscus = 1},
        .loads = {.scale = 1}};
    struct drying_record *drying = &scene.record.drying;
    for (int k = 0; k < n; k++) {
        scene.network.throat_nodes[k][0] = k;
        scene.network.throat_nodes[k][1] = k + 1;
        scene.network.throat_radius[k] = 1;
        drying->time[k + 1] = k + 1;
        drying->offset[k + 2] = k + 1;
        drying->throat[k] = k;
        for (int i = 0; i < GRAINS; i++) {
            const struct vector change = subtract(force[k][i], force[k + 1][i]);
            if (norm(change) > 0)
                patches_add(&scene.loads.patches[LOAD_SUCTION], k, i, change);
        }
    }
    patches_sort(&scene.loads.patches[LOAD_SUCTION], GRAINS);
    return scene;
}

// ---- times --------------------------------------------------------------------------

TEST(even_times_end_with_the_drying)
{
    double end[] = {0, 0.7};
    const struct drying_record record = {.n_step = 2, .time = end};
    for (int count = 2; count < 1000; count++) {
        double *time = uniform_times(&record, count);
        assert_true(time[0] == 0 && time[count - 1] == end[1]);
        free(time);
    }
}

// Along x, the forces of both grains step by step, when, and the times that it takes
// for none to change by more than BOUND of the largest.
static const struct row {
    double bound;
    int n_step;
    double force[MOST_STEPS][GRAINS], when[MOST_STEPS];
    int count;
    double time[MOST_STEPS];
} rows[] = {
    // The largest force comes later. As much as the bound is not more than it.
    {0.5, 3, {{0}, {4}, {0}}, {0, 1, 2}, 5, {0, 0.5, 1, 1.5, 2}},
    {0.5, 5, {{0}, {2}, {4}, {2}, {0}}, {0, 1, 2, 3, 4}, 3, {0, 1, 4}},
    // The second grain alone; less and less.
    {0.6, 4, {{0}, {0, 2}, {0, 0.4}, {0}}, {0, 1, 2, 6}, 6, {0, 0.5, 1, 1.5, 2, 6}},
    // A time is one of all grains, also of those that the last step does not move.
    {0.67, 5, {{0}, {1, 1}, {2, 1}, {2, 1.8}, {0}}, {0, 1, 2, 3, 4}, 3, {0, 1, 4}},
    // What changes at once is one change.
    {0.25, 4, {{0}, {0}, {4}, {0}}, {0, 1, 1, 2}, 6, {0, 1, 1.25, 1.5, 1.75, 2}},
};
enum { N_ROW = sizeof rows / sizeof *rows };

static struct scene scene_of(const struct row *row)
{
    struct vector force[MOST_STEPS][GRAINS] = {0};
    for (int m = 0; m < row->n_step; m++)
        for (int i = 0; i < GRAINS; i++)
            force[m][i].x = row->force[m][i];
    struct scene scene = forces_through(row->n_step, force);
    memcpy(scene.record.drying.time, row->when,
           (size_t)row->n_step * sizeof *row->when);
    return scene;
}

// In whatever unit forces are, and however many times are allowed.
TEST(as_few_times_as_it_takes)
{
    for (int r = 0; r < N_ROW; r++) {
        struct scene scene = scene_of(&rows[r]);
        const struct process process = process_of(&scene);
        for (int unit = -60; unit <= 60; unit += 60)
            for (int most = 0; most <= rows[r].count; most++) {
                double count;
                scene.loads.scale = ldexp(1, unit);
                double *time = adaptive_times(&process, rows[r].bound, most, &count);
                assert_same(count, rows[r].count);
                assert_int_equal(time != NULL, most == rows[r].count);
                for (int m = 0; time && m < rows[r].count; m++)
                    assert_same(time[m], rows[r].time[m]);
                free(time);
            }
        scene_free(&scene);
    }
}

// ---- what is said of forces ---------------------------------------------------------

// Of the forces of three times.
static struct measures measures_of(const struct packing *packing,
                                   const struct vector *all)
{
    struct measures measures = {0};
    for (int m = 0; m < 3; m++)
        measure_forces(&measures, packing, all + (ptrdiff_t)m * GRAINS,
                       m > 0 ? all + (ptrdiff_t)(m - 1) * GRAINS : NULL);
    return measures;
}

// One force among nothing, on any grain at any of three times and however small.
TEST(one_force_is_found_wherever_it_is)
{
    const struct vector pull = {0, 3e-30, 4e-30};
    struct vector position[GRAINS] = {{2, 1, 1}, {1, 3, 1}}, all[3 * GRAINS] = {0};
    const struct packing packing = {
        .n_particle = GRAINS, .position = position, .upper = {2, 2, 2}};
    for (int k = 0; k < 3 * GRAINS; k++) {
        all[k] = pull;
        const struct measures found = measures_of(&packing, all);
        assert_close(found.force, 5e-30, 1e-15);
        assert_close(found.change, 5e-30, 1e-15);
        assert_same(net_force(&found), 1);
        // At a right angle only to x.
        assert_same(net_moment(&found, &packing), k % GRAINS ? 0.8 : 1);
        all[k] = (struct vector){0};
    }
    const struct measures none = measures_of(&packing, all);
    assert_true(net_force(&none) == 0 && net_moment(&none, &packing) == 0);
    assert_true(none.force == 0 && none.change == 0);
}

// Half of the forces do not change in a step.
static struct scene random_scene(uint64_t *seed)
{
    struct vector force[MOST_STEPS][GRAINS] = {0};
    for (int m = 0; m + 1 < MOST_STEPS; m++)
        for (int i = 0; i < GRAINS; i++)
            if (m > 0 && next_random(seed) < 0.5)
                force[m][i] = force[m - 1][i];
            else
                force[m][i] = (struct vector){next_random(seed), next_random(seed), 0};
    struct scene scene = forces_through(MOST_STEPS, force);
    for (int m = 1; m < MOST_STEPS; m++)
        scene.record.drying.time[m] =
            scene.record.drying.time[m - 1] + 0.1 + next_random(seed);
    return scene;
}

// By how much FORCE at TIME is missed between the times of the protocol around it.
static double missed(const struct protocol *protocol, const struct vector *all,
                     double time, const struct vector *force)
{
    int m = 1;
    while (m + 1 < protocol->n_time && protocol->time[m] <= time)
        m++;
    const double before = protocol->time[m - 1], after = protocol->time[m];
    const double share = (time - before) / (after - before);
    double most = 0;
    for (int i = 0; i < GRAINS; i++) {
        const struct vector from = all[(m - 1) * GRAINS + i];
        const struct vector to = all[m * GRAINS + i];
        const struct vector between = add(scale(1 - share, from), scale(share, to));
        most = fmax(most, distance(force[i], between));
    }
    return most;
}

// Of all grains, at the beginning and at the end of all steps.
static double most_missed(const struct process *process,
                          const struct protocol *protocol, const struct vector *all)
{
    const struct drying_record *drying = &process->record->drying;
    struct liquid_loads liquid =
        liquid_loads_begin(process->network, process->record, process->law);
    struct vector force[GRAINS];
    double most = 0;
    for (int step = 0; step + 1 < drying->n_step; step++) {
        if (step > 0) liquid_loads_advance(&liquid);
        forces_now(process->loads, &liquid, force);
        most = fmax(most, missed(protocol, all, drying->time[step], force));
        liquid_loads_to_end_of_step(&liquid);
        forces_now(process->loads, &liquid, force);
        most = fmax(most, missed(protocol, all, drying->time[step + 1], force));
    }
    liquid_loads_free(&liquid);
    return most;
}

static void check_error(const struct scene *scene)
{
    const struct process process = process_of(scene);
    const struct drying_record *drying = &scene->record.drying;
    for (int count = 2; count < 20; count++) {
        double *time = uniform_times(drying, count);
        struct vector *all;
        struct protocol protocol = whole_protocol(&process, time, count, &all);
        assert_same(protocol.interpolation.worst,
                    most_missed(&process, &protocol, all));
        protocol_free(&protocol);
        free(all);
        free(time);
    }
}

// Where all bends, with contact lines, which jump, and where all of a field changes
// that bends at every step and does not jump.
TEST(what_is_interpolated_misses_as_much_as_said)
{
    uint64_t seed = 1;
    for (int trial = 0; trial < 20; trial++) {
        struct scene scene = random_scene(&seed);
        check_error(&scene);
        scene.law.contact_line = 0.1 * trial;
        struct patches *lines = &scene.loads.patches[LOAD_CONTACT_LINE];
        for (int t = 0; t < scene.network.n_throat; t += 2)
            patches_add(lines, t, t % GRAINS,
                        (struct vector){next_random(&seed), 0, 0});
        patches_sort(lines, GRAINS);
        check_error(&scene);

        patches_free(lines);
        double time = 0, pressure[MOST_STEPS];
        for (int i = 0; i < MOST_STEPS; i++)
            pressure[i] = -1 - next_random(&seed);
        scene.law.rule = SUCTION_FIELD;
        scene.record.n_snapshot = 1;
        scene.record.snapshot_time = &time;
        scene.record.pressure = pressure;
        check_error(&scene);
        scene_free(&scene);
    }
}
