// SPDX-License-Identifier: GPL-3.0-or-later
// Adds runs one by one: the statistics of each are kept, tables are sums over the runs.
// Squares of counts are summed as well, for the scatter over the runs (scatter.h).
//
// For one run
//     spring_back     = (largest shrinkage - last shrinkage) / largest shrinkage,
//     front saturation = sum over cracks of their slice's saturation / cracks.
// A snapshot with fewer than four grains in its largest fragment has no deformation
// (NAN), and then neither has the mean over the runs at that snapshot.
#include "ensemble.h"

#include "clusters.h"
#include "fragment_counts.h"

#include <stdlib.h>
#include <string.h>

struct ensemble ensemble_init(int most_runs, struct classes classes, bool patterns)
{
    return (struct ensemble){.classes = classes,
                             .pattern =
                                 patterns ? NEW_ARRAY(struct pattern, most_runs) : NULL,
                             .statistics = NEW_ARRAY(struct run_statistics, most_runs),
                             .counts = counts_init(classes),
                             .squares = squares_init(classes),
                             .front = drying_front_init(classes)};
}

void ensemble_free(struct ensemble *ensemble)
{
    free(ensemble->statistics);
    counts_free(&ensemble->counts);
    squares_free(&ensemble->squares);
    free(ensemble->clusters.size);
    free(ensemble->fragments.size);
    free(ensemble->snapshot_saturation);
    free(ensemble->deformation);
    drying_front_free(&ensemble->front);
    for (int r = 0; ensemble->pattern && r < ensemble->n_run; r++)
        pattern_free(&ensemble->pattern[r]);
    free(ensemble->pattern);
    *ensemble = (struct ensemble){0};
}

// ---- statistics of one run ----------------------------------------------------------

static void note_modes(double *value, const double of[MODE_COUNT])
{
    value[0] = of[MODE_NORMAL];
    value[1] = of[MODE_SHEAR];
    value[2] = of[MODE_NORMAL] + of[MODE_SHEAR];
}

static void note_counts(double *value, const struct counts *counts, int n_bond)
{
    note_modes(value + FIRST_NORMAL, counts->period[PERIOD_FIRST]);
    note_modes(value + SECOND_NORMAL, counts->period[PERIOD_SECOND]);
    double all[MODE_COUNT];
    count_all(all, counts);
    note_modes(value + CRACKS_NORMAL, all);
    value[CRACKS_SHARE] = n_bond ? value[CRACKS_TOTAL] / n_bond : NAN;
}

static void note_clusters(double *value, const struct run *run, struct sizes *sizes)
{
    const struct clusters found = find_clusters(run, sizes);
    value[CLUSTERS_COUNT] = found.count;
    value[CLUSTERS_LARGEST] = found.largest;
    for (int axis = 0; axis < 3; axis++)
        value[CLUSTERS_SPAN_X + axis] = found.spans[axis];
}

static void note_fragments(double *value, const struct run *run, struct sizes *sizes)
{
    const struct packing *packing = &run->packing;
    uint8_t *before = bonds_before(run), *left = bonds_left(run);
    const struct fragment_counts found = count_fragments(packing, left, sizes);
    value[FRAGMENTS_BEFORE] = count_fragments(packing, before, NULL).count;
    value[FRAGMENTS_COUNT] = found.count;
    value[FRAGMENTS_LARGEST] = found.largest;
    value[FRAGMENTS_SINGLE] = found.single;
    free(before);
    free(left);
}

// Spring-back: the part of the largest shrinkage that has recovered at the end.
static void note_deformation(double *value, const struct run *run,
                             struct deformation *sum)
{
    double largest = NAN, last = NAN;
    for (int s = 0; s < run->n_snapshot; s++) {
        const struct deformation found = body_deformation(run, s);
        last = found.shrinkage;
        largest = fmax(largest, last);
        sum[s].shrinkage += found.shrinkage;
        for (int k = 0; k < STRAIN_COUNT; k++)
            sum[s].strain[k] += found.strain[k];
    }
    value[SHRINKAGE_LARGEST] = largest;
    value[SHRINKAGE_LAST] = last;
    value[SPRING_BACK] = largest > 0 ? (largest - last) / largest : NAN;
}

static void note_front(double *value, const struct run *run,
                       const struct liquid *liquid, const double *place,
                       struct ensemble *ensemble)
{
    value[FRONT_CORRELATION] = value[FRONT_SATURATION] = NAN;
    if (!liquid) return;
    struct drying_front front = drying_front_init(ensemble->classes);
    drying_front_add(&front, run, liquid, ensemble->classes);
    value[FRONT_CORRELATION] =
        front_correlation(front.first, front.slice, place, ensemble->classes);
    value[FRONT_SATURATION] = front.cracks > 0 ? front.local_sum / front.cracks : NAN;
    drying_front_sum(&ensemble->front, &front, ensemble->classes);
    drying_front_free(&front);
    ensemble->n_liquid++;
}

// ---- the sum ------------------------------------------------------------------------

static void begin_snapshots(struct ensemble *ensemble, const struct run *run)
{
    ensemble->n_snapshot = run->n_snapshot;
    ensemble->snapshot_saturation = NEW_ARRAY(double, run->n_snapshot);
    ensemble->deformation = NEW_ARRAY(struct deformation, run->n_snapshot);
}

void ensemble_add(struct ensemble *ensemble, const struct run *run,
                  const struct liquid *liquid)
{
    if (ensemble->n_run == 0) begin_snapshots(ensemble, run);
    double *value = ensemble->statistics[ensemble->n_run++].value;
    struct counts counts = counts_init(ensemble->classes);
    count_cracks(&counts, run, ensemble->classes);
    struct orientation orientation = {0};
    add_orientation(&orientation, run);
    squares_add(&ensemble->squares, &counts, &orientation, ensemble->classes);
    note_counts(value, &counts, run->packing.n_bond);
    note_clusters(value, run, &ensemble->clusters);
    note_fragments(value, run, &ensemble->fragments);
    note_deformation(value, run, ensemble->deformation);
    for (int s = 0; s < run->n_snapshot; s++)
        ensemble->snapshot_saturation[s] += run->snapshot_saturation[s];
    note_front(value, run, liquid, counts.place, ensemble);
    value[UNSETTLED_LOADS] = run->n_unsettled;
    value[UNSETTLED_CRACKS] = run->n_unsettled_crack;
    if (ensemble->pattern)
        ensemble->pattern[ensemble->n_run - 1] =
            find_pattern(run, ensemble->classes.n_interval, value);
    counts_free(&counts);
    count_cracks(&ensemble->counts, run, ensemble->classes);
    add_orientation(&ensemble->orientation, run);
    ensemble->bonds += run->packing.n_bond;
}
