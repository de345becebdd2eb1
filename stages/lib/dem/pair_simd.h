// SPDX-License-Identifier: GPL-3.0-or-later
// Three components of SIMD_WIDTH pairs at once, and the way between records in memory
// (four or eight doubles of one grain) and lanes; for pair_kernel.h.
//
// In memory a grain is a record: {x, y, z, fourth} of a place or of forces, twice that
// of a motion or of forces and moments. In the kernel a doublew is one component of
// SIMD_WIDTH pairs, lane k being pair AT + k. `rows` lie between: for SIMD_WIDTH = 4
// row k is the record of lane k; for 8 the rows are the records of lanes 0 and 2, 1 and
// 3, 4 and 6, 5 and 7, as EVEN, ODD, LOWER and UPPER then put lanes in order. transpose
// leads from rows to components, rows_of back. Why transpose at all: a grain's numbers
// lie together because pairs find grains at random places, so one line of the cache has
// them all; arithmetic wants the same number of many pairs. So whole records are loaded
// and then transposed.
//
// For SIMD_WIDTH = 4 and the records a, b, c, d of lanes 0 to 3, in code order:
//     rows      ax ay az aw | bx by bz bw | cx cy cz cw | dx dy dz dw
//     EVEN, ODD ax bx az bz   ay by aw bw   cx dx cz dz   cy dy cw dw
//     LOWER     ax bx cx dx   ay by cy dy       (x and y)
//     UPPER     az bz cz dz   aw bw cw dw       (z and the fourth)
// so eight shuffles serve four components. Nothing here rounds but the arithmetic of
// components, which is that of each lane alone.
#include "dem/engine.h"

#include "basics/simd.h"

// One vector of each pair.
struct vectorw {
    doublew x, y, z;
};

// Lanes AT .. AT + SIMD_WIDTH - 1 of a vector in a group; and back. P[axis] has the
// eight lanes of a group; AT is a multiple of SIMD_WIDTH.
SIMD_INLINE struct vectorw load3(const double (*p)[PAIRS_IN_GROUP], int at)
{
    return (struct vectorw){load(&p[0][at]), load(&p[1][at]), load(&p[2][at])};
}

SIMD_INLINE void store3(double (*p)[PAIRS_IN_GROUP], int at, struct vectorw a)
{
    store(&p[0][at], a.x);
    store(&p[1][at], a.y);
    store(&p[2][at], a.z);
}

// Component by component, in this order and fused as written; the order is part of the
// result.
SIMD_INLINE struct vectorw add3(struct vectorw a, struct vectorw b)
{
    return (struct vectorw){a.x + b.x, a.y + b.y, a.z + b.z};
}

SIMD_INLINE struct vectorw subtract3(struct vectorw a, struct vectorw b)
{
    return (struct vectorw){a.x - b.x, a.y - b.y, a.z - b.z};
}

SIMD_INLINE struct vectorw scale3(doublew s, struct vectorw a)
{
    return (struct vectorw){s * a.x, s * a.y, s * a.z};
}

// A + S B; below A - S B. Fused.
SIMD_INLINE struct vectorw add_scaled3(struct vectorw a, doublew s, struct vectorw b)
{
    return (struct vectorw){fmadd(s, b.x, a.x), fmadd(s, b.y, a.y), fmadd(s, b.z, a.z)};
}

SIMD_INLINE struct vectorw subtract_scaled3(struct vectorw a, doublew s,
                                            struct vectorw b)
{
    return (struct vectorw){fnmadd(s, b.x, a.x), fnmadd(s, b.y, a.y),
                            fnmadd(s, b.z, a.z)};
}

// 0 outside of M, also where A is NAN.
SIMD_INLINE struct vectorw only_where3(maskw m, struct vectorw a)
{
    return (struct vectorw){only_where(m, a.x), only_where(m, a.y), only_where(m, a.z)};
}

// x y first, then y, then z: two fused operations.
SIMD_INLINE doublew dot3(struct vectorw a, struct vectorw b)
{
    return fmadd(a.z, b.z, fmadd(a.y, b.y, a.x * b.x));
}

// One product of each pair is rounded, the other is not.
SIMD_INLINE struct vectorw cross3(struct vectorw a, struct vectorw b)
{
    return (struct vectorw){fmsub(a.y, b.z, a.z * b.y), fmsub(a.z, b.x, a.x * b.z),
                            fmsub(a.x, b.y, a.y * b.x)};
}

// A - B x C.
SIMD_INLINE struct vectorw subtract_cross3(struct vectorw a, struct vectorw b,
                                           struct vectorw c)
{
    return (struct vectorw){fnmadd(b.y, c.z, fmadd(b.z, c.y, a.x)),
                            fnmadd(b.z, c.x, fmadd(b.x, c.z, a.y)),
                            fnmadd(b.x, c.y, fmadd(b.y, c.x, a.z))};
}

// Four numbers from each of SIMD_WIDTH records, transposed: three components and a
// fourth.
struct vectorw_and_fourth {
    struct vectorw xyz;
    doublew w;
};

// The record of STRIDE doubles, 4 or 8, at a scaled INDEX (INDEX_SCALE). INDEX is eight
// times the grain's number: the processor scales by 1, 2, 4 or 8 in an address, so 32
// and 64 bytes need no multiplication. BASE must be aligned to a record.
SIMD_INLINE double *record(const double *base, size_t stride, uint32_t index)
{
    return (double *)((uintptr_t)base + stride * sizeof *base / INDEX_SCALE * index);
}

// The same pointer, unknown to the compiler: 16 indices do not fit its registers, and
// to read them again costs less than spilling them.
SIMD_INLINE const uint32_t *reload_pointer(const uint32_t *index)
{
    __asm__("" : "+r"(index));
    return index;
}

SIMD_INLINE double4 load_quad(const double *base, size_t stride, uint32_t index)
{
    return *(const double4 *)record(base, stride, index);
}

// EVEN, ODD: of two rows in turn, the even or odd places. LOWER, UPPER: the first or
// second half of each four, of both. LOWER_TWO, UPPER_TWO undo that for rows_of.
// PAIR_UP joins two records of four to one row of eight. ROWS: those that `fetch`
// loads, of the pointer p, the stride and the indices i.
#if SIMD_WIDTH == 8
#define PAIR_UP(a, b)                                                                  \
    (doublew) _mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)(a)), (__m256d)(b), 1)
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

// As fetched: two records of four in each (SIMD_WIDTH = 8), or one. Four registers in
// either width.
struct rows {
    doublew row[4];
};

// The records, of STRIDE doubles from P on, of the grains with the scaled indices I
// (SIMD_WIDTH); of each the first four.
SIMD_INLINE struct rows fetch(const double *p, size_t stride, const uint32_t *i)
{
    return (struct rows){ROWS};
}

// Before transposing: half the shuffles of adding afterwards. Of each row A + B; below
// A - B.
SIMD_INLINE struct rows add_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] += b.row[k];
    return a;
}

SIMD_INLINE struct rows subtract_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] -= b.row[k];
    return a;
}

// From records to components, lanes in the order of the indices that were fetched.
SIMD_INLINE struct vectorw_and_fourth transpose(struct rows a)
{
    const doublew xz0 = EVEN(a.row[0], a.row[1]), xz1 = EVEN(a.row[2], a.row[3]);
    const doublew yw0 = ODD(a.row[0], a.row[1]), yw1 = ODD(a.row[2], a.row[3]);
    return (struct vectorw_and_fourth){
        {LOWER(xz0, xz1), LOWER(yw0, yw1), UPPER(xz0, xz1)}, UPPER(yw0, yw1)};
}

// Differences of the records of eight at P, from I to J: two vectors of three. With
// eight lanes a record of eight doubles is one load, and both of its vectors share the
// shuffles.
SIMD_INLINE void fetch_changes(const double *p, const uint32_t *i, const uint32_t *j,
                               struct vectorw *first, struct vectorw *second)
{
#if SIMD_WIDTH == 8
#define CHANGE(k) (load(record(p, 8, j[k])) - load(record(p, 8, i[k])))
    doublew xz[4], y[4]; // of each two, then for both vectors
#pragma GCC unroll 4
    for (size_t k = 0; k < 4; k++) {
        const doublew even = CHANGE(2 * k), odd = CHANGE(2 * k + 1);
        xz[k] = EVEN(even, odd);
        y[k] = ODD(even, odd);
    }
#undef CHANGE
    const doublew x0 = LOWER(xz[0], xz[1]), x1 = LOWER(xz[2], xz[3]);
    const doublew y0 = LOWER(y[0], y[1]), y1 = LOWER(y[2], y[3]);
    const doublew z0 = UPPER(xz[0], xz[1]), z1 = UPPER(xz[2], xz[3]);
    *first = (struct vectorw){LOWER(x0, x1), LOWER(y0, y1), LOWER(z0, z1)};
    *second = (struct vectorw){UPPER(x0, x1), UPPER(y0, y1), UPPER(z0, z1)};
#else
    *first = transpose(subtract_rows(fetch(p, 8, j), fetch(p, 8, i))).xyz;
    *second = transpose(subtract_rows(fetch(p + 4, 8, j), fetch(p + 4, 8, i))).xyz;
#endif
}

// The reverse: row k of four is A, with zero for a fourth, of one lane (SIMD_WIDTH = 4)
// or of two, in the order of ROWS.
SIMD_INLINE struct rows rows_of(struct vectorw a)
{
    const doublew zero = {0};
    const doublew xy0 = EVEN(a.x, a.y), xy1 = ODD(a.x, a.y);
    const doublew zw0 = EVEN(a.z, zero), zw1 = ODD(a.z, zero);
    return (struct rows){{LOWER_TWO(xy0, zw0), LOWER_TWO(xy1, zw1), UPPER_TWO(xy0, zw0),
                          UPPER_TWO(xy1, zw1)}};
}

// Lane K of ROWS. The record of that pair, x, y, z and a fourth. K is a constant where
// loops are unrolled, so the choice costs nothing.
SIMD_INLINE double4 quad_of(struct rows rows, int k)
{
#if SIMD_WIDTH == 8
    const doublew row = rows.row[(k & 1) + (k & 4) / 2];
    return k & 2 ? __builtin_shufflevector(row, row, 4, 5, 6, 7)
                 : __builtin_shufflevector(row, row, 0, 1, 2, 3);
#else
    return rows.row[k];
#endif
}

#if SIMD_WIDTH == 8
// Lane K of A and of B.
SIMD_INLINE doublew both_of(struct rows a, struct rows b, int k)
{
    const int r = (k & 1) + (k & 4) / 2;
    return k & 2
               ? __builtin_shufflevector(a.row[r], b.row[r], 4, 5, 6, 7, 12, 13, 14, 15)
               : __builtin_shufflevector(a.row[r], b.row[r], 0, 1, 2, 3, 8, 9, 10, 11);
}
#endif
