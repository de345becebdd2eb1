// SPDX-License-Identifier: GPL-3.0-or-later
// The children of place k are 2 k + 1 and 2 k + 2. An item rises or sinks until neither
// its parent comes after it nor a child before it. Equal keys are ordered by item, so
// that the first one does not depend on what was put and taken before.
#include "indexed_heap.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static bool is_before(const double *key, int a, int b)
{
    return key[a] < key[b] || (!(key[b] < key[a]) && a < b);
}

static void set(struct indexed_heap *heap, int *place, int at, int item)
{
    heap->item[at] = item;
    place[item] = at;
}

// ITEM belongs at AT, or above or below it.
static void settle(struct indexed_heap *heap, const double *key, int *place, int at,
                   int item)
{
    for (int parent; at > 0; at = parent) {
        parent = (at - 1) / 2;
        if (!is_before(key, item, heap->item[parent])) break;
        set(heap, place, at, heap->item[parent]);
    }
    for (int child; (child = 2 * at + 1) < heap->n; at = child) {
        if (child + 1 < heap->n &&
            is_before(key, heap->item[child + 1], heap->item[child]))
            child++;
        if (!is_before(key, heap->item[child], item)) break;
        set(heap, place, at, heap->item[child]);
    }
    set(heap, place, at, item);
}

void indexed_heap_put(struct indexed_heap *heap, const double *key, int *place,
                      int item)
{
    if (place[item] < 0) {
        GROW_ARRAY(heap->item, heap->n, heap->capacity);
        place[item] = heap->n++;
    }
    settle(heap, key, place, place[item], item);
}

void indexed_heap_take(struct indexed_heap *heap, const double *key, int *place,
                       int item)
{
    const int at = place[item];
    if (at < 0) return;
    place[item] = -1;
    const int last = heap->item[--heap->n];
    if (last != item) settle(heap, key, place, at, last);
}

void indexed_heap_clear(struct indexed_heap *heap, int *place)
{
    for (int k = 0; k < heap->n; k++)
        place[heap->item[k]] = -1;
    heap->n = 0;
}

void indexed_heap_free(struct indexed_heap *heap)
{
    free(heap->item);
    *heap = (struct indexed_heap){0};
}
