// SPDX-License-Identifier: GPL-3.0-or-later
// Order of entry, with ties decided by geometry. Lengths, volumes and places become
// whole ticks of 2^-30 of the network's extent (or largest volume), so that rounding,
// another unit of length or another numbering does not change who is first. First all
// are ranked by priority; then each run of equals, and only those, is sorted by
//     length, volume, -z, x, y (ticks; lowest first), index.
// Places wrap where the box repeats, so a throat across a side has one place.
#include "network/entry_order.h"

#include "basics/memory.h"
#include "basics/ranks.h"

#include <stdlib.h>
#include <string.h>

// In whole ticks, so that rounding, of another unit of length say, parts no equals.
static const double TICKS = 0x1p30;

struct ruler {
    const struct network *network;
    bool throats;       // or nodes
    struct vector zero; // lowest coordinates of the nodes, m
    double extent;      // of the nodes, m
    double volume;      // the largest, m3
};

enum { KEYS = 5 };

struct tied {
    int64_t key[KEYS]; // what has the lowest first key is the first, and so on
    int index;
};

static int64_t ticks(double value, double whole)
{
    return whole > 0 ? llround(value / whole * TICKS) : 0;
}

static struct ruler ruler_init(const struct network *network, bool throats)
{
    struct ruler ruler = {network, throats, {INFINITY, INFINITY, INFINITY}, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int i = 0; i < network->n_node; i++) {
            const double place = component(network->node_position[i], axis);
            lower = fmin(lower, place);
            upper = fmax(upper, place);
        }
        set_component(&ruler.zero, axis, lower);
        ruler.extent = fmax(ruler.extent, upper - lower);
    }
    for (int t = 0; throats && t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            ruler.volume = fmax(ruler.volume, throat_volume(network, t));
    return ruler;
}

// Along AXIS, within one box where it repeats.
static int64_t place_along(const struct ruler *ruler, struct vector place, int axis)
{
    const struct packing *packing = &ruler->network->packing;
    const double at = component(place, axis) - component(ruler->zero, axis);
    if (!packing->periodic[axis]) return ticks(at, ruler->extent);
    const double box =
        component(packing->upper, axis) - component(packing->lower, axis);
    const int64_t within = ticks(at - box * floor(at / box), ruler->extent);
    return within < ticks(box, ruler->extent) ? within : 0;
}

static struct tied measure(const struct ruler *ruler, int index)
{
    const struct network *network = ruler->network;
    struct tied tied = {.index = index};
    struct vector place;
    if (ruler->throats) {
        if (network->throat_kind[index] != THROAT_NETWORK) return tied;
        tied.key[0] = ticks(network->throat_length[index], ruler->extent);
        tied.key[1] = ticks(throat_volume(network, index), ruler->volume);
        place = throat_middle(network, index);
    } else {
        place = network->node_position[index];
    }
    tied.key[2] = -place_along(ruler, place, 2);
    tied.key[3] = place_along(ruler, place, 0);
    tied.key[4] = place_along(ruler, place, 1);
    return tied;
}

static int compare_tied(const void *a, const void *b)
{
    const struct tied *t = a, *s = b;
    for (int k = 0; k < KEYS; k++)
        if (t->key[k] != s->key[k]) return t->key[k] < s->key[k] ? -1 : 1;
    return (t->index > s->index) - (t->index < s->index);
}

static void sort_tied(const struct ruler *ruler, int *order, int n)
{
    struct tied *tied = NEW_ARRAY(struct tied, n);
    for (int k = 0; k < n; k++)
        tied[k] = measure(ruler, order[k]);
    qsort(tied, (size_t)n, sizeof *tied, compare_tied);
    for (int k = 0; k < n; k++)
        order[k] = tied[k].index;
    free(tied);
}

static void put_in_order(const struct network *network, bool throats, int n,
                         const double *entry_priority, int *order)
{
    bool *same = NEW_ARRAY(bool, n);
    rank_descending(entry_priority, n, order, same);
    struct ruler ruler = {0}; // made when something ties
    for (int k = 0; k < n;) {
        const bool *tie = memchr(same + k, true, (size_t)(n - k));
        if (!tie) break;
        const int begin = (int)(tie - same) - 1;
        for (k = begin + 1; k < n && same[k];)
            k++;
        if (!ruler.network) ruler = ruler_init(network, throats);
        sort_tied(&ruler, order + begin, k - begin);
    }
    free(same);
}

void order_throats(const struct network *network, const double *entry_priority,
                   int *order)
{
    put_in_order(network, true, network->n_throat,
                 entry_priority ? entry_priority : network->throat_radius, order);
}

void order_nodes(const struct network *network, const double *entry_priority,
                 int *order)
{
    put_in_order(network, false, network->n_node, entry_priority, order);
}
