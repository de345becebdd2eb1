// SPDX-License-Identifier: GPL-3.0-or-later
// Pulls of throats that leave the grains around each throat in balance.
#pragma once

#include "solid_angle_patches.h"

// The pulls of FORM, changed as little as it takes (least squares) for each throat
// alone to leave the grains around it in balance, forces and moments, while grains that
// full throats leave at rest stay at rest. So the sum over all grains vanishes whatever
// is in the throats. Throats that lie in walls may press on these.
//
// Suction on the patches alone is not in balance in irregular networks: the liquid ends
// in menisci, whose pull is missing. Where it is in balance, as on cubic lattices, the
// pulls come back unchanged, to the last bit.
//
// If they are the LAST to ask for sectors, sectors_free_sides is called as soon as
// these are not needed, before it takes the most memory.
//
// CHANGE becomes the root mean square of the change, relative to that of the pulls.
// STATUS_NOT_CONVERGED when conjugate gradients stall. OpenMP, the same digits for any
// number of threads. The caller frees PATCHES, also after a failure.
enum status find_balanced_patches(struct sectors *sectors, enum form form, bool last,
                                  struct patches *patches, double *change,
                                  struct reason *reason);
