// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of numbers, the one layer over GCC's vector types and Intel's intrinsics.
//
// A file that is compiled twice, for AVX2 and for AVX-512 (*_avx2.c, *_avx512.c),
// defines SIMD_WIDTH as 4 or 8 before it includes this, and uses the types that end in
// `w`: SIMD_WIDTH doubles. Other files leave it at 4. All of +, -, *, / and comparisons
// work lane by lane, each rounded as a scalar is, so both widths give the same digits
// as long as sums across lanes have a fixed order. cpu_features.h says which of the two
// a processor can run.
//
// Multiply and add are fused where fmadd says so and nowhere else
// (-ffp-contract=off): compilers do not contract alike.
//
// How a loop over n numbers is written, y += a x:
//     int i = 0;
//     for (; i + SIMD_WIDTH <= n; i += SIMD_WIDTH)
//         store_unaligned(y + i, fmadd(splat(a), load_unaligned(x + i),
//                                      load_unaligned(y + i)));
//     for (; i < n; i++)
//         y[i] = fma(a, x[i], y[i]);
// The rest goes one by one with the C library's fma, which has the digits of a lane.
// For a sum over i the width must not show: keep a fixed number of running sums, as
// dot_product does (sparse/dense_kernels.h).
//
// Traps. A branch on any() looks at other lanes with another width, so it may only skip
// work that changes nothing. Functions with vectors as arguments must be inlined
// (SIMD_INLINE): how such arguments are passed depends on what a file is compiled for.
// A maskw of one file means nothing in another.
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#ifndef SIMD_WIDTH
#define SIMD_WIDTH 4
#endif
#if defined __x86_64__ && defined __FMA__ && SIMD_WIDTH == 8
#define SIMD_AVX512 1
#elif defined __x86_64__ && defined __FMA__
#define SIMD_AVX2 1
#endif // neither: loops over lanes, with the same digits

// Vectors wider than the baseline are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"
#define SIMD_INLINE static inline __attribute__((always_inline))

// Fixed widths, for code that is the same on all processors.
typedef double double4 __attribute__((vector_size(32)));
typedef int64_t mask4 __attribute__((vector_size(32))); // lanes of 0 or -1, of double4
typedef float float4 __attribute__((vector_size(16)));
typedef float float8 __attribute__((vector_size(32)));
typedef int32_t int4 __attribute__((vector_size(16)));

typedef double doublew __attribute__((vector_size(8 * SIMD_WIDTH)));
typedef float floatw
    __attribute__((vector_size(8 * SIMD_WIDTH))); // 2 SIMD_WIDTH of them
// The same in memory at any address of a double.
typedef double doublew_unaligned
    __attribute__((vector_size(8 * SIMD_WIDTH), aligned(8), may_alias));

// A in every lane. Less 0, not plus 0: -0 - 0 is -0, but -0 + 0 is 0.
SIMD_INLINE doublew splat(double a)
{
    return a - (doublew){0};
}

// From and to addresses that are multiples of the vector's size. At other addresses the
// program ends: these are for arrays of allocate_aligned and of structs with _Alignas.
SIMD_INLINE doublew load(const double *p)
{
    return *(const doublew *)p;
}

SIMD_INLINE void store(double *p, doublew a)
{
    *(doublew *)p = a;
}

// From and to any address.
SIMD_INLINE doublew load_unaligned(const double *p)
{
    return *(const doublew_unaligned *)p;
}

SIMD_INLINE void store_unaligned(double *p, doublew a)
{
    *(doublew_unaligned *)p = a;
}

// A B + C, rounded once. Where the processor has no such instruction, the C library's
// fma gives the same digits, slowly.
SIMD_INLINE doublew fmadd(doublew a, doublew b, doublew c)
{
#if defined SIMD_AVX512
    return (doublew)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined SIMD_AVX2
    return (doublew)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < SIMD_WIDTH; k++)
        c[k] = fma(a[k], b[k], c[k]);
    return c;
#endif
}

// A B - C, rounded once.
SIMD_INLINE doublew fmsub(doublew a, doublew b, doublew c)
{
#if defined SIMD_AVX512
    return (doublew)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined SIMD_AVX2
    return (doublew)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < SIMD_WIDTH; k++)
        c[k] = fma(a[k], b[k], -c[k]);
    return c;
#endif
}

// C - A B, rounded once.
SIMD_INLINE doublew fnmadd(doublew a, doublew b, doublew c)
{
#if defined SIMD_AVX512
    return (doublew)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined SIMD_AVX2
    return (doublew)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < SIMD_WIDTH; k++)
        c[k] = fma(-a[k], b[k], c[k]);
    return c;
#endif
}

// The same for floats, twice as many.
SIMD_INLINE floatw fmadd_float(floatw a, floatw b, floatw c)
{
#if defined SIMD_AVX512
    return (floatw)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif defined SIMD_AVX2
    return (floatw)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    for (int k = 0; k < 2 * SIMD_WIDTH; k++)
        c[k] = fmaf(a[k], b[k], c[k]);
    return c;
#endif
}

// The nearest number to the root, as IEEE 754 asks for: the same on all processors. NAN
// below 0.
SIMD_INLINE doublew square_root(doublew a) // sqrt may set errno, which no vector does
{
#if defined SIMD_AVX512
    return (doublew)_mm512_sqrt_pd((__m512d)a);
#elif defined SIMD_AVX2
    return (doublew)_mm256_sqrt_pd((__m256d)a);
#else
    for (int k = 0; k < SIMD_WIDTH; k++)
        a[k] = sqrt(a[k]);
    return a;
#endif
}

// |A|, also of -0 and NAN.
SIMD_INLINE doublew magnitude(doublew a)
{
#if defined SIMD_AVX512
    return (doublew)_mm512_abs_pd((__m512d)a);
#elif defined SIMD_AVX2
    return (doublew)_mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)a);
#else
    for (int k = 0; k < SIMD_WIDTH; k++)
        a[k] = fabs(a[k]);
    return a;
#endif
}

// ---- masks: the lanes in which something holds --------------------------------------

// A maskw is a bit a lane (AVX-512), else -1 or 0 in each lane: only the functions here
// look into it. Comparisons with NAN are false, but for differs and not_at_most.
#if defined SIMD_AVX512
typedef __mmask8 maskw;
#define SIMD_COMPARE(a, b, intel, operation)                                           \
    _mm512_cmp_pd_mask((__m512d)(a), (__m512d)(b), intel)
#else
typedef int64_t maskw __attribute__((vector_size(8 * SIMD_WIDTH)));
#if defined SIMD_AVX2
#define SIMD_COMPARE(a, b, intel, operation)                                           \
    (maskw) _mm256_cmp_pd((__m256d)(a), (__m256d)(b), intel)
#else
#define SIMD_COMPARE(a, b, intel, operation) (maskw)(operation)
#endif
#endif

// Comparisons, lane by lane; -0 equals 0. To test for what is right, not for what is
// wrong, sends NAN to the side of errors, as in scalar code.
SIMD_INLINE maskw above(doublew a, doublew b) // A > B
{
    return SIMD_COMPARE(a, b, _CMP_GT_OQ, a > b);
}

SIMD_INLINE maskw at_least(doublew a, doublew b) // A >= B
{
    return SIMD_COMPARE(a, b, _CMP_GE_OQ, a >= b);
}

SIMD_INLINE maskw differs(doublew a, doublew b) // A != B, or either is NaN
{
    return SIMD_COMPARE(a, b, _CMP_NEQ_UQ, a != b);
}

SIMD_INLINE maskw not_at_most(doublew a, doublew b) // A > B, or either is NaN
{
    return SIMD_COMPARE(a, b, _CMP_NLE_UQ, ~(a <= b));
}

#if defined SIMD_AVX512
// The lanes of A, of B, or of both.
SIMD_INLINE maskw either(maskw a, maskw b)
{
    return _kor_mask8(a, b);
}

// The lanes that A and B have in common.
SIMD_INLINE maskw both(maskw a, maskw b)
{
    return _kand_mask8(a, b);
}

// The lanes of A that are not in B.
SIMD_INLINE maskw without(maskw a, maskw b)
{
    return _kandn_mask8(b, a);
}

// Whether M has any lane.
SIMD_INLINE bool any(maskw m)
{
    return m != 0;
}

// Whether M has LANE, 0 to SIMD_WIDTH - 1.
SIMD_INLINE bool holds_in(maskw m, int lane)
{
    return m >> lane & 1;
}

// A where M holds, otherwise 0, also where A is NAN or infinite: so what has no meaning
// in a lane may be computed and masked.
SIMD_INLINE doublew only_where(maskw m, doublew a)
{
    return (doublew)_mm512_maskz_mov_pd(m, (__m512d)a);
}

// A where M holds, otherwise B. Both are computed; neither spreads into the other's
// lanes. To divide safely, choose 1 as the divisor of the lanes that do not count.
SIMD_INLINE doublew choose(maskw m, doublew a, doublew b)
{
    return (doublew)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a);
}
#else
// The same with -1 or 0 in each lane, so that bitwise operations do all of it.
SIMD_INLINE maskw either(maskw a, maskw b)
{
    return a | b;
}

SIMD_INLINE maskw both(maskw a, maskw b)
{
    return a & b;
}

SIMD_INLINE maskw without(maskw a, maskw b)
{
    return a & ~b;
}

SIMD_INLINE bool any(maskw m)
{
#if defined SIMD_AVX2
    return _mm256_movemask_pd((__m256d)m) != 0;
#else
    bool found = false;
    for (int k = 0; k < SIMD_WIDTH; k++)
        found = found || m[k] != 0;
    return found;
#endif
}

SIMD_INLINE bool holds_in(maskw m, int lane)
{
    return m[lane] != 0;
}

SIMD_INLINE doublew only_where(maskw m, doublew a)
{
    return (doublew)(m & (maskw)a);
}

SIMD_INLINE doublew choose(maskw m, doublew a, doublew b)
{
#if defined SIMD_AVX2
    return (doublew)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m);
#else
    return (doublew)((m & (maskw)a) | (~m & (maskw)b));
#endif
}
#endif
