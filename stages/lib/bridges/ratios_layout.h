// SPDX-License-Identifier: GPL-3.0-or-later
// How the tables of many ratios of radii are laid out; for the files that make and read
// them only.
//
// There are seventeen, even in the asymmetry s (ratios.h), each with its own gap A of
// rupture, and zeta by that (table_layout.h). Between them 1/A, and F (1 + a/C)^2 at
// the same zeta, are interpolated, each by a polynomial through the six nearest: where
// in zeta a bridge lies, and so its steep end, is that of its own ratio. Of equal
// grains A here is where they rupture, also by a break of symmetry, as that is what
// slightly unequal ones come near to.
//
// Their patches are halves of octaves, of sixth order in the volume.
#pragma once

#include "bridges/ratios.h"
#include "bridges/table_layout.h"

enum { RATIOS = 17, INTERVALS = RATIOS - 1, STENCIL = 6 };
enum { IN_HALF = EIGHTHS / 2, HALVES = VOLUMES / IN_HALF, HALF_ORDER = TURNING_ORDER };

// For one half of an octave, with u from -1 to 1 across it.
struct ratio_patch {
    double inverse[RATIOS][HALF_ORDER]; // 1/A as polynomials in u
    double steepness;                   // 1/C
    // Coefficients of u^i w^j as in a table: i = 0 and 1, 2 and 3, 4 and 5.
    alignas(64) float8 force[PLACES][RATIOS][3];
};

// Patches of a table from FIRST to LAST; none if FIRST is above.
struct range {
    int first, last;
};

// It owns EQUAL and PATCH.
struct bridge_ratios {
    struct range equal_range, range[INTERVALS]; // that there are
    bool as_it_is; // equal grains only, and no volume to be taken as another
    struct bridge_table *equal; // with the patches of its range
    struct ratio_patch *patch;  // (HALVES), likewise; NULL: all grains are equal
};

// The first of the six tables about an interval. At the ends of the range the same six
// serve several intervals. Of RATIOS tables, 0 to RATIOS - STENCIL.
static inline int first_of_stencil(int interval)
{
    const int first = interval - STENCIL / 2 + 1, most = RATIOS - STENCIL;
    return first < 0 ? 0 : first > most ? most : first;
}

// u in the half of an octave, from that in an eighth.
static inline double u_in_half(struct volume_place at)
{
    return (2 * (at.patch % IN_HALF) + at.u + 1) / IN_HALF - 1;
}
