// SPDX-License-Identifier: GPL-3.0-or-later
// What crackstats counts in runs made by hand: facts, classes and sums over runs, the
// liquid of slices over time, and the correlation with it by its definition.
#include "crack_lattice.h"
#include "crackstats/ensemble.h"

#include <gsl/gsl_rng.h>

static const struct classes classes = {.n_slice = 4, .n_interval = 2};

// Two columns of four grains. One shear crack between the lowest layers in the first
// period, two normal ones above it and a shear one beside it in the second, which leave
// the last grain of a column alone; the body shrinks along z by a tenth and comes
// halfway back.
static struct run broken_columns(void)
{
    struct run run = lattice(2, 1, 4, false);
    static const int pair[4][2] = {{0, 2}, {2, 4}, {4, 6}, {6, 7}};
    for (int k = 0; k < 4; k++) {
        crack(&run, bond_between(&run, pair[k][0], pair[k][1]));
        run.time[k] = 1 + k;
        run.saturation[k] = 0.8 - 0.2 * k;
        run.mode[k] = k % 3 == 0 ? MODE_SHEAR : MODE_NORMAL;
    }
    run.first_period_end = 1;
    run.end = 5;
    run.n_snapshot = 2;
    run.snapshot_saturation = NEW_ARRAY(double, 2);
    run.snapshot_saturation[0] = 0.5;
    run.displacement = NEW_ARRAY(struct vector, 2 * 8);
    for (int i = 0; i < 16; i++)
        run.displacement[i].z = (i < 8 ? -0.1 : -0.05) * run.packing.position[i % 8].z;
    run.intact = NEW_ARRAY(uint8_t, 2 * run.packing.n_bond);
    memset(run.intact, 1, 2 * (size_t)run.packing.n_bond);
    return run;
}

static void assert_facts(const struct ensemble *study, int of)
{
    static const struct {
        enum statistic fact;
        double wanted;
    } row[] = {{CRACKS_NORMAL, 2},     {CRACKS_SHEAR, 2},     {CRACKS_TOTAL, 4},
               {CRACKS_SHARE, 0.4},    {FIRST_NORMAL, 0},     {FIRST_SHEAR, 1},
               {FIRST_TOTAL, 1},       {SECOND_NORMAL, 2},    {SECOND_SHEAR, 1},
               {SECOND_TOTAL, 3},      {CLUSTERS_COUNT, 1},   {CLUSTERS_LARGEST, 4},
               {CLUSTERS_SPAN_Z, 1},   {FRAGMENTS_BEFORE, 1}, {FRAGMENTS_COUNT, 2},
               {FRAGMENTS_LARGEST, 7}, {FRAGMENTS_SINGLE, 1}, {SHRINKAGE_LARGEST, 0.1},
               {SHRINKAGE_LAST, 0.05}, {SPRING_BACK, 0.5}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        assert_within(study->statistics[of].value[row[k].fact], row[k].wanted, 1e-12);
    assert_true(isnan(study->statistics[of].value[FRONT_SATURATION]));
}

TEST(facts_and_sums_of_two_runs)
{
    struct run run = broken_columns();
    struct ensemble study = ensemble_init(2, classes, false);
    for (int k = 0; k < 2; k++) {
        ensemble_add(&study, &run, NULL);
        assert_facts(&study, k);
    }
    assert_within(study.bonds, 20, 0);
    assert_within(study.deformation[0].shrinkage, 0.2, 1e-12);
    assert_within(study.deformation[1].shrinkage, 0.1, 1e-12);
    assert_within(study.deformation[1].strain[2], -0.1, 1e-12);
    assert_within(study.snapshot_saturation[0], 1, 1e-15);
    // Middles of upright bonds lie on the borders of slices, half in each.
    static const double slice[4][MODE_COUNT] = {{0, 1}, {1, 1}, {2, 0}, {1, 2}};
    for (int s = 0; s < 4; s++)
        for (int mode = 0; mode < MODE_COUNT; mode++)
            assert_within(study.counts.slice[s][mode], slice[s][mode], 0);
    for (int half = 0; half < 2; half++) {
        assert_within(study.counts.saturation[half][MODE_NORMAL], 2, 0);
        assert_within(study.counts.time[half][MODE_NORMAL], 2, 0);
    }
    static const double place[2][4] = {{1, 2, 1, 0}, {0, 0, 1, 3}};
    for (int half = 0; half < 2; half++)
        for (int s = 0; s < 4; s++)
            assert_within(study.counts.place[half * 4 + s], place[half][s], 0);
    ensemble_free(&study);
    run_free(&run);
}

// The same body, standing on its head.
static void turn_over(struct run *run)
{
    struct packing *packing = &run->packing;
    for (int i = 0; i < packing->n_particle; i++)
        packing->position[i].z =
            packing->lower.z + packing->upper.z - packing->position[i].z;
}

// Whether slices begin and end with layers or cut through them.
TEST(profile_upside_down)
{
    for (int n_slice = 1; n_slice <= 9; n_slice++) {
        const struct classes of = {.n_slice = n_slice, .n_interval = 2};
        struct run run = broken_columns();
        struct counts up = counts_init(of), down = counts_init(of);
        count_cracks(&up, &run, of);
        turn_over(&run);
        count_cracks(&down, &run, of);
        for (int s = 0; s < n_slice; s++)
            for (int mode = 0; mode < MODE_COUNT; mode++)
                assert_within(down.slice[n_slice - 1 - s][mode], up.slice[s][mode], 0);
        counts_free(&up);
        counts_free(&down);
        run_free(&run);
    }
}

// Grains that left the box count at its ends.
TEST(classes_end)
{
    static const double share[] = {-1, 0, 0.24, 0.25, 0.26, 1, 1.5};
    static const int class[] = {0, 0, 0, 0, 1, 3, 3};
    for (int k = 0; k < 7; k++)
        assert_int_equal(class_of(share[k], 4), class[k]);
}

// ---- liquid -------------------------------------------------------------------------

// A column of four throats, full at time 0, that empty one after the other from the top
// in a unit of time each; the last one never does. The network's saturation is that of
// equal volumes.
static struct liquid column(void)
{
    const struct run run = lattice(1, 1, 4, false);
    struct liquid liquid = {.network = {.packing = run.packing,
                                        .n_node = 5,
                                        .node_position = NEW_ARRAY(struct vector, 5),
                                        .n_throat = 4,
                                        .throat_nodes = allocate(4, sizeof(int32_t[2])),
                                        .throat_volume = NEW_ARRAY(double, 4),
                                        .throat_kind = NEW_ARRAY(uint8_t, 4)},
                            .record = {.n_step = 4,
                                       .time = NEW_ARRAY(double, 4),
                                       .saturation = NEW_ARRAY(double, 4),
                                       .offset = NEW_ARRAY(int64_t, 5),
                                       .throat = NEW_ARRAY(int32_t, 4),
                                       .throat_saturation = NEW_ARRAY(double, 4)}};
    for (int k = 0; k < 5; k++)
        liquid.network.node_position[k] = add(corner, (struct vector){0.5, 0.5, k});
    for (int k = 0; k < 4; k++) {
        liquid.network.throat_nodes[k][0] = k;
        liquid.network.throat_nodes[k][1] = k + 1;
        liquid.network.throat_volume[k] = 2;
        liquid.record.time[k] = k;
        liquid.record.saturation[k] = 1 - 0.25 * k;
        liquid.record.offset[k + 1] = k; // nothing changes in step 0
        liquid.record.throat[k] = 4 - k - 1;
    }
    free(run.bond);
    free(run.mode);
    free(run.time);
    free(run.saturation);
    return liquid;
}

TEST(slices_over_time)
{
    struct liquid liquid = column();
    // Twice the same time, and later than the last step.
    static const double time[] = {0, 0.25, 1.5, 1.5, 2, 3, 7};
    double *found = slice_saturations(&liquid, 4, time, 7);
    for (int m = 0; m < 7; m++)
        for (int s = 0; s < 4; s++) {
            const double left = s == 0 ? 1 : 1 - (time[m] - (3 - s));
            assert_within(found[4 * m + s], fmin(1, fmax(0, left)), 1e-15);
        }
    free(found);
    found = slice_saturations(&liquid, 5, time, 1); // one slice has no throat's middle
    int n_nowhere = 0;
    for (int s = 0; s < 5; s++)
        n_nowhere += isnan(found[s]);
    assert_int_equal(n_nowhere, 1);
    free(found);
    static const double level[] = {2, 1, 0.9, 0.5, 0.25, 0.1};
    static const double when[] = {0, 0, 0.4, 2, 3, 3};
    for (int k = 0; k < 6; k++)
        assert_within(time_of_saturation(&liquid, level[k]), when[k], 1e-15);
    liquid_free(&liquid);
}

// Cracks on the border of a slice that is emptying and of one that is dry.
TEST(cracks_beside_their_liquid)
{
    struct liquid liquid = column();
    struct run run = lattice(1, 1, 4, false);
    crack(&run, bond_between(&run, 2, 3));
    crack(&run, bond_between(&run, 1, 2));
    run.time[0] = 1.25;
    run.time[1] = 2.5;
    run.end = 3;
    struct ensemble study = ensemble_init(2, classes, false);
    for (int k = 0; k < 2; k++) {
        ensemble_add(&study, &run, &liquid);
        assert_within(study.statistics[k].value[FRONT_SATURATION], 0.25 * (0.75 + 0.5),
                      1e-15);
    }
    assert_int_equal(study.n_liquid, 2);
    assert_within(study.front.cracks, 4, 0);
    assert_within(study.front.local_sum, 1.25, 1e-15);
    assert_within(study.front.local[2], 1, 0); // from 0.8 to 0.7
    assert_within(study.front.local[4], 1, 0); // a border belongs above
    assert_within(study.front.local[9], 2, 0); // dry
    // At a saturation of 1/2, and in the end.
    static const double slice[8] = {2, 2, 0, 0, 2, 0, 0, 0};
    for (int k = 0; k < 8; k++)
        assert_within(study.front.slice[k], slice[k], 1e-15);
    ensemble_free(&study);
    run_free(&run);
    liquid_free(&liquid);
}

// Pearson's r of what left and what opened, where there ever was liquid.
TEST(correlation_by_its_definition)
{
    enum { SLICES = 3, INTERVALS = 4, N = SLICES * INTERVALS, RUNS = 2 };
    const struct classes few = {.n_slice = SLICES, .n_interval = INTERVALS};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double left[N], first[SLICES], slice[N], place[N], sum[5] = {0};
    for (int s = 0; s < SLICES; s++)
        first[s] = RUNS * gsl_rng_uniform_pos(rng);
    int n = 0;
    for (int k = 0; k < N; k++) {
        left[k] = gsl_rng_uniform(rng) / INTERVALS;
        slice[k] = (k < SLICES ? first[k] : slice[k - SLICES]) - left[k];
        if (k % SLICES == 1) slice[k] = NAN;
        place[k] = (double)gsl_rng_uniform_int(rng, 9);
        if (k % SLICES == 1) continue;
        n++;
        sum[0] += left[k];
        sum[1] += place[k];
        sum[2] += left[k] * left[k];
        sum[3] += place[k] * place[k];
        sum[4] += left[k] * place[k];
    }
    const double wanted =
        (n * sum[4] - sum[0] * sum[1]) /
        sqrt((n * sum[2] - sum[0] * sum[0]) * (n * sum[3] - sum[1] * sum[1]));
    assert_within(front_correlation(first, slice, place, few), wanted, 1e-13);
    static const double nothing[N];
    assert_true(isnan(front_correlation(first, slice, nothing, few)));
    gsl_rng_free(rng);
}
