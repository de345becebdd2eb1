// SPDX-License-Identifier: GPL-3.0-or-later
// What tables are made of, from exact solutions; for the files that make them.
#pragma once

#include "bridges/equilibrium.h"
#include "bridges/table_layout.h"

// Chebyshev's node K of COUNT, from 1 down to -1. cos(pi (k + 1/2) / count):
// polynomials through these oscillate least.
double chebyshev_node(int k, int count);
// Interpolates VALUE at COUNT of them, at most TURNING_ORDER; gives the coefficients of
// powers. VALUE at the nodes in their order. By the discrete cosine transform of the
// values, then from Chebyshev's polynomials to powers; POWER (COUNT), the constant
// first.
void fit_polynomial(const double *value, int count, double *power);

// F (1 + a/C)^2 at the ORDER nodes of all places in zeta, for one volume, with A and C
// as AT has them at U. STATUS_OK or STATUS_NOT_CONVERGED.
enum { SAMPLES = PLACES * ORDER };
enum status sample_forces(const struct bodies *bodies, double volume,
                          const struct volume_patch *at, double u,
                          double values[SAMPLES]);

// Interpolates VALUE of as many VOLUMES, at most TURNING_ORDER and even, by the ORDER
// nodes of PLACE; the coefficients go to ROW (VOLUMES / 2).
void fit_place(int volumes, const double value[][SAMPLES], size_t place, float8 row[]);

// The patch PATCH of TABLE, of bridges between BODIES: how gaps become zeta, where in
// zeta they rupture (0 everywhere: at zeta 0) and the forces. STATUS_OK or
// STATUS_NOT_CONVERGED.
enum status fill_patch(const struct bodies *bodies, int patch,
                       struct bridge_table *table);
