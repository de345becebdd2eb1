// SPDX-License-Identifier: GPL-3.0-or-later
// A binary heap of items by keys that may change: which of many comes first, where a
// flat search would cost O(n) an event. Keys and places are the caller's, numbered by
// item, so that several heaps may share them: an item is in one heap at most.
#pragma once

struct indexed_heap {
    int n, capacity;
    int *item; // (n) the one with the least KEY first; of equal keys the lowest item
};

// Puts ITEM, or moves it where its new KEY belongs. PLACE[item] is where it stands,
// -1: not in the heap. KEY must not be NAN. O(log n).
void indexed_heap_put(struct indexed_heap *heap, const double *key, int *place,
                      int item);

// Takes ITEM out, if it is there. O(log n).
void indexed_heap_take(struct indexed_heap *heap, const double *key, int *place,
                       int item);

// Takes all out. O(n).
void indexed_heap_clear(struct indexed_heap *heap, int *place);

void indexed_heap_free(struct indexed_heap *heap);
