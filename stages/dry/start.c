// SPDX-License-Identifier: GPL-3.0-or-later
#include "start.h"

#include "basics/memory.h"
#include "basics/ranks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- by invasion -------------------------------------------------------------------

// Throats may come into the queue again from their other end, but none that is EMPTY.
static void reach_node(const struct phases *phases, int node, const double *saturation,
                       struct rank_queue *queue)
{
    const struct incidence *incidence = &phases->incidence;
    for (int k = incidence->offset[node]; k < incidence->offset[node + 1]; k++)
        if (saturation[incidence->throat[k]] > 0)
            rank_queue_add(queue, phases->clusters.rank[incidence->throat[k]]);
}

double *invaded_saturations(const struct phases *phases, double saturation)
{
    const struct network *network = phases->network;
    double *left = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        left[t] = phases->volume[t] > 0;
    struct rank_queue queue = rank_queue_make(network->n_throat);
    for (int i = 0; i < phases->layer.n_exposed; i++)
        reach_node(phases, phases->layer.exposed[i], left, &queue);
    struct compensated excess = {.value = (1 - saturation) * phases->capacity};
    for (int rank; (rank = rank_queue_take(&queue)) >= 0;) {
        const int throat = phases->clusters.throat_at_rank[rank];
        const double rest = compensated_value(excess);
        if (!(rest > 0)) break;
        left[throat] = fmax(0, 1 - rest / phases->volume[throat]);
        compensated_add(&excess, -phases->volume[throat]);
        for (int end = 0; end < 2; end++)
            reach_node(phases, network->throat_nodes[throat][end], left, &queue);
    }
    rank_queue_free(&queue);
    return left;
}

// --- from a record -----------------------------------------------------------------

static void apply_changes(const struct drying_record *record, int step, double *to)
{
    for (int64_t k = record->offset[step]; k < record->offset[step + 1]; k++)
        to[record->throat[k]] = record->throat_saturation[k];
}

double *recorded_saturations(const struct network *network,
                             const struct drying_record *record, double saturation)
{
    const size_t n = (size_t)network->n_throat;
    double *before = NEW_ARRAY(double, n), *now = NEW_ARRAY(double, n);
    for (size_t t = 0; t < n; t++)
        now[t] = network->throat_kind[t] == THROAT_NETWORK;
    apply_changes(record, 0, now);
    int step = 0;
    while (record->saturation[step] > saturation && step < record->n_step - 1) {
        memcpy(before, now, n * sizeof *now);
        apply_changes(record, ++step, now);
    }
    if (step > 0) {
        const double rest = (saturation - record->saturation[step]) /
                            (record->saturation[step - 1] - record->saturation[step]);
        for (size_t t = 0; t < n; t++)
            now[t] += fmin(1, fmax(0, rest)) * (before[t] - now[t]);
    }
    free(before);
    return now;
}

// --- either ------------------------------------------------------------------------

void start_from(struct phases *phases, const double *start)
{
    struct compensated total = {0};
    for (int t = 0; t < phases->network->n_throat; t++) {
        if (!(phases->volume[t] > 0)) continue;
        if (start[t] == 0) {
            phases_empty_throat(phases, t);
            continue;
        }
        phases->liquid[t].value = start[t] * phases->volume[t];
        compensated_add(&total, phases->liquid[t].value);
    }
    phases->total_liquid = total;
    phases->initial_liquid = compensated_value(total);
}
