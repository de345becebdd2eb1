// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of LANES (4 or 8) numbers, for kernels that are compiled once for each width.
#include <math.h>
#include <string.h>
#if defined __x86_64__ && defined __FMA__
#include <immintrin.h>
#endif

typedef double lanes __attribute__((vector_size(8 * LANES)));

static inline lanes load(const double *from)
{
    lanes value;
    memcpy(&value, from, sizeof value);
    return value;
}

static inline lanes fused(double a, lanes b, lanes c)
{
    const lanes all = a - (lanes){0};
#if defined __x86_64__ && defined __FMA__ && LANES == 8
    return (lanes)_mm512_fmadd_pd((__m512d)all, (__m512d)b, (__m512d)c);
#elif defined __x86_64__ && defined __FMA__
    return (lanes)_mm256_fmadd_pd((__m256d)all, (__m256d)b, (__m256d)c);
#else
    for (int l = 0; l < LANES; l++)
        c[l] = fma(all[l], b[l], c[l]);
    return c;
#endif
}
