// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_kernels.h"

enum { WIDE = 4, HIGH = 8 };

// HIGH rows of WIDE columns, which stay in registers.
static void multiply_tile(int k, const double *a, int a_stride, const double *packed,
                          double c[WIDE][HIGH])
{
    four sum[WIDE][2] = {{{0}}};
    for (int p = 0; p < k; p++) {
        const four low = load_four(a), high = load_four(a + 4);
        for (int j = 0; j < WIDE; j++) {
            const double b = packed[WIDE * p + j];
            const four all = {b, b, b, b};
            sum[j][0] = fused(low, all, sum[j][0]);
            sum[j][1] = fused(high, all, sum[j][1]);
        }
        a += a_stride;
    }
    for (int j = 0; j < WIDE; j++)
        for (int i = 0; i < 4; i++) {
            c[j][i] = sum[j][0][i];
            c[j][4 + i] = sum[j][1][i];
        }
}

void multiply_transposed(int m, int n, int k, const double *a, int a_stride,
                         const double *b, int b_stride, double *c, int c_stride,
                         bool lower, double *work)
{
    for (int j = 0; j < n; j += WIDE) {
        const int columns = n - j < WIDE ? n - j : WIDE;
        for (int p = 0; p < k; p++)
            for (int l = 0; l < WIDE; l++)
                work[WIDE * p + l] = l < columns ? b[(long)p * b_stride + j + l] : 0;
        for (int i = lower ? j : 0; i < m; i += HIGH) {
            const int rows = m - i < HIGH ? m - i : HIGH;
            double tile[WIDE][HIGH];
            multiply_tile(k, a + i, a_stride, work, tile);
            for (int l = 0; l < columns; l++)
                for (int r = 0; r < rows; r++)
                    c[(long)(j + l) * c_stride + i + r] = tile[l][r];
        }
    }
}
