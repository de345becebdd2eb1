// SPDX-License-Identifier: GPL-3.0-or-later
// dense_lu.h's factor, after vector_kernels_of.h: columns by panels, so that the
// rest is read and written as much less often. Every number is what row by row and
// column by column would make it.

enum { SIDE = 2 * NUMBERS, HEIGHT = NUMBERS == 8 ? 8 : 4 }; // of a tile in registers

// The first of the largest; -1: there is none above 0.
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

// TO -= SHARE FROM
INLINE void take_off_column(int n, double share, const double *restrict from,
                            double *restrict to)
{
    int k = 0;
    for (; k + NUMBERS <= n; k += NUMBERS)
        store(to + k, fused(all_of(-share), load(from + k), load(to + k)));
    for (; k < n; k++)
        to[k] = fma(-share, from[k], to[k]);
}

// WIDTH columns of PANEL, HEIGHT numbers each.
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
            take_off_column(height - k - 1, other[k], column + k + 1, other + k + 1);
        }
    }
    return true;
}

// What the first WIDTH of ROW are in COLUMNS columns from LAST on, below the panel's
// triangle in columns FIRST on; and its opposite in TILE.
static void finish_pivots(double *matrix, int stride, const int *row, int width,
                          int first, int last, int columns, double tile[][SIDE])
{
    for (int p = 0; p < width; p++) {
        double *to = matrix + (long)row[p] * stride;
        memset(tile[p], 0, sizeof tile[p]);
        memcpy(tile[p], to + last, (size_t)columns * sizeof *to);
        vector left[2] = {load(tile[p]), load(tile[p] + NUMBERS)};
        for (int i = 0; i < p; i++)
            for (int q = 0; q < 2; q++)
                left[q] =
                    fused(all_of(to[first + i]), load(tile[i] + NUMBERS * q), left[q]);
        for (int q = 0; q < 2; q++)
            store(tile[p] + NUMBERS * q, left[q]);
        memcpy(to + last, tile[p], (size_t)columns * sizeof *to);
        for (int q = 0; q < 2; q++)
            store(tile[p] + NUMBERS * q, -left[q]);
    }
}

// ROWS rows of numbers TO grow by WIDTH of SHARE times the rows of TILE.
INLINE void add_tile_rows(int rows, int width, double *const share[],
                          double *const to[], double tile[][SIDE])
{
    vector sum[HEIGHT][2];
    for (int r = 0; r < rows; r++)
        for (int q = 0; q < 2; q++)
            sum[r][q] = load(to[r] + NUMBERS * q);
    for (int p = 0; p < width; p++)
        for (int r = 0; r < rows; r++)
            for (int q = 0; q < 2; q++)
                sum[r][q] =
                    fused(all_of(share[r][p]), load(tile[p] + NUMBERS * q), sum[r][q]);
    for (int r = 0; r < rows; r++)
        for (int q = 0; q < 2; q++)
            store(to[r] + NUMBERS * q, sum[r][q]);
}

// The same of COUNT rows of the matrix, in COLUMNS columns from LAST on.
static void take_off_rows(double *matrix, int stride, const int *row, int count,
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
            take_off_rows(matrix, stride, row + end, n - end, width, first, last,
                          columns, tile);
        }
    }
    return true;
}
