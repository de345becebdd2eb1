// SPDX-License-Identifier: GPL-3.0-or-later
// The factor of dense_lu.h, right-looking by panels of DENSE_PANEL columns; for
// vector_kernels_template.h. In each panel: copy its columns, factor them with row
// exchanges in `row` only, copy back; then finish the pivot rows right of the panel
// (finish_pivots) and subtract L U from the rows below, tile by tile (subtract_rows).
// The panels reduce memory traffic; every number is what elimination column by column
// gives.
//
// Layout: entry (r, c) of the matrix at matrix[row[r] stride + c]; rows never move,
// only their order in `row`. The panel in `work` is a copy column by column, entry (r,
// k) at work[k height + r]. In code order, per panel
//     pivot: the row with the largest |a_rk|, r >= k, the first of equals;
//     L_rk = a_rk / a_kk,  a_rl -= L_rk a_kl for l in the panel,
//     then right of it U_pc = a_pc - sum_{i<p} L_pi U_ic,  a_rc -= sum_p L_rp U_pc.
// A column without a number above 0 makes the matrix singular: false.
//
// Afterwards entry (row[r], c) is U_rc for c >= r and L_rc below, whose diagonal of
// ones is not kept: P A = L U with row r of P A the row row[r] of A. dense_substitute
// reads just that.
//
// Cost: 2/3 n^3 operations, nearly all in add_tile_rows, whose tile of HEIGHT rows and
// SIDE columns fills 8 (AVX2) or 16 (AVX-512) registers while it goes through a panel's
// DENSE_PANEL products. A panel of n rows is read from WORK column after column, where
// it is contiguous. Memory besides: WORK and a tile of DENSE_PANEL by SIDE numbers on
// the stack.
//
// Trap: a NAN is never the pivot, as no comparison with it holds; it spreads through
// the rows and shows in the answer, not in what dense_factor returns.

enum {
    SIDE = 2 * SIMD_WIDTH,
    HEIGHT = SIMD_WIDTH == 8 ? 8 : 4
}; // of a tile in registers

// The first of the largest; -1: there is none above 0. Lane by lane first, so that the
// loop has no branch; then the place of the largest is looked up. Comparing only, so
// the choice is the same on all processors. O(n), reads only.
static int find_pivot(int n, const double *column)
{
    double largest[SIDE] = {0}, most = 0;
    int k = 0;
    for (; k + SIDE <= n; k += SIDE)
        for (int l = 0; l < SIDE; l++) {
            const double size = fabs(column[k + l]);
            largest[l] = size > largest[l] ? size : largest[l];
        }
    for (; k < n; k++)
        if (fabs(column[k]) > most) most = fabs(column[k]);
    for (int l = 0; l < SIDE; l++)
        if (largest[l] > most) most = largest[l];
    for (k = 0; k < n && most > 0; k++)
        if (fabs(column[k]) == most) return k;
    return -1;
}

// In the panel numbers move; in the matrix only ROW does. ROW and PANEL count from the
// top of the panel; HEIGHT is the stride of its columns. L and U of earlier panels stay
// in the matrix and go with `row`.
static void exchange_rows(double *panel, int height, int width, int *row, int k, int l)
{
    const int other = row[k];
    row[k] = row[l];
    row[l] = other;
    for (; width > 0; width--, panel += height) {
        const double number = panel[k];
        panel[k] = panel[l];
        panel[l] = number;
    }
}

// TO -= SHARE FROM. Fused, in the lanes and in the rest alike.
SIMD_INLINE void subtract_column(int n, double share, const double *restrict from,
                                 double *restrict to)
{
    int k = 0;
    for (; k + SIMD_WIDTH <= n; k += SIMD_WIDTH)
        store_unaligned(to + k, fmadd(splat(-share), load_unaligned(from + k),
                                      load_unaligned(to + k)));
    for (; k < n; k++)
        to[k] = fma(-share, from[k], to[k]);
}

// WIDTH columns of PANEL, HEIGHT numbers each. Right-looking: after column k all later
// columns of the panel are up to date. On false a part of ROW is exchanged already.
static bool factor_panel(double *panel, int height, int width, int *row)
{
    for (int k = 0; k < width; k++) {
        double *column = panel + (long)k * height;
        const int pivot = find_pivot(height - k, column + k);
        if (pivot < 0) return false;
        exchange_rows(panel, height, width, row, k, k + pivot);
        const double by = column[k];
        for (int r = k + 1; r < height; r++)
            column[r] /= by;
        for (int l = k + 1; l < width; l++) {
            double *other = panel + (long)l * height;
            subtract_column(height - k - 1, other[k], column + k + 1, other + k + 1);
        }
    }
    return true;
}

// What the first WIDTH of ROW are in COLUMNS columns from LAST on, below the panel's
// triangle in columns FIRST on; and its opposite in TILE. In rising order of the
// pivots, each with those before it in TILE. The opposite, because add_tile_rows adds.
// With FIRST, LAST columns of the matrix. COLUMNS <= SIDE; the rest of TILE is 0.
static void finish_pivots(double *matrix, int stride, const int *row, int width,
                          int first, int last, int columns, double tile[][SIDE])
{
    for (int p = 0; p < width; p++) {
        double *to = matrix + (long)row[p] * stride;
        memset(tile[p], 0, sizeof tile[p]);
        memcpy(tile[p], to + last, (size_t)columns * sizeof *to);
        doublew left[2] = {load_unaligned(tile[p]),
                           load_unaligned(tile[p] + SIMD_WIDTH)};
        for (int i = 0; i < p; i++)
            for (long q = 0; q < 2; q++)
                left[q] = fmadd(splat(to[first + i]),
                                load_unaligned(tile[i] + SIMD_WIDTH * q), left[q]);
        for (long q = 0; q < 2; q++)
            store_unaligned(tile[p] + SIMD_WIDTH * q, left[q]);
        memcpy(to + last, tile[p], (size_t)columns * sizeof *to);
        for (long q = 0; q < 2; q++)
            store_unaligned(tile[p] + SIMD_WIDTH * q, -left[q]);
    }
}

// ROWS rows of numbers TO grow by WIDTH of SHARE times the rows of TILE. HEIGHT by SIDE
// sums stay in registers over all WIDTH products.
SIMD_INLINE void add_tile_rows(int rows, int width, double *const share[],
                               double *const to[], double tile[][SIDE])
{
    doublew sum[HEIGHT][2];
    for (int r = 0; r < rows; r++)
        for (long q = 0; q < 2; q++)
            sum[r][q] = load_unaligned(to[r] + SIMD_WIDTH * q);
    for (int p = 0; p < width; p++)
        for (int r = 0; r < rows; r++)
            for (long q = 0; q < 2; q++)
                sum[r][q] = fmadd(splat(share[r][p]),
                                  load_unaligned(tile[p] + SIMD_WIDTH * q), sum[r][q]);
    for (int r = 0; r < rows; r++)
        for (long q = 0; q < 2; q++)
            store_unaligned(to[r] + SIMD_WIDTH * q, sum[r][q]);
}

// The same of COUNT rows of the matrix, in COLUMNS columns from LAST on. A tile that
// the matrix does not fill is worked on in EDGE and copied back; rows beyond the last
// repeat the first of the tile and are dropped. ROW begins below the panel's pivots.
// Rows are independent: none reads what another writes.
static void subtract_rows(double *matrix, int stride, const int *row, int count,
                          int width, int first, int last, int columns,
                          double tile[][SIDE])
{
    double edge[HEIGHT][SIDE] = {{0}};
    for (int k = 0; k < count; k += HEIGHT) {
        const int rows = count - k < HEIGHT ? count - k : HEIGHT;
        double *share[HEIGHT], *to[HEIGHT];
        for (int r = 0; r < HEIGHT; r++) {
            double *at = matrix + (long)row[k + (r < rows ? r : 0)] * stride;
            share[r] = at + first;
            to[r] = columns == SIDE && r < rows ? at + last : edge[r];
            if (columns < SIDE && r < rows)
                memcpy(edge[r], at + last, (size_t)columns * sizeof *at);
        }
        add_tile_rows(HEIGHT, width, share, to, tile);
        for (int r = 0; r < rows && columns < SIDE; r++)
            memcpy(share[r] - first + last, edge[r], (size_t)columns * sizeof **edge);
    }
}

// Panel by panel, then SIDE columns at a time right of it. The function of the table
// vector_kernels; arguments as dense_factor in dense_lu.h.
static bool factor_dense(int n, double *matrix, int stride, int *row, double *work)
{
    for (int k = 0; k < n; k++)
        row[k] = k;
    for (int first = 0; first < n; first += DENSE_PANEL) {
        const int width = n - first < DENSE_PANEL ? n - first : DENSE_PANEL;
        const int end = first + width, height = n - first;
        for (int r = 0; r < height; r++)
            for (int k = 0; k < width; k++)
                work[(long)k * height + r] =
                    matrix[(long)row[first + r] * stride + first + k];
        if (!factor_panel(work, height, width, row + first)) return false;
        for (int r = 0; r < height; r++)
            for (int k = 0; k < width; k++)
                matrix[(long)row[first + r] * stride + first + k] =
                    work[(long)k * height + r];
        for (int last = end; last < n; last += SIDE) {
            const int columns = n - last < SIDE ? n - last : SIDE;
            double tile[DENSE_PANEL][SIDE];
            finish_pivots(matrix, stride, row + first, width, first, last, columns,
                          tile);
            subtract_rows(matrix, stride, row + end, n - end, width, first, last,
                          columns, tile);
        }
    }
    return true;
}
