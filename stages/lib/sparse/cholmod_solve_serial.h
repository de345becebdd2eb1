// SPDX-License-Identifier: GPL-3.0-or-later
// Solution with a factor of CHOLMOD: simplicial, L D L'. FACTOR must be what
// cholmod_analyze and cholmod_factorize made with cholmod_serial_start: neither
// supernodal nor L L'. No permutation is applied: whoever calls knows the order
// (factor->Perm).
#pragma once

#include <cholmod.h>

// X (n), the right side, becomes the solution, both in the factor's own order. WORK (n)
// is overwritten. About three times as fast as cholmod_solve2 where many columns are
// alike. No allocation and no failure.
void cholmod_solve_serial(const cholmod_factor *factor, double *x, double *work);
