// SPDX-License-Identifier: GPL-3.0-or-later
// Networks to dry: cubic lattices of nodes with the grains at the centres of the cubes.
#pragma once

#include "../random.h"
#include "dry/run/drying.h"

// Counts of nodes along x, y, z; all throats of length SPACING and radius 0.2 SPACING.
// Of the faces only those on the walls, one square a grain. Freed with network_free.
struct network lattice_network(int nx, int ny, int nz, double spacing);

// One upright column of N throats that hold liquid; those beside it are imposed empty.
struct network lattice_column(int n, double spacing);

// Evenly distributed radii within (1 +- SPREAD) of 0.2 SPACING.
void randomise_radii(struct network *network, double spacing, double spread,
                     uint64_t seed);

// The throat from NODE in the direction of AXIS.
int lattice_throat(const struct network *network, int node, int axis);

// The conditions of [K Table 3.1] and 5.4, z upper open.
struct drying_conditions kharaghani_conditions(enum liquid_limit liquid);
// And with the Kelvin effect.
struct drying_conditions kelvin_conditions(enum liquid_limit liquid);

// Dries NETWORK, or the test fails.
struct drying_history dry_or_fail(const struct network *network,
                                  const struct drying_conditions *conditions);

// The same, and checks what holds for every run: balances, bounds, order, the end.
struct drying_history dry_and_check(const struct network *network,
                                    const struct drying_conditions *conditions);

// NETWORK dries, and again when it is enlarged to 2^30 times its size, about 1e9: from
// nanometres to metres. Rates go with the length, times with its square; everything
// else is the same bits. With the Kelvin effect, in a liquid whose menisci then have
// the same vapour and whose pressures are the same.
void check_dries_alike_enlarged(struct network *network,
                                struct drying_conditions conditions);
