// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients for the balances of the pores.
#ifndef CRAQUELURE_FLOW_CONJUGATE_GRADIENTS_H
#define CRAQUELURE_FLOW_CONJUGATE_GRADIENTS_H

#include "matrix.h"
#include "sampled_factor.h"

// Solves MATRIX X = B from X = 0, preconditioned by FACTOR, until the residual is
// REDUCTION of B in the norm, or after MOST iterations. Returns how many were done. The
// same digits for any number of threads.
int conjugate_gradients(const struct matrix *matrix, struct sampled_factor *factor,
                        const double *b, double *x, double reduction, int most);

#endif
