// SPDX-License-Identifier: GPL-3.0-or-later
// How the liquid of a partly filled network is distributed at the start: by invasion
// percolation from the exposed nodes (network/invasion.h), in the same order of
// throats that the drying uses, or as in a recorded run at the moment of the given
// saturation. Invaded throats are emptied one after the other until (1 - saturation)
// capacity has left; the last one only in part, so that the saturation is met exactly.
#include "initial_saturation.h"

#include "basics/memory.h"
#include "network/invasion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Rounding error that is accepted of the saturation when all that can leave has left.
static const double MIN_REST = 1e-12;

// --- by invasion -------------------------------------------------------------------

// The invasion starts at exposed nodes, and liquid leaves at those on far walls: these
// bits replace the bits of walls.
enum { INLET = 1, OUTLET = 2 };

static uint8_t *inlets_and_outlets(const struct occupancy *occupancy)
{
    const struct network *network = occupancy->network;
    uint8_t *ways = NEW_ARRAY(uint8_t, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        ways[i] = network->node_walls[i] & occupancy->far_walls ? OUTLET : 0;
    for (int i = 0; i < occupancy->layer.n_exposed; i++)
        ways[occupancy->layer.exposed[i]] |= INLET;
    return ways;
}

static enum status find_invasion(const struct occupancy *occupancy, bool trapping,
                                 struct invasion *invasion, struct reason *reason)
{
    struct network network = *occupancy->network;
    double *entry_priority = NEW_ARRAY(double, network.n_throat);
    for (int t = 0; t < network.n_throat; t++)
        entry_priority[t] = -occupancy->clusters.rank[t];
    network.node_walls = inlets_and_outlets(occupancy);
    const struct invasion_conditions conditions = {.entry_priority = entry_priority,
                                                   .inlet = INLET,
                                                   .outlet = OUTLET,
                                                   .trapping = trapping};
    enum status status = invade(&network, &conditions, invasion, reason);
    if (status && trapping)
        status = refuse(reason, STATUS_BAD_DATA,
                        "start_trapping: no throat reaches a closed wall opposite an "
                        "open one, through which liquid could leave");
    free(network.node_walls);
    free(entry_priority);
    return status;
}

enum status invaded_saturations(const struct occupancy *occupancy, double saturation,
                                bool trapping, double *left, struct reason *reason)
{
    struct invasion invasion;
    enum status status = find_invasion(occupancy, trapping, &invasion, reason);
    if (status) return status;
    for (int t = 0; t < occupancy->network->n_throat; t++)
        left[t] = occupancy->volume[t] > 0;
    struct compensated excess = {.value = (1 - saturation) * occupancy->capacity};
    for (int k = 0; k < invasion.n && compensated_value(excess) > 0; k++) {
        const int throat = invasion.throat[k];
        const double volume = occupancy->volume[throat];
        left[throat] = fmax(0, 1 - compensated_value(excess) / volume);
        compensated_add(&excess, -volume);
    }
    invasion_free(&invasion);
    const double rest = compensated_value(excess) / occupancy->capacity;
    if (rest > MIN_REST)
        status = refuse(reason, STATUS_BAD_DATA,
                        "start_saturation: must be above %.6g, which gas cuts off "
                        "(start_trapping), is %g",
                        saturation + rest, saturation);
    return status;
}

// --- from a record -----------------------------------------------------------------

// Brings NOW (n) from before the first step of CHANGES to the moment at which RECORD,
// of the same steps, has SATURATION.
static void follow(const struct drying_record *record,
                   const struct drying_record *changes, double saturation, double *now,
                   size_t n)
{
    double *before = NEW_ARRAY(double, n);
    apply_changes(changes, 0, now);
    int step = 0;
    while (record->saturation[step] > saturation && step < record->n_step - 1) {
        memcpy(before, now, n * sizeof *now);
        apply_changes(changes, ++step, now);
    }
    if (step > 0) {
        const double rest = (saturation - record->saturation[step]) /
                            (record->saturation[step - 1] - record->saturation[step]);
        for (size_t k = 0; k < n; k++)
            now[k] += fmin(1, fmax(0, rest)) * (before[k] - now[k]);
    }
    free(before);
}

double *recorded_saturations(const struct network *network,
                             const struct drying_record *record, double saturation)
{
    double *now = full_saturations(network);
    follow(record, record, saturation, now, (size_t)network->n_throat);
    return now;
}

double *recorded_rings(const struct network *network,
                       const struct drying_record *record,
                       const struct drying_record *changes, double saturation)
{
    double *now = NEW_ARRAY(double, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        now[i] = 1;
    follow(record, changes, saturation, now, (size_t)network->n_node);
    return now;
}

// --- either ------------------------------------------------------------------------

void start_from(struct occupancy *occupancy, const double *start, const double *rings)
{
    const int n_node = occupancy->rings ? occupancy->network->n_node : 0;
    struct compensated total = {0};
    for (int i = 0; i < n_node; i++)
        compensated_add(&total, occupancy->rings->at_node[i] * (rings ? rings[i] : 1));
    occupancy->rings_at_start = rings;
    for (int t = 0; t < occupancy->network->n_throat; t++) {
        if (!(occupancy->volume[t] > 0)) continue;
        if (start[t] == 0) {
            occupancy_empty_throat(occupancy, t);
            continue;
        }
        occupancy->liquid[t].value = start[t] * occupancy->volume[t];
        compensated_add(&total, occupancy->liquid[t].value);
    }
    for (int i = 0; rings && i < n_node; i++)
        if (rings[i] == 0 && occupancy->has_rings[i] && !occupancy->liquid_beside[i])
            occupancy_dry_rings(occupancy, i);
    occupancy->total_liquid = total;
    occupancy->initial_liquid = compensated_value(total);
}
