// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense systems by LU with partial pivoting.
#ifndef CRAQUELURE_DENSE_LU_H
#define CRAQUELURE_DENSE_LU_H

#include <stdbool.h>

enum { DENSE_PANEL = 16 };

// Factors MATRIX (n by n, rows STRIDE apart) in place; ROW (n) becomes the order of its
// rows. WORK (n * DENSE_PANEL). Returns false if it is singular.
bool dense_factor(int n, double *matrix, int stride, int *row, double *work);

// Solves with such a factor for RIGHT (n) into ANSWER (n), another array.
void dense_substitute(int n, const double *matrix, int stride, const int *row,
                      const double *right, double *answer);

#endif
