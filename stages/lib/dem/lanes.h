// SPDX-License-Identifier: GPL-3.0-or-later
// LANES numbers at once, 4 or 8, and records brought from memory into lanes and back;
// for pair_kernel.h.
#include "dem/engine.h"

#include <immintrin.h>

// Vectors wider than the baseline are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef double quad __attribute__((vector_size(32)));

struct lanes3 {
    lanes x, y, z;
};

#define INLINE static inline __attribute__((always_inline))

INLINE lanes splat(double a)
{
#if LANES == 8
    return (lanes){a, a, a, a, a, a, a, a};
#else
    return (lanes){a, a, a, a};
#endif
}

INLINE lanes load(const double *p)
{
    return *(const lanes *)p;
}

INLINE void store(double *p, lanes a)
{
    *(lanes *)p = a;
}

INLINE lanes magnitude(lanes a)
{
#if LANES == 8
    return (lanes)_mm512_abs_pd((__m512d)a);
#else
    return (lanes)_mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)a);
#endif
}

INLINE lanes square_root(lanes a)
{
#if LANES == 8
    return (lanes)_mm512_sqrt_pd((__m512d)a);
#else
    return (lanes)_mm256_sqrt_pd((__m256d)a);
#endif
}

// In which lanes something holds.
#if LANES == 8
typedef __mmask8 mask;
#define COMPARED(a, b, how) _mm512_cmp_pd_mask((__m512d)(a), (__m512d)(b), how)

INLINE mask either(mask a, mask b)
{
    return _kor_mask8(a, b);
}

INLINE mask both(mask a, mask b)
{
    return _kand_mask8(a, b);
}

INLINE mask without(mask a, mask b)
{
    return _kandn_mask8(b, a);
}

INLINE bool any(mask m)
{
    return m != 0;
}

INLINE bool holds_in(mask m, int lane)
{
    return m >> lane & 1;
}

INLINE lanes only_where(mask m, lanes a)
{
    return (lanes)_mm512_maskz_mov_pd(m, (__m512d)a);
}

INLINE lanes choose(mask m, lanes a, lanes b)
{
    return (lanes)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a);
}
#else
typedef int64_t mask __attribute__((vector_size(8 * LANES)));
#define COMPARED(a, b, how) (mask) _mm256_cmp_pd((__m256d)(a), (__m256d)(b), how)

INLINE mask either(mask a, mask b)
{
    return a | b;
}

INLINE mask both(mask a, mask b)
{
    return a & b;
}

INLINE mask without(mask a, mask b)
{
    return a & ~b;
}

INLINE bool any(mask m)
{
    return _mm256_movemask_pd((__m256d)m) != 0;
}

INLINE bool holds_in(mask m, int lane)
{
    return m[lane] != 0;
}

INLINE lanes only_where(mask m, lanes a)
{
    return (lanes)(m & (mask)a);
}

INLINE lanes choose(mask m, lanes a, lanes b)
{
    return (lanes)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m);
}
#endif

INLINE mask above(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_GT_OQ);
}

INLINE mask at_least(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_GE_OQ);
}

INLINE mask unlike(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_NEQ_UQ);
}

INLINE mask not_within(lanes a, lanes b) // A > B, or a number is none
{
    return COMPARED(a, b, _CMP_NLE_UQ);
}

INLINE struct lanes3 load3(const double (*p)[PAIRS_IN_GROUP], int at)
{
    return (struct lanes3){load(&p[0][at]), load(&p[1][at]), load(&p[2][at])};
}

INLINE void store3(double (*p)[PAIRS_IN_GROUP], int at, struct lanes3 a)
{
    store(&p[0][at], a.x);
    store(&p[1][at], a.y);
    store(&p[2][at], a.z);
}

INLINE struct lanes3 add3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){a.x + b.x, a.y + b.y, a.z + b.z};
}

INLINE struct lanes3 subtract3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){a.x - b.x, a.y - b.y, a.z - b.z};
}

INLINE struct lanes3 scale3(lanes s, struct lanes3 a)
{
    return (struct lanes3){s * a.x, s * a.y, s * a.z};
}

// A B + C, rounded once. Written out, as compilers do not contract alike.
INLINE lanes fused(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE struct lanes3 add_scaled3(struct lanes3 a, lanes s, struct lanes3 b)
{
    return (struct lanes3){fused(s, b.x, a.x), fused(s, b.y, a.y), fused(s, b.z, a.z)};
}

// A B - C and C - A B in the same way, without an instruction for the sign.
INLINE lanes fused_less(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE lanes less_fused(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE struct lanes3 subtract_scaled3(struct lanes3 a, lanes s, struct lanes3 b)
{
    return (struct lanes3){less_fused(s, b.x, a.x), less_fused(s, b.y, a.y),
                           less_fused(s, b.z, a.z)};
}

INLINE struct lanes3 only_where3(mask m, struct lanes3 a)
{
    return (struct lanes3){only_where(m, a.x), only_where(m, a.y), only_where(m, a.z)};
}

INLINE lanes dot3(struct lanes3 a, struct lanes3 b)
{
    return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x));
}

INLINE struct lanes3 cross3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){fused_less(a.y, b.z, a.z * b.y),
                           fused_less(a.z, b.x, a.x * b.z),
                           fused_less(a.x, b.y, a.y * b.x)};
}

// A - B x C.
INLINE struct lanes3 subtract_cross3(struct lanes3 a, struct lanes3 b, struct lanes3 c)
{
    return (struct lanes3){less_fused(b.y, c.z, fused(b.z, c.y, a.x)),
                           less_fused(b.z, c.x, fused(b.x, c.z, a.y)),
                           less_fused(b.x, c.y, fused(b.y, c.x, a.z))};
}

// Four numbers from each of LANES places, transposed to three vectors and a fourth.
struct lanes4 {
    struct lanes3 xyz;
    lanes w;
};

// The record of STRIDE numbers, 4 or 8, that INDEX names.
INLINE double *record(const double *base, size_t stride, uint32_t index)
{
    return (double *)((uintptr_t)base + stride * sizeof *base / NUMBER_STEP * index);
}

// The same place, unknown to the compiler: 16 indices do not fit its registers, and to
// read them once more costs less than where it would put them.
INLINE const uint32_t *read_anew(const uint32_t *index)
{
    __asm__("" : "+r"(index));
    return index;
}

INLINE quad load_quad(const double *base, size_t stride, uint32_t index)
{
    return *(const quad *)record(base, stride, index);
}

#if LANES == 8
#define PAIR_UP(a, b)                                                                  \
    (lanes) _mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)(a)), (__m256d)(b), 1)
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define LOWER(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define UPPER(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
#define LOWER_TWO(a, b) __builtin_shufflevector(a, b, 0, 1, 8, 9, 2, 3, 10, 11)
#define UPPER_TWO(a, b) __builtin_shufflevector(a, b, 4, 5, 12, 13, 6, 7, 14, 15)
#define ROW(k) PAIR_UP(load_quad(p, stride, i[k]), load_quad(p, stride, i[(k) + 2]))
#define ROWS                                                                           \
    {                                                                                  \
        ROW(0), ROW(1), ROW(4), ROW(5)                                                 \
    }
#else
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define LOWER(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define UPPER(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#define LOWER_TWO LOWER
#define UPPER_TWO UPPER
#define ROW(k) load_quad(p, stride, i[k])
#define ROWS                                                                           \
    {                                                                                  \
        ROW(0), ROW(1), ROW(2), ROW(3)                                                 \
    }
#endif

// As fetched: two records of four in each (LANES = 8), or one.
struct rows {
    lanes row[4];
};

INLINE struct rows fetch(const double *p, size_t stride, const uint32_t *i)
{
    return (struct rows){ROWS};
}

INLINE struct rows add_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] += b.row[k];
    return a;
}

INLINE struct rows subtract_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] -= b.row[k];
    return a;
}

INLINE struct lanes4 transpose(struct rows a)
{
    const lanes xz0 = EVEN(a.row[0], a.row[1]), xz1 = EVEN(a.row[2], a.row[3]);
    const lanes yw0 = ODD(a.row[0], a.row[1]), yw1 = ODD(a.row[2], a.row[3]);
    return (struct lanes4){{LOWER(xz0, xz1), LOWER(yw0, yw1), UPPER(xz0, xz1)},
                           UPPER(yw0, yw1)};
}

// How records of eight at P, two vectors of three with a 0 each, change from I to J.
INLINE void fetch_changes(const double *p, const uint32_t *i, const uint32_t *j,
                          struct lanes3 *first, struct lanes3 *second)
{
#if LANES == 8
#define CHANGE(k) (load(record(p, 8, j[k])) - load(record(p, 8, i[k])))
    lanes xz[4], y[4]; // of each two, then for both vectors
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++) {
        const lanes even = CHANGE(2 * k), odd = CHANGE(2 * k + 1);
        xz[k] = EVEN(even, odd);
        y[k] = ODD(even, odd);
    }
#undef CHANGE
    const lanes x0 = LOWER(xz[0], xz[1]), x1 = LOWER(xz[2], xz[3]);
    const lanes y0 = LOWER(y[0], y[1]), y1 = LOWER(y[2], y[3]);
    const lanes z0 = UPPER(xz[0], xz[1]), z1 = UPPER(xz[2], xz[3]);
    *first = (struct lanes3){LOWER(x0, x1), LOWER(y0, y1), LOWER(z0, z1)};
    *second = (struct lanes3){UPPER(x0, x1), UPPER(y0, y1), UPPER(z0, z1)};
#else
    *first = transpose(subtract_rows(fetch(p, 8, j), fetch(p, 8, i))).xyz;
    *second = transpose(subtract_rows(fetch(p + 4, 8, j), fetch(p + 4, 8, i))).xyz;
#endif
}

// The reverse: row k of four is A, with zero for a fourth, of one lane (LANES = 4) or
// of two, in the order of ROWS.
INLINE struct rows rows_of(struct lanes3 a)
{
    const lanes zero = {0};
    const lanes xy0 = EVEN(a.x, a.y), xy1 = ODD(a.x, a.y);
    const lanes zw0 = EVEN(a.z, zero), zw1 = ODD(a.z, zero);
    return (struct rows){{LOWER_TWO(xy0, zw0), LOWER_TWO(xy1, zw1), UPPER_TWO(xy0, zw0),
                          UPPER_TWO(xy1, zw1)}};
}

// Lane K of ROWS.
INLINE quad quad_of(struct rows rows, int k)
{
#if LANES == 8
    const lanes row = rows.row[(k & 1) + (k & 4) / 2];
    return k & 2 ? __builtin_shufflevector(row, row, 4, 5, 6, 7)
                 : __builtin_shufflevector(row, row, 0, 1, 2, 3);
#else
    return rows.row[k];
#endif
}

#if LANES == 8
// Lane K of A and of B.
INLINE lanes both_of(struct rows a, struct rows b, int k)
{
    const int r = (k & 1) + (k & 4) / 2;
    return k & 2
               ? __builtin_shufflevector(a.row[r], b.row[r], 4, 5, 6, 7, 12, 13, 14, 15)
               : __builtin_shufflevector(a.row[r], b.row[r], 0, 1, 2, 3, 8, 9, 10, 11);
}
#endif
