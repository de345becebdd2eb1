// SPDX-License-Identifier: GPL-3.0-or-later
// Corrects the potentials of a large cluster by conjugate gradients with an approximate
// factor (elimination/approximate_cholesky.h). An exact factor of a network in three
// dimensions fills in: of 20,000 nodes it has 3 million numbers, and takes ten times as
// long as this one and the iterations that it costs.
#pragma once

#include "cluster_laplacian.h"

struct rough_factor;

// For a graph of N rows. The caller frees it with rough_factor_free.
struct rough_factor *rough_factor_create(int n);
void rough_factor_free(struct rough_factor *rough);

// As cluster_laplacian_correct. The factor is made anew when conjugate gradients take
// more steps than at first, as the graph has changed.
void rough_factor_correct(struct rough_factor *rough, struct cluster_laplacian *graph,
                          double tolerance);
