// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense symmetric systems without pivoting, where it is known which pivots are
// negative.
#ifndef CRAQUELURE_DENSE_SYMMETRIC_H
#define CRAQUELURE_DENSE_SYMMETRIC_H

#include <stdbool.h>

// MATRIX (n by n, its lower triangle by columns STRIDE apart, eight numbers more at the
// end) becomes L of L S L^T, with what 1 over is on its diagonal; S is that of SIGN
// (n), 1 or -1. WORK (DENSE_SYMMETRIC_WORK n). False: a pivot has not that sign. The
// first DONE rows and columns are those of an earlier one, of which the first
// dense_symmetric_kept(done) columns hold L in those rows still, and the matrix in the
// others, as all other columns do.
enum { DENSE_SYMMETRIC_WORK = 144 };
bool dense_symmetric_factor(int n, int done, double *matrix, int stride,
                            const double *sign, double *work);
int dense_symmetric_kept(int done);

// The right-hand side X (n) becomes the answer.
void dense_symmetric_solve(int n, const double *matrix, int stride, const double *sign,
                           double *x);

#endif
