// SPDX-License-Identifier: GPL-3.0-or-later
// A lattice of bonded grains whose bonds are broken by hand, for the tests of
// crackstats.
#pragma once

#include "../../test.h"
#include "basics/memory.h"
#include "crackstats/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- a lattice of grains ------------------------------------------------------------

// NX x NY x NZ grains of radius 1/2; bonded to their neighbours, around the box along x
// when it repeats there. Unit spacing, far from the origin.
static const struct vector corner = {-3, 8, -21};

static inline struct run lattice(int nx, int ny, int nz, bool periodic_x)
{
    const int n = nx * ny * nz;
    struct run run = {
        .packing = {.n_particle = n,
                    .position = NEW_ARRAY(struct vector, n),
                    .radius = NEW_ARRAY(double, n),
                    .lower = corner,
                    .upper = {corner.x + nx, corner.y + ny, corner.z + nz},
                    .periodic = {periodic_x, 0, 0},
                    .bond = allocate(3 * (size_t)n, sizeof(int32_t[2]))}};
    struct packing *packing = &run.packing;
    for (int i = 0; i < n; i++) {
        const int x = i % nx, y = i / nx % ny, z = i / nx / ny;
        packing->position[i] = add(corner, (struct vector){x + 0.5, y + 0.5, z + 0.5});
        packing->radius[i] = 0.5;
        const int next[3] = {x + 1 < nx             ? i + 1
                             : periodic_x && nx > 2 ? i - x
                                                    : -1,
                             y + 1 < ny ? i + nx : -1, z + 1 < nz ? i + nx * ny : -1};
        for (int axis = 0; axis < 3; axis++) {
            if (next[axis] < 0) continue;
            int32_t *bond = packing->bond[packing->n_bond++];
            bond[0] = i < next[axis] ? i : next[axis];
            bond[1] = i < next[axis] ? next[axis] : i;
        }
    }
    run.bond = NEW_ARRAY(int32_t, packing->n_bond);
    run.mode = NEW_ARRAY(uint8_t, packing->n_bond);
    run.time = NEW_ARRAY(double, packing->n_bond);
    run.saturation = NEW_ARRAY(double, packing->n_bond);
    return run;
}

static inline void crack(struct run *run, int bond)
{
    run->bond[run->n_crack++] = bond;
}

static inline int bond_between(const struct run *run, int a, int b)
{
    for (int k = 0; k < run->packing.n_bond; k++)
        if (run->packing.bond[k][0] == a && run->packing.bond[k][1] == b) return k;
    fail_msg("no bond between %d and %d", a, b);
    return -1;
}
