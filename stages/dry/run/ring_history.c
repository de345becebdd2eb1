// SPDX-License-Identifier: GPL-3.0-or-later
// The run records what it empties in one list, throats by their index and the rings at
// node i as n_throat + i. Here they part:
//     rings:  those that hold liquid, their parts in the order of throats;
//     changes of throats, and changes of nodes, each with offsets of their own.
// What is in rings alone grows by what a throat leaves when it has emptied, and falls
// as the rings at a node dry:
//     saturation = sum over emptied throats of
//                  left (s_i + s_j) / 2  /  sum of the volumes of all throats.
#include "ring_history.h"

#include "basics/compensated.h"
#include "basics/memory.h"

#include <stdlib.h>

// ---- the rings ----------------------------------------------------------------------

static void list_rings(struct ring_history *rings, const struct network *network,
                       const struct ring_stores *stores)
{
    const struct throat_sides *parts = &stores->rings.parts;
    int64_t *begin = NEW_ARRAY(int64_t, network->n_face + 1);
    for (int k = 0; k < stores->rings.n_part; k++)
        begin[parts->face[k] + 1] += stores->part[k] > 0;
    for (int f = 0; f < network->n_face; f++) {
        rings->n += begin[f + 1] > 0;
        begin[f + 1] += begin[f];
    }
    rings->face = NEW_ARRAY(int32_t, rings->n);
    rings->separation = NEW_ARRAY(double, rings->n);
    rings->offset = NEW_ARRAY(int64_t, rings->n + 1);
    for (int f = 0, r = 0; f < network->n_face; f++) {
        if (begin[f + 1] == begin[f]) continue;
        rings->face[r] = f;
        rings->separation[r] = stores->rings.separation[f];
        rings->offset[++r] = begin[f + 1];
    }
    rings->throat = NEW_ARRAY(int32_t, begin[network->n_face]);
    rings->volume = NEW_ARRAY(double, begin[network->n_face]);
    for (int t = 0; t < network->n_throat; t++)
        for (int64_t k = parts->offset[t]; k < parts->offset[t + 1]; k++) {
            if (!(stores->part[k] > 0)) continue;
            const int64_t to = begin[parts->face[k]]++;
            rings->throat[to] = t;
            rings->volume[to] = stores->part[k];
        }
    free(begin);
}

// ---- changes ------------------------------------------------------------------------

static void part_changes(struct drying_history *history, struct ring_history *rings,
                         int n_throat)
{
    const int64_t n = history->change_offset[history->n_step];
    rings->change_offset = NEW_ARRAY(int64_t, history->n_step + 1);
    rings->change_node = NEW_ARRAY(int32_t, n);
    rings->change_saturation = NEW_ARRAY(double, n);
    int64_t of_throats = 0, of_nodes = 0, k = 0;
    for (int step = 0; step < history->n_step; step++) {
        for (; k < history->change_offset[step + 1]; k++)
            if (history->change_throat[k] < n_throat) {
                history->change_throat[of_throats] = history->change_throat[k];
                history->change_saturation[of_throats++] =
                    history->change_saturation[k];
            } else {
                rings->change_node[of_nodes] = history->change_throat[k] - n_throat;
                rings->change_saturation[of_nodes++] = history->change_saturation[k];
            }
        history->change_offset[step + 1] = of_throats;
        rings->change_offset[step + 1] = of_nodes;
    }
}

// ---- what is in rings ---------------------------------------------------------------

// Those that hold no liquid at the start, which step 0 lists, have left rings as well.
static void find_saturations(const struct drying_history *history,
                             const struct network *network,
                             const struct ring_stores *stores, double length,
                             struct ring_history *rings)
{
    double all = 0;
    double *node = NEW_ARRAY(double, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        node[i] = 1;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            all += throat_volume(network, t) / (length * length * length);
    rings->saturation = NEW_ARRAY(double, history->n_step);
    struct compensated sum = {0};
    for (int step = 0; step < history->n_step; step++) {
        for (int64_t k = history->change_offset[step];
             k < history->change_offset[step + 1]; k++)
            if (!(history->change_saturation[k] > 0))
                compensated_add(&sum, stores->of_throat[history->change_throat[k]]);
        for (int64_t k = rings->change_offset[step]; k < rings->change_offset[step + 1];
             k++) {
            const int i = rings->change_node[k];
            compensated_add(&sum, -stores->at_node[i] *
                                      (node[i] - rings->change_saturation[k]));
            node[i] = rings->change_saturation[k];
        }
        rings->saturation[step] = fmin(1, fmax(0, compensated_value(sum) / all));
    }
    free(node);
}

// ---- the whole ----------------------------------------------------------------------

void ring_history_take(struct drying_history *history, const struct network *network,
                       const struct ring_stores *stores, double length)
{
    struct ring_history *rings = history->rings = NEW_ARRAY(struct ring_history, 1);
    rings->limited = stores->limited;
    list_rings(rings, network, stores);
    part_changes(history, rings, network->n_throat);
    find_saturations(history, network, stores, length, rings);
}

void ring_history_free(struct ring_history *rings)
{
    if (!rings) return;
    free(rings->face);
    free(rings->separation);
    free(rings->offset);
    free(rings->throat);
    free(rings->volume);
    free(rings->change_offset);
    free(rings->change_node);
    free(rings->change_saturation);
    free(rings->saturation);
    free(rings);
}
