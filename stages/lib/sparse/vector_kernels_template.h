// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of vector_kernels.h, compiled once for AVX2 and once for AVX-512; the
// files that include this define SIMD_WIDTH and NAMED(x), the name of x. Each number
// has the same digits in both: fused products in one order.
//
// Forward solves take up to MOST columns of a supernode at once, so that each row is
// read once for all of them. Products keep a tile of TILE_COLUMNS by TALL vectors in
// registers, with B packed so that its numbers come in order.
//
// Layout: a panel is column by column, L_ij at panel[j rows + i]; right-hand sides lie
// side by side, lane q of row i at x[row[i] lanes + q]. In code order
//     forward   x_j = (x_j - sum_{l<j} L_jl x_l) / L_jj, then x_i -= L_ij x_j below;
//     finish    L_ij = (A_ij - sum_{l<j} L_jl L_il) / L_jj;
//     add_tile  sum_il += sum_p a_pi b_pl, p over rows, i and l over lanes;
//     multiply  C_ij = sum_p A_ip B_jp, A_ip at a[p a_stride + i], C by columns too.
// Numbers are in the units of the matrix.
//
// Why these tiles: AVX2 has 16 registers, AVX-512 has 32. A product keeps TALL times
// TILE_COLUMNS sums, TALL of A and one of B: 12 + 3 + 1 or 24 + 3 + 1. A forward solve
// keeps MOST columns by PARTS vectors, 12 or 6, and one row. So no sum leaves its
// register before it is complete, and loads are fewer than products.
//
// How both widths agree: a number is always made by one lane, with the same fused
// operations in the same order; lanes are never added up here. Rows that do not fill a
// vector are made by the scalar twin of the vector code (finish_row) or in a vector
// whose surplus is not stored.
#include "basics/simd.h"
#include "dense_lu.h"
#include "supernodal_internal.h"
#include "vector_kernels.h"

#include <math.h>
#include <string.h>

enum { PARTS = BATCH / SIMD_WIDTH };

// C - A B. Rounded once; A is the same for all lanes.
SIMD_INLINE doublew subtract_product(doublew c, double a, doublew b)
{
    return fnmadd(splat(a), b, c);
}

// Loops over values that stay in registers: their bounds are constants where they are
// inlined. Parts innermost: a number is read once for all of a row.
#define UNROLLED _Pragma("GCC unroll 8")

// A / B with the INVERSE of B at hand: one Newton step,
//     x = A inverse,  x + (A - x B) inverse,
// makes it as exact as a division, and it is much sooner done. The same on all
// processors: each operation is rounded as IEEE 754 says. B of 0 gives NAN, where a
// division may give an infinite number.
SIMD_INLINE doublew divided(doublew a, double b, double inverse)
{
    const doublew nearly = a * splat(inverse);
    return fmadd(fmadd(-nearly, splat(b), a), splat(inverse), nearly);
}

// ---- lanes through a supernode ------------------------------------------------------

// The lanes of the Ith row of SUPER. X has PARTS vectors of lanes a row.
SIMD_INLINE double *lanes_of(const struct supernode *super, int i, int parts, double *x)
{
    return x + (long)super->row[i] * SIMD_WIDTH * parts;
}

// Columns of a grain lie together: six at a time, then the rest.
enum { MOST = 6 };

// WIDE columns from FIRST on. First the triangle of these columns, whose X stay in
// registers (`own`), then all rows below lose WIDE products each, in the order of the
// columns. WIDE and PARTS are constants where it is inlined.
SIMD_INLINE void forward_columns(const struct supernode *super, int first, int wide,
                                 int parts, double *x)
{
    const int rows = super->rows;
    const double *panel = super->panel + (long)first * rows;
    doublew own[MOST][PARTS];
    UNROLLED for (int j = 0; j < wide; j++)
    {
        double *at = lanes_of(super, first + j, parts, x);
        const double pivot = panel[(long)j * rows + first + j];
        UNROLLED for (long q = 0; q < parts; q++)
        {
            own[j][q] = load_unaligned(at + SIMD_WIDTH * q);
            UNROLLED for (int l = 0; l < wide; l++) if (l < j) own[j][q] =
                subtract_product(own[j][q], panel[(long)l * rows + first + j],
                                 own[l][q]);
            own[j][q] = divided(own[j][q], pivot, 1 / pivot);
            store_unaligned(at + SIMD_WIDTH * q, own[j][q]);
        }
    }
    for (int i = first + wide; i < rows; i++) {
        double *at = lanes_of(super, i, parts, x);
        doublew left[PARTS];
        UNROLLED for (long q = 0; q < parts; q++) left[q] =
            load_unaligned(at + SIMD_WIDTH * q);
        UNROLLED for (int j = 0; j < wide; j++)
            UNROLLED for (long q = 0; q < parts; q++) left[q] =
                subtract_product(left[q], panel[(long)j * rows + i], own[j][q]);
        UNROLLED for (long q = 0; q < parts; q++)
            store_unaligned(at + SIMD_WIDTH * q, left[q]);
    }
}

// SUPER's part of the forward solve for PARTS vectors of lanes. Six columns are the six
// unknowns of a grain: most supernodes have a multiple of that.
SIMD_INLINE void forward(const struct supernode *super, int parts, double *x)
{
    const int columns = super->columns;
    int first = 0;
    for (; first + MOST <= columns; first += MOST)
        forward_columns(super, first, MOST, parts, x);
    for (; first + 2 <= columns; first += 2)
        forward_columns(super, first, 2, parts, x);
    if (first < columns) forward_columns(super, first, 1, parts, x);
}

#if SIMD_WIDTH == 4
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

// SIMD_WIDTH rows from AT on of WIDE columns, whose own triangle begins at row OWN. As
// forward_columns, with rows of the panel in place of right sides: row i of the factor
// solves a triangular system, too.
SIMD_INLINE void finish_rows(double *panel, int rows, int own, int wide, int at)
{
    doublew x[8];
    UNROLLED for (int j = 0; j < wide; j++)
    {
        const double pivot = panel[(long)j * rows + own + j];
        x[j] = load_unaligned(panel + (long)j * rows + at);
        UNROLLED for (int l = 0; l < wide; l++) if (l < j) x[j] =
            subtract_product(x[j], panel[(long)l * rows + own + j], x[l]);
        x[j] = divided(x[j], pivot, 1 / pivot);
        store_unaligned(panel + (long)j * rows + at, x[j]);
    }
}

// As finish_rows, one. The same operations in the same order as a lane of finish_rows.
SIMD_INLINE void finish_row(double *panel, int rows, int own, int wide, int at)
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

// WIDE is a constant where finish_rows is inlined, for the two widths that matter.
static void finish_columns(const struct supernode *super, int first, int end)
{
    const int rows = super->rows, wide = end - first;
    double *panel = super->panel + (long)first * rows;
    int i = end;
    if (wide == 8)
        for (; i + SIMD_WIDTH <= rows; i += SIMD_WIDTH)
            finish_rows(panel, rows, first, 8, i);
    else if (wide == 6)
        for (; i + SIMD_WIDTH <= rows; i += SIMD_WIDTH)
            finish_rows(panel, rows, first, 6, i);
    for (; i < rows; i++)
        finish_row(panel, rows, first, wide, i);
}

// ---- products -----------------------------------------------------------------------

// SUM (TILE by the lanes of B) grows by the products of N rows of lanes of A, from the
// first on, with those of B. TILE columns of A by all lanes of B, in registers over all
// N rows. B has PARTS vectors a row. Lanes beyond the columns that count hold 0, so
// they add 0.
SIMD_INLINE void add_tile(int n, const double *a, int a_lanes, const double *b,
                          int tile, int parts, double *sum)
{
    doublew part[8][PARTS];
    UNROLLED for (int i = 0; i < tile; i++) UNROLLED for (long q = 0; q < parts; q++)
        part[i][q] = load_unaligned(sum + (long)i * BATCH + SIMD_WIDTH * q);
    for (int p = 0; p < n; p++, a += a_lanes, b += (long)SIMD_WIDTH * parts)
        UNROLLED for (int i = 0; i < tile; i++)
            UNROLLED for (long q = 0; q < parts; q++) part[i][q] =
                fmadd(splat(a[i]), load_unaligned(b + SIMD_WIDTH * q), part[i][q]);
    UNROLLED for (int i = 0; i < tile; i++) UNROLLED for (long q = 0; q < parts; q++)
        store_unaligned(sum + (long)i * BATCH + SIMD_WIDTH * q, part[i][q]);
}

#if SIMD_WIDTH == 4
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
#if SIMD_WIDTH == 8
    if (a_lanes == 8) return add_tile(n, a, 8, b, 8, PARTS, sum[0]);
#endif
    for (int i = 0; i < a_lanes; i += 4)
        add_tile(n, a + i, a_lanes, b, 4, PARTS, sum[i]);
}

// A tile of TALL vectors of rows and WIDE columns stays in registers.
enum { TILE_COLUMNS = SIMD_WIDTH, TALL = 3 };

// The first COUNT numbers of a vector; when packed, zeros follow. What lies behind
// these numbers in memory stays.
SIMD_INLINE void store_first(double *to, doublew from, int count)
{
#if defined SIMD_AVX512
    _mm512_mask_storeu_pd(to, (__mmask8)((1 << count) - 1), (__m512d)from);
#else
    for (int k = 0; k < count; k++)
        to[k] = from[k];
#endif
}

SIMD_INLINE void pack_first(double *to, const double *from, int count)
{
#if defined SIMD_AVX512
    store_unaligned(to,
                    (doublew)_mm512_maskz_loadu_pd((__mmask8)((1 << count) - 1), from));
#else
    for (int k = 0; k < TILE_COLUMNS; k++)
        to[k] = k < count ? from[k] : 0;
#endif
}

// C gets TALL vectors of rows (ROWS of them count) by TILE_COLUMNS (COLUMNS count):
// sums over K, one fused operation each, in rising order. A is read beyond its last
// row, up to a whole vector: callers leave room for that (dense_kernels.h).
SIMD_INLINE void multiply_tile(int tall, int k, const double *a, int a_stride,
                               const double *packed, double *c, int c_stride, int rows,
                               int columns)
{
    doublew sum[TILE_COLUMNS][TALL], of_a[TALL];
    UNROLLED for (int j = 0; j < TILE_COLUMNS; j++)
        UNROLLED for (long q = 0; q < tall; q++) sum[j][q] = splat(0);
    for (int p = 0; p < k; p++, a += a_stride, packed += TILE_COLUMNS) {
        UNROLLED for (long q = 0; q < tall; q++) of_a[q] =
            load_unaligned(a + SIMD_WIDTH * q);
        UNROLLED for (int j = 0; j < TILE_COLUMNS; j++)
            UNROLLED for (long q = 0; q < tall; q++) sum[j][q] =
                fmadd(of_a[q], splat(packed[j]), sum[j][q]);
    }
    UNROLLED for (int j = 0; j < TILE_COLUMNS; j++)
        UNROLLED for (int q = 0; q < tall; q++)
    {
        if (j >= columns) continue;
        double *to = c + (long)j * c_stride + (long)SIMD_WIDTH * q;
        if (rows >= SIMD_WIDTH * (q + 1))
            store_unaligned(to, sum[j][q]);
        else
            store_first(to, sum[j][q], rows - SIMD_WIDTH * q);
    }
}

// The fewest vectors that hold the ROWS.
static void multiply_tall(int k, const double *a, int a_stride, const double *packed,
                          double *c, int c_stride, int rows, int columns)
{
    if (rows > 2 * SIMD_WIDTH)
        multiply_tile(3, k, a, a_stride, packed, c, c_stride, rows, columns);
    else if (rows > SIMD_WIDTH)
        multiply_tile(2, k, a, a_stride, packed, c, c_stride, rows, columns);
    else
        multiply_tile(1, k, a, a_stride, packed, c, c_stride, rows, columns);
}

// TILE_COLUMNS columns at a time, each (k * TILE_COLUMNS). So the innermost loop reads
// B number after number, whatever its stride. Places beyond N hold 0. PACKED needs
// ceil(n / TILE_COLUMNS) TILE_COLUMNS k numbers.
static void pack(int n, int k, const double *b, int b_stride, double *packed)
{
    for (int j = 0; j < n; j += TILE_COLUMNS)
        for (int p = 0; p < k; p++, packed += TILE_COLUMNS) {
            const double *row = b + (long)p * b_stride + j;
            if (n - j >= TILE_COLUMNS)
                store_unaligned(packed, load_unaligned(row));
            else
                pack_first(packed, row, n - j);
        }
}

// Takes as many columns of B as fit into WORK, then tiles of A once for all of these.
// Where LOWER, tiles wholly above the diagonal are left out. WORK (PACKED * k). A tile
// of C is written once, not added to.
static void multiply(int m, int n, int k, const double *a, int a_stride,
                     const double *b, int b_stride, double *c, int c_stride, bool lower,
                     double *work)
{
    for (int first = 0; first < n; first += PACKED) {
        const int columns = n - first < PACKED ? n - first : PACKED;
        pack(columns, k, b + first, b_stride, work);
        for (int i = lower ? first : 0; i < m; i += TALL * SIMD_WIDTH) {
            const int rows = m - i < TALL * SIMD_WIDTH ? m - i : TALL * SIMD_WIDTH;
            for (int j = 0; j < columns && !(lower && first + j >= i + rows);
                 j += TILE_COLUMNS)
                multiply_tall(k, a + i, a_stride, work + (long)j * k,
                              c + (long)(first + j) * c_stride + i, c_stride, rows,
                              columns - j);
        }
    }
}

#include "dense_lu_kernel.h"

// What vector_kernels() of vector_kernels.h returns on such a processor.
const struct vector_kernels NAMED(vector_kernels) = {
    .forward_eight = forward_eight,
    .finish_columns = finish_columns,
    .add_product_of_eight = add_product_of_eight,
    .multiply_transposed = multiply,
    .factor_dense = factor_dense,
};
