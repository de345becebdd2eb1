// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense systems by LU with partial pivoting. For matrices of up to some hundred
// rows that fit into the cache: the rows of slipping contacts. Panels of DENSE_PANEL
// columns; the arithmetic is that of elimination column by column, in one order, the
// same with AVX2 and AVX-512 (dense_lu_kernel.h).
#pragma once

#include <stdbool.h>

enum { DENSE_PANEL = 16 };

// Factors MATRIX (n by n, rows STRIDE apart) in place; ROW (n) becomes the order of its
// rows. WORK (n * DENSE_PANEL). Returns false if it is singular. On false MATRIX and
// ROW have no meaning. WORK is overwritten.
bool dense_factor(int n, double *matrix, int stride, int *row, double *work);

// Solves with such a factor for RIGHT (n) into ANSWER (n), another array. O(n^2); the
// factor stays as it is.
void dense_substitute(int n, const double *matrix, int stride, const int *row,
                      const double *right, double *answer);
