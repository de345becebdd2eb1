// SPDX-License-Identifier: GPL-3.0-or-later
#include "ensemble.h"

#include "clusters.h"
#include "pieces.h"

#include <stdlib.h>
#include <string.h>

struct study study_new(int most_runs, struct classes classes)
{
    return (struct study){.classes = classes,
                          .facts = NEW_ARRAY(struct facts, most_runs),
                          .counts = counts_new(classes),
                          .squares = squares_new(classes),
                          .front = front_new(classes)};
}

void study_free(struct study *study)
{
    free(study->facts);
    counts_free(&study->counts);
    squares_free(&study->squares);
    free(study->clusters.size);
    free(study->fragments.size);
    free(study->snapshot_saturation);
    free(study->deformation);
    front_free(&study->front);
    *study = (struct study){0};
}

// ---- facts of one run ---------------------------------------------------------------

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

static void note_pieces(double *value, const struct run *run, struct sizes *sizes)
{
    const struct packing *packing = &run->packing;
    uint8_t *before = bonds_before(run), *left = bonds_left(run);
    const struct pieces found = find_pieces(packing, left, sizes);
    value[FRAGMENTS_BEFORE] = find_pieces(packing, before, NULL).count;
    value[FRAGMENTS_COUNT] = found.count;
    value[FRAGMENTS_LARGEST] = found.largest;
    value[FRAGMENTS_SINGLE] = found.single;
    free(before);
    free(left);
}

// Spring-back: the share of the largest shrinkage that is gone at the end.
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
                       struct study *study)
{
    value[FRONT_CORRELATION] = value[FRONT_SATURATION] = NAN;
    if (!liquid) return;
    struct front front = front_new(study->classes);
    add_front(&front, run, liquid, study->classes);
    value[FRONT_CORRELATION] = front_correlation(front.slice, place, study->classes, 1);
    value[FRONT_SATURATION] = front.cracks > 0 ? front.local_sum / front.cracks : NAN;
    front_sum(&study->front, &front, study->classes);
    front_free(&front);
    study->n_liquid++;
}

// ---- the sum ------------------------------------------------------------------------

static void begin_snapshots(struct study *study, const struct run *run)
{
    study->n_snapshot = run->n_snapshot;
    study->snapshot_saturation = NEW_ARRAY(double, run->n_snapshot);
    study->deformation = NEW_ARRAY(struct deformation, run->n_snapshot);
}

void study_add(struct study *study, const struct run *run, const struct liquid *liquid)
{
    if (study->n_run == 0) begin_snapshots(study, run);
    double *value = study->facts[study->n_run++].value;
    struct counts counts = counts_new(study->classes);
    count_cracks(&counts, run, study->classes);
    struct orientation orientation = {0};
    add_orientation(&orientation, run);
    squares_add(&study->squares, &counts, &orientation, study->classes);
    note_counts(value, &counts, run->packing.n_bond);
    note_clusters(value, run, &study->clusters);
    note_pieces(value, run, &study->fragments);
    note_deformation(value, run, study->deformation);
    for (int s = 0; s < run->n_snapshot; s++)
        study->snapshot_saturation[s] += run->snapshot_saturation[s];
    note_front(value, run, liquid, counts.place, study);
    value[UNSETTLED_LOADS] = run->n_unsettled;
    value[UNSETTLED_CRACKS] = run->n_unsettled_crack;
    counts_free(&counts);
    count_cracks(&study->counts, run, study->classes);
    add_orientation(&study->orientation, run);
    study->bonds += run->packing.n_bond;
}
