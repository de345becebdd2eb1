// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense systems by Gauss, with the largest pivot of each column.
#ifndef CRAQUELURE_DENSE_SYSTEM_H
#define CRAQUELURE_DENSE_SYSTEM_H

#include <stdbool.h>

enum { DENSE_PANEL = 16 };

// Factors MATRIX (n by n, rows STRIDE apart) in place; ROW (n) becomes the order of its
// rows. WORK (n * DENSE_PANEL). False: it is singular.
bool dense_factor(int n, double *matrix, int stride, int *row, double *work);

// ANSWER (n), which is not RIGHT (n).
void dense_substitute(int n, const double *matrix, int stride, const int *row,
                      const double *right, double *answer);

#endif
