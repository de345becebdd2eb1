// SPDX-License-Identifier: GPL-3.0-or-later
// Allocation that cannot fail quietly: out of memory ends the program with one line and
// status 70. Everything returned is freed with free(). A program that runs out of
// memory cannot go on usefully, and no caller needs a branch that no test can reach.
#pragma once

#include <stddef.h>

// Blocks of less than 32 MB are kept for the next one when they are freed, from the
// start: the kernel takes as long to give them again as a small run takes for the rest.
// The C library comes to the same by itself, once it has freed blocks of such sizes.
void keep_freed_memory(void);

// COUNT zeroed elements of SIZE bytes; never NULL, also for COUNT = 0. A product beyond
// size_t counts as out of memory, here and in reallocate.
void *allocate(size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, warn_unused_result));

// The same at the start of a cache line and with at least a byte to spare; large arrays
// on huge pages, where the kernel has them: gathers from many megabytes miss the
// address cache at almost each grain.
void *allocate_aligned(size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, warn_unused_result));

// The same for what is all written before it is read: not zeroed.
void *allocate_uncleared(size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, warn_unused_result));

// OLD (NULL: none yet) grown or shrunk to COUNT elements of SIZE bytes; what is new is
// not zeroed. OLD may have moved; not for what allocate_aligned gave, whose alignment
// it would lose. For growing arrays see GROW_ARRAY.
void *reallocate(void *old, size_t count, size_t size)
    __attribute__((returns_nonnull, warn_unused_result));

// For functions that only ask for memory in time (__builtin_prefetch): GCC takes them
// for functions without effect, and drops the calls, unless they are inlined at once.
#define PREFETCHING static inline __attribute__((always_inline)) void

// COUNT elements of SIZE bytes copied from SOURCE, which may be NULL for none. Never
// NULL, also for none.
void *duplicate(const void *source, size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, warn_unused_result));

// NEW_ARRAY(double, n): n zeroed doubles. Without sizeof at each call, and with the
// type checked.
#define NEW_ARRAY(type, count) ((type *)allocate((size_t)(count), sizeof(type)))

// Room for one more at the end of a growing array: capacity doubles, so appending N
// elements costs O(N).
#define GROW_ARRAY(array, count, capacity)                                             \
    do {                                                                               \
        if ((size_t)(count) == (size_t)(capacity)) {                                   \
            (capacity) = (capacity) ? 2 * (capacity) : 64;                             \
            (array) = reallocate((array), (size_t)(capacity), sizeof *(array));        \
        }                                                                              \
    } while (0)
