// SPDX-License-Identifier: GPL-3.0-or-later
// Nested dissection by coordinates (George 1973). The columns begin..end-1 are halved
// at the median of their widest axis; those of one half with neighbours in the other
// are the separator and come last, then each half is dissected alike. So most columns
// are eliminated in small fronts, and only the last separator, about sqrt(n) columns,
// is wide.
#include "nested_dissection_order.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Fewer columns are not dissected any further.
enum { MIN_COLUMNS = 8 };

struct placed {
    double along; // where the column stands, across the cut
    int column;
};

struct dissection {
    const struct vector *position; // of the network's nodes
    const struct boundary_layer *layer;
    int *offset, *neighbour; // (n_exposed+1), of each column
    bool *beyond;            // (n_exposed) on the other side of the cut; false between
    struct placed *placed;   // (n_exposed) room for sorting
    int *order;              // (n_exposed)
};

static void find_neighbours(struct dissection *dissection)
{
    const struct boundary_layer *layer = dissection->layer;
    int *offset = dissection->offset;
    for (int k = 0; k < layer->n_lateral; k++)
        for (int end = 0; end < 2; end++)
            offset[layer->lateral[k][end]]++;
    for (int i = 0; i < layer->n_exposed; i++)
        offset[i + 1] += offset[i];
    for (int k = 0; k < layer->n_lateral; k++)
        for (int end = 0; end < 2; end++)
            dissection->neighbour[--offset[layer->lateral[k][end]]] =
                layer->lateral[k][1 - end];
}

static double coordinate(const struct dissection *dissection, int column, int axis)
{
    return component(dissection->position[dissection->layer->exposed[column]], axis);
}

static int widest_axis(const struct dissection *dissection, int begin, int end)
{
    int widest = 0;
    double width = -1;
    for (int axis = 0; axis < 3; axis++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int k = begin; k < end; k++) {
            const double at = coordinate(dissection, dissection->order[k], axis);
            lower = fmin(lower, at);
            upper = fmax(upper, at);
        }
        if (upper - lower <= width) continue;
        width = upper - lower;
        widest = axis;
    }
    return widest;
}

static int compare_placed(const void *a, const void *b)
{
    const struct placed *p = a, *q = b;
    if (p->along != q->along) return p->along < q->along ? -1 : 1;
    return (p->column > q->column) - (p->column < q->column);
}

static void sort_along(struct dissection *dissection, int begin, int end, int axis)
{
    for (int k = begin; k < end; k++) {
        const int column = dissection->order[k];
        dissection->placed[k] =
            (struct placed){coordinate(dissection, column, axis), column};
    }
    qsort(dissection->placed + begin, (size_t)(end - begin), sizeof(struct placed),
          compare_placed);
}

static bool reaches_beyond(const struct dissection *dissection, int column)
{
    for (int k = dissection->offset[column]; k < dissection->offset[column + 1]; k++)
        if (dissection->beyond[dissection->neighbour[k]]) return true;
    return false;
}

// Orders columns BEGIN..END-1: the first half, the second, and last the separator,
// which is the part of the first half with neighbours in the second.
static void dissect(struct dissection *dissection, int begin, int end)
{
    if (end - begin <= MIN_COLUMNS) return;
    sort_along(dissection, begin, end, widest_axis(dissection, begin, end));
    const int middle = begin + (end - begin) / 2;
    for (int k = middle; k < end; k++)
        dissection->beyond[dissection->placed[k].column] = true;
    int n_near = begin, n_parting = end;
    for (int k = middle - 1; k >= begin; k--)
        if (reaches_beyond(dissection, dissection->placed[k].column))
            dissection->order[--n_parting] = dissection->placed[k].column;
    for (int k = begin; k < middle; k++)
        if (!reaches_beyond(dissection, dissection->placed[k].column))
            dissection->order[n_near++] = dissection->placed[k].column;
    for (int k = middle; k < end; k++) {
        dissection->beyond[dissection->placed[k].column] = false;
        dissection->order[n_near + k - middle] = dissection->placed[k].column;
    }
    dissect(dissection, begin, n_near);
    dissect(dissection, n_near, n_parting);
}

int *nested_dissection_order(const struct network *network,
                             const struct boundary_layer *layer)
{
    const int n = layer->n_exposed;
    struct dissection dissection = {.position = network->node_position,
                                    .layer = layer,
                                    .offset = NEW_ARRAY(int, n + 1),
                                    .neighbour =
                                        NEW_ARRAY(int, 2 * (size_t)layer->n_lateral),
                                    .beyond = NEW_ARRAY(bool, n),
                                    .placed = NEW_ARRAY(struct placed, n),
                                    .order = NEW_ARRAY(int, n)};
    for (int i = 0; i < n; i++)
        dissection.order[i] = i;
    find_neighbours(&dissection);
    dissect(&dissection, 0, n);
    free(dissection.offset);
    free(dissection.neighbour);
    free(dissection.beyond);
    free(dissection.placed);
    return dissection.order;
}
