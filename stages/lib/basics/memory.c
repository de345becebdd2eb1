// SPDX-License-Identifier: GPL-3.0-or-later
// Every function asks for at least one byte, as malloc(0) may return NULL. Blocks of a
// megabyte or more that are aligned start on a 2 MB page and ask the kernel for huge
// ones.
#include "basics/memory.h"

#include "basics/status.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

void keep_freed_memory(void)
{
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
}

void *allocate(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        die(STATUS_INTERNAL, "out of memory: %zu elements of %zu bytes", count, size);
    return memory;
}

void *allocate_uncleared(size_t count, size_t size)
{
    enum { CACHE_LINE = 64, HUGE_PAGE = 2 << 20 };
    size_t wanted;
    const bool is_too_large = __builtin_mul_overflow(count, size, &wanted);
    const size_t page = wanted < HUGE_PAGE / 2 ? CACHE_LINE : HUGE_PAGE;
    const size_t bytes = (wanted / page + 1) * page;
    void *memory = is_too_large ? NULL : aligned_alloc(page, bytes);
    if (!memory)
        die(STATUS_INTERNAL, "out of memory: %zu elements of %zu bytes", count, size);
    if (page == HUGE_PAGE) (void)madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

void *allocate_aligned(size_t count, size_t size)
{
    return memset(allocate_uncleared(count, size), 0, count * size);
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
