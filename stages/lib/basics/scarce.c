// SPDX-License-Identifier: GPL-3.0-or-later
// Memory and threads for the libraries as well. They take what they cannot have for
// something else: HDF5 for a damaged file, Jansson for an object without that member,
// libgomp for an end with status 1; and the rest crash. So these stand before the C
// library's functions, or those of another allocator, pass the call on, and end the
// program with one line and status 70 where it fails.
//
// Not under the sanitizers, which stand there themselves.
#ifndef __SANITIZE_ADDRESS__

#include "basics/status.h"

#include <dlfcn.h>
#include <errno.h>
#include <malloc.h> // memalign
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/sysinfo.h>
#include <unistd.h>

// At once, without another allocation; one line, whichever threads come here.
static _Noreturn void end(const char *what, size_t size)
{
    static atomic_flag said = ATOMIC_FLAG_INIT;
    char line[256];
    while (atomic_flag_test_and_set(&said))
        pause();
    const int length =
        snprintf(line, sizeof line, size ? "%s: %s: %zu bytes\n" : "%s: %s\n",
                 program_invocation_short_name, what, size);
    const ssize_t put = write(STDERR_FILENO, line, (size_t)length);
    _exit(put < 0 ? STATUS_IO : STATUS_INTERNAL);
}

// What the call gave. A size beyond all that the machine has is no want of memory but a
// wrong size, as in a damaged file: who asks for it is told, and says so.
static void *checked(void *memory, size_t size)
{
    struct sysinfo machine;
    if (memory || !size) return memory;
    if (!sysinfo(&machine) &&
        size / machine.mem_unit > machine.totalram + machine.totalswap)
        return NULL;
    end("out of memory", size);
}

static size_t product(size_t count, size_t size)
{
    size_t bytes;
    return __builtin_mul_overflow(count, size, &bytes) ? SIZE_MAX : bytes;
}

// NEXT: the function of this name that would be called without us.
#define NEXT(name)                                                                     \
    static __typeof__(name) *next;                                                     \
    if (!next) next = (__typeof__(name) *)(uintptr_t)dlsym(RTLD_NEXT, #name)

void *malloc(size_t size)
{
    NEXT(malloc);
    return checked(next(size), size);
}

void *calloc(size_t nmemb, size_t size)
{
    NEXT(calloc);
    return checked(next(nmemb, size), product(nmemb, size));
}

void *realloc(void *ptr, size_t size)
{
    NEXT(realloc);
    return checked(next(ptr, size), size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    NEXT(aligned_alloc);
    return checked(next(alignment, size), size);
}

void *memalign(size_t alignment, size_t size)
{
    NEXT(memalign);
    return checked(next(alignment, size), size);
}

int posix_memalign(void **memptr, size_t alignment, size_t size)
{
    NEXT(posix_memalign);
    const int error = next(memptr, alignment, size);
    if (error == ENOMEM) checked(NULL, size);
    return error;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attr,
                   void *(*start_routine)(void *), void *arg)
{
    NEXT(pthread_create);
    const int error = next(thread, attr, start_routine, arg);
    if (error) end("cannot start another thread: --threads=1 needs none", 0);
    return 0;
}

#endif
