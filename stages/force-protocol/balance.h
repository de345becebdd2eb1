// SPDX-License-Identifier: GPL-3.0-or-later
// Throats that pull the grains around them without moving or turning these as a whole.
#ifndef CRAQUELURE_BALANCE_H
#define CRAQUELURE_BALANCE_H

#include "solid_angle_patches.h"

// The pulls of FORM, changed as little as it takes (least squares) for each throat
// alone to leave the grains around it in balance, forces and moments, while grains that
// full throats leave at rest stay at rest. So the sum over all grains vanishes whatever
// is in the throats. Throats that lie in walls may press on these.
//
// Suction on the patches by itself is not in balance in irregular networks: menisci end
// the liquid, and their pull is missing. Where it is, as on cubic lattices, pulls come
// back as they were, to the last bit.
//
// CHANGE: how much it was, root mean square, of the pulls. STATUS_NOT_CONVERGED when
// conjugate gradients stall. OpenMP, the same digits for any number of threads. The
// caller frees PATCHES, also after a failure.
enum status find_balanced_patches(struct sectors *sectors, enum form form,
                                  struct patches *patches, double *change,
                                  struct reason *reason);

#endif
