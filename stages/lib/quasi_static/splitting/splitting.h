// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria with friction, of small displacements, in two phases: a splitting of
// grains and contacts that finds which contacts open, stick and slip
// [contact_splitting.c], then Newton's method, which ends it [coupled_newton.c]. Both
// with dashpots on grains where there is no equilibrium near [settle.c].
#pragma once

#include "../quasi_static_internal.h"

struct splitting;

// The next equilibrium under the present load. False: no rest; the iterate is the last
// state. May detach fragments.
bool settle(struct quasi_static *qs);

// The iterate keeps nothing else from load to load but which pairs are near: dropped
// here with the cache.
void splitting_free(struct splitting *splitting);
