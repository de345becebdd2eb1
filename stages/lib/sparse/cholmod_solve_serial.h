// SPDX-License-Identifier: GPL-3.0-or-later
// Solution with a factor of CHOLMOD: simplicial, L D L'.
#ifndef CRAQUELURE_PLAIN_SOLVE_H
#define CRAQUELURE_PLAIN_SOLVE_H

#include <cholmod.h>

// X (n), the right side, becomes the solution, both in the factor's own order. WORK has
// room for n. About three times as fast as cholmod_solve2 where the factor has many
// columns alike.
void cholmod_solve_serial(const cholmod_factor *factor, double *x, double *work);

#endif
