// SPDX-License-Identifier: GPL-3.0-or-later
// What most of the work on factors is done by, once for vectors of four numbers, once
// of eight (BYTES): each number has the same digits in both. NAMED(x) is the name of x.
#include "dense_lu.h"
#include "supernodal_internal.h"
#include "vector_kernels.h"

#include <math.h>
#include <string.h>
#if defined __x86_64__ && defined __FMA__
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline))

typedef double vector __attribute__((vector_size(BYTES), aligned(8), may_alias));

enum { NUMBERS = BYTES / sizeof(double), PARTS = BATCH / NUMBERS };

INLINE vector load(const double *from)
{
    return *(const vector *)from;
}

INLINE void store(double *to, vector a)
{
    *(vector *)to = a;
}

INLINE vector all_of(double a)
{
    return a - (vector){0};
}

// A B + C, written out, as compilers do not contract alike.
INLINE vector fused(vector a, vector b, vector c)
{
#if defined __x86_64__ && defined __FMA__ && BYTES == 64
    return (vector)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined __x86_64__ && defined __FMA__
    return (vector)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < NUMBERS; k++)
        c[k] = fma(a[k], b[k], c[k]);
    return c;
#endif
}

// C less A B: broadcast from memory, and no sign to turn.
INLINE vector less(vector c, double a, vector b)
{
#if defined __x86_64__ && defined __FMA__ && BYTES == 64
    return (vector)_mm512_fnmadd_pd(_mm512_set1_pd(a), (__m512d)b, (__m512d)c);
#elif defined __x86_64__ && defined __FMA__
    return (vector)_mm256_fnmadd_pd(_mm256_set1_pd(a), (__m256d)b, (__m256d)c);
#else
    return fused(all_of(-a), b, c);
#endif
}

// Loops over what stays in registers, so with bounds that are known where they are
// inlined. Parts innermost: a number is read once for all of a row.
#define UNROLLED _Pragma("GCC unroll 8")

// A over B, whose INVERSE is known: as well rounded as a division, and much sooner
// done.
INLINE vector divided(vector a, double b, double inverse)
{
    const vector nearly = a * all_of(inverse);
    return fused(fused(-nearly, all_of(b), a), all_of(inverse), nearly);
}

// ---- lanes through a supernode ------------------------------------------------------

// Of the row that SUPER's Ith is.
INLINE double *lanes_of(const struct supernode *super, int i, int parts, double *x)
{
    return x + (long)super->row[i] * NUMBERS * parts;
}

// Columns of a grain lie together: six at a time, then what is left.
enum { MOST = 6 };

// WIDE columns from FIRST on.
INLINE void forward_columns(const struct supernode *super, int first, int wide,
                            int parts, double *x)
{
    const int rows = super->rows;
    const double *panel = super->panel + (long)first * rows;
    vector own[MOST][PARTS];
    UNROLLED for (int j = 0; j < wide; j++)
    {
        double *at = lanes_of(super, first + j, parts, x);
        const double pivot = panel[(long)j * rows + first + j];
        UNROLLED for (int q = 0; q < parts; q++)
        {
            own[j][q] = load(at + NUMBERS * q);
            UNROLLED for (int l = 0; l < wide; l++) if (l < j) own[j][q] =
                less(own[j][q], panel[(long)l * rows + first + j], own[l][q]);
            own[j][q] = divided(own[j][q], pivot, 1 / pivot);
            store(at + NUMBERS * q, own[j][q]);
        }
    }
    for (int i = first + wide; i < rows; i++) {
        double *at = lanes_of(super, i, parts, x);
        vector left[PARTS];
        UNROLLED for (int q = 0; q < parts; q++) left[q] = load(at + NUMBERS * q);
        UNROLLED for (int j = 0; j < wide; j++) UNROLLED for (int q = 0; q < parts; q++)
            left[q] = less(left[q], panel[(long)j * rows + i], own[j][q]);
        UNROLLED for (int q = 0; q < parts; q++) store(at + NUMBERS * q, left[q]);
    }
}

INLINE void forward(const struct supernode *super, int parts, double *x)
{
    const int columns = super->columns;
    int first = 0;
    for (; first + MOST <= columns; first += MOST)
        forward_columns(super, first, MOST, parts, x);
    for (; first + 2 <= columns; first += 2)
        forward_columns(super, first, 2, parts, x);
    if (first < columns) forward_columns(super, first, 1, parts, x);
}

#if BYTES == 32
void forward_four(const struct supernode *super, double *x)
{
    forward(super, 1, x);
}
#endif

static void forward_eight(const struct supernode *super, double *x)
{
    forward(super, PARTS, x);
}

// ---- the factor ---------------------------------------------------------------------

INLINE void finish_rows(double *panel, int rows, int own, int wide, int at)
{
    vector x[8];
    UNROLLED for (int j = 0; j < wide; j++)
    {
        const double pivot = panel[(long)j * rows + own + j];
        x[j] = load(panel + (long)j * rows + at);
        UNROLLED for (int l = 0; l < wide; l++) if (l < j) x[j] =
            less(x[j], panel[(long)l * rows + own + j], x[l]);
        x[j] = divided(x[j], pivot, 1 / pivot);
        store(panel + (long)j * rows + at, x[j]);
    }
}

// As finish_rows, one.
INLINE void finish_row(double *panel, int rows, int own, int wide, int at)
{
    for (int j = 0; j < wide; j++) {
        const double pivot = panel[(long)j * rows + own + j], inverse = 1 / pivot;
        double x = panel[(long)j * rows + at];
        for (int l = 0; l < j; l++)
            x = fma(-panel[(long)l * rows + own + j], panel[(long)l * rows + at], x);
        const double nearly = x * inverse;
        panel[(long)j * rows + at] = fma(fma(-nearly, pivot, x), inverse, nearly);
    }
}

static void finish_columns(const struct supernode *super, int first, int end)
{
    const int rows = super->rows, wide = end - first;
    double *panel = super->panel + (long)first * rows;
    int i = end;
    if (wide == 8)
        for (; i + NUMBERS <= rows; i += NUMBERS)
            finish_rows(panel, rows, first, 8, i);
    else if (wide == 6)
        for (; i + NUMBERS <= rows; i += NUMBERS)
            finish_rows(panel, rows, first, 6, i);
    for (; i < rows; i++)
        finish_row(panel, rows, first, wide, i);
}

// ---- products -----------------------------------------------------------------------

// SUM (TILE by the lanes of B) grows by the products of N rows of lanes of A, from the
// first on, with those of B.
INLINE void add_tile(int n, const double *a, int a_lanes, const double *b, int tile,
                     int parts, double *sum)
{
    vector part[8][PARTS];
    UNROLLED for (int i = 0; i < tile; i++) UNROLLED for (int q = 0; q < parts; q++)
        part[i][q] = load(sum + i * BATCH + NUMBERS * q);
    for (int p = 0; p < n; p++, a += a_lanes, b += NUMBERS * parts)
        UNROLLED for (int i = 0; i < tile; i++) UNROLLED for (int q = 0; q < parts; q++)
            part[i][q] = fused(all_of(a[i]), load(b + NUMBERS * q), part[i][q]);
    UNROLLED for (int i = 0; i < tile; i++) UNROLLED for (int q = 0; q < parts; q++)
        store(sum + i * BATCH + NUMBERS * q, part[i][q]);
}

#if BYTES == 32
void add_product_of_four(int n, const double *a, int a_lanes, const double *b,
                         double sum[BATCH][BATCH])
{
    if (a_lanes == 1) return add_tile(n, a, 1, b, 1, 1, sum[0]);
    for (int i = 0; i < a_lanes; i += 4)
        add_tile(n, a + i, a_lanes, b, 4, 1, sum[i]);
}
#endif

static void add_product_of_eight(int n, const double *a, int a_lanes, const double *b,
                                 double sum[BATCH][BATCH])
{
    if (a_lanes == 1) return add_tile(n, a, 1, b, 1, PARTS, sum[0]);
#if BYTES == 64
    if (a_lanes == 8) return add_tile(n, a, 8, b, 8, PARTS, sum[0]);
#endif
    for (int i = 0; i < a_lanes; i += 4)
        add_tile(n, a + i, a_lanes, b, 4, PARTS, sum[i]);
}

// A tile of TALL vectors of rows and WIDE columns stays in registers.
enum { AVX512 = NUMBERS, TALL = 3 };

// Of COUNT numbers, fewer than a vector has; when packed, zeros follow.
INLINE void store_first(double *to, vector from, int count)
{
#if defined __x86_64__ && BYTES == 64
    _mm512_mask_storeu_pd(to, (__mmask8)((1 << count) - 1), (__m512d)from);
#else
    for (int k = 0; k < count; k++)
        to[k] = from[k];
#endif
}

INLINE void pack_first(double *to, const double *from, int count)
{
#if defined __x86_64__ && BYTES == 64
    store(to, (vector)_mm512_maskz_loadu_pd((__mmask8)((1 << count) - 1), from));
#else
    for (int k = 0; k < AVX512; k++)
        to[k] = k < count ? from[k] : 0;
#endif
}

INLINE void multiply_tile(int tall, int k, const double *a, int a_stride,
                          const double *packed, double *c, int c_stride, int rows,
                          int columns)
{
    vector sum[AVX512][TALL], of_a[TALL];
    UNROLLED for (int j = 0; j < AVX512; j++) UNROLLED for (int q = 0; q < tall; q++)
        sum[j][q] = all_of(0);
    for (int p = 0; p < k; p++, a += a_stride, packed += AVX512) {
        UNROLLED for (int q = 0; q < tall; q++) of_a[q] = load(a + NUMBERS * q);
        UNROLLED for (int j = 0; j < AVX512; j++)
            UNROLLED for (int q = 0; q < tall; q++) sum[j][q] =
                fused(of_a[q], all_of(packed[j]), sum[j][q]);
    }
    UNROLLED for (int j = 0; j < AVX512; j++) UNROLLED for (int q = 0; q < tall; q++)
    {
        if (j >= columns) continue;
        double *to = c + (long)j * c_stride + NUMBERS * q;
        if (rows >= NUMBERS * (q + 1))
            store(to, sum[j][q]);
        else
            store_first(to, sum[j][q], rows - NUMBERS * q);
    }
}

static void multiply_tall(int k, const double *a, int a_stride, const double *packed,
                          double *c, int c_stride, int rows, int columns)
{
    if (rows > 2 * NUMBERS)
        multiply_tile(3, k, a, a_stride, packed, c, c_stride, rows, columns);
    else if (rows > NUMBERS)
        multiply_tile(2, k, a, a_stride, packed, c, c_stride, rows, columns);
    else
        multiply_tile(1, k, a, a_stride, packed, c, c_stride, rows, columns);
}

// WIDE columns after another, each (k * WIDE).
static void pack(int n, int k, const double *b, int b_stride, double *packed)
{
    for (int j = 0; j < n; j += AVX512)
        for (int p = 0; p < k; p++, packed += AVX512) {
            const double *row = b + (long)p * b_stride + j;
            if (n - j >= AVX512)
                store(packed, load(row));
            else
                pack_first(packed, row, n - j);
        }
}

// As many columns of B as there is room for, which stay near, then tiles of A once for
// all of these.
static void multiply(int m, int n, int k, const double *a, int a_stride,
                     const double *b, int b_stride, double *c, int c_stride, bool lower,
                     double *work)
{
    for (int first = 0; first < n; first += PACKED) {
        const int columns = n - first < PACKED ? n - first : PACKED;
        pack(columns, k, b + first, b_stride, work);
        for (int i = lower ? first : 0; i < m; i += TALL * NUMBERS) {
            const int rows = m - i < TALL * NUMBERS ? m - i : TALL * NUMBERS;
            for (int j = 0; j < columns && !(lower && first + j >= i + rows);
                 j += AVX512)
                multiply_tall(k, a + i, a_stride, work + (long)j * k,
                              c + (long)(first + j) * c_stride + i, c_stride, rows,
                              columns - j);
        }
    }
}

#include "dense_lu_kernel.h"

const struct vector_kernels NAMED(vector_kernels) = {
    .forward_eight = forward_eight,
    .finish_columns = finish_columns,
    .add_product_of_eight = add_product_of_eight,
    .multiply_transposed = multiply,
    .factor_dense = factor_dense,
};
