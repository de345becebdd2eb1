// SPDX-License-Identifier: GPL-3.0-or-later
// An approximate factor of the balances of a large cluster, as preconditioner
// (elimination/approximate_cholesky.h). An exact one of a network in three dimensions
// fills in: of 20,000 nodes it has 3 million numbers, and takes several times as long
// as this one and the iterations that it costs.
#pragma once

#include "cluster_laplacian.h"

struct rough_factor;

// For a graph of N rows. The caller frees it with rough_factor_free.
struct rough_factor *rough_factor_create(int n);
void rough_factor_free(struct rough_factor *rough);

// Makes the factor of GRAPH unless there is one that is still good. O(n log n).
void rough_factor_follow(struct rough_factor *rough,
                         const struct cluster_laplacian *graph);

// Solves for Z (n) with the right-hand side B (n), of norm 1 or so, as it holds floats.
void rough_factor_apply(const struct rough_factor *rough, const double *b, double *z);

// Tells it how many STEPS conjugate gradients took for so many DECADES of the residual.
// When a decade takes more than they have on average, the time to make the factor
// included, the graph has changed: the next _follow makes another.
void rough_factor_took(struct rough_factor *rough, int steps, double decades);

// Four arrays (n) that a solver may use between calls.
double **rough_factor_scratch(struct rough_factor *rough);
