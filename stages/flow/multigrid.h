// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients, preconditioned by aggregation multigrid with K-cycles (Y. Notay,
// An aggregation-based algebraic multigrid method, Electron. Trans. Numer. Anal. 37,
// 123, 2010).
#ifndef CRAQUELURE_FLOW_MULTIGRID_H
#define CRAQUELURE_FLOW_MULTIGRID_H

#include "matrix.h"

struct multigrid;

// Coarsens: pores are joined in pairs along their widest throat, and the pairs again.
// MATRIX must outlive it. The caller frees with multigrid_free.
struct multigrid *multigrid_make(const struct matrix *matrix);
void multigrid_free(struct multigrid *multigrid);

// Solves MATRIX X = B from X = 0 until the residual is REDUCTION of B in the norm, or
// nothing is gained any more, or after MOST iterations. Returns how many were done. The
// same digits for any number of threads.
int multigrid_solve(struct multigrid *multigrid, const double *b, double *x,
                    double reduction, int most);

#endif
