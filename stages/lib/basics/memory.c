// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"

#include "basics/status.h"

#include <stdlib.h>
#include <string.h>

void *allocate(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        die(STATUS_INTERNAL, "out of memory: %zu elements of %zu bytes", count, size);
    return memory;
}

void *reallocate(void *old, size_t count, size_t size)
{
    void *memory = reallocarray(old, count ? count : 1, size);
    if (!memory)
        die(STATUS_INTERNAL, "out of memory: %zu elements of %zu bytes", count, size);
    return memory;
}

void *duplicate(const void *source, size_t count, size_t size)
{
    void *memory = allocate(count, size);
    if (count) memcpy(memory, source, count * size);
    return memory;
}
