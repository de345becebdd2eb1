// SPDX-License-Identifier: GPL-3.0-or-later
// A box that ends on the outermost of grains cut at a height has void beside all
// others. If it ended at the outermost centres, grains would stick out of it as far as
// those that were cut off stuck in:
//     phi = 1 - V / (A H),   V the volume of the grains, A H that of the box,
// with H from centre to centre, is the porosity before the cut. Overlaps count twice.
//
// Tops are rough where nothing was cut, too (settled grains), so the floor decides.
#include "rough.h"

#include "geometry/support.h"

#include <math.h>

static const double GAIN_THAT_COUNTS = 0.05; // of the porosity
static const double DIGITS = 2e-5; // of the height: rounding of printed places
enum { FEWEST_ON_A_WALL = 3, FEWEST_GRAINS = 20 };

static bool is_flat_top(const struct packing *packing)
{
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        n += touches_walls(packing, i, WALL_Z_UPPER);
    return n >= FEWEST_ON_A_WALL;
}

void judge_ends(const struct packing *packing, const struct packing_facts *facts,
                const struct bond_facts *bonds, struct findings *findings)
{
    if (packing->periodic[2] || packing->n_body || facts->n < FEWEST_GRAINS ||
        bonds->at_bottom >= FEWEST_ON_A_WALL)
        return;
    struct vector low = facts->box.lower, high = facts->box.upper;
    const double height = high.z - low.z;
    const bool flat_top = is_flat_top(packing);
    low.z = HUGE_VAL;
    if (!flat_top) high.z = -HUGE_VAL;
    for (int i = 0; i < packing->n_particle; i++) {
        low.z = fmin(low.z, packing->position[i].z - DIGITS * height);
        high.z = fmax(high.z, packing->position[i].z + DIGITS * height);
    }
    const double within = 1 - (1 - facts->porosity) * height / (high.z - low.z);
    if (!(facts->porosity - within > GAIN_THAT_COUNTS)) return;
    const int n = 6 + digits_of_origin(facts);
    add_finding(
        findings, FINDING_NOTE, "rough",
        "the box ends on the outermost grains of a rough %s: its porosity is "
        "%.3g, %.3g between the outermost centres; more liquid will fill it than "
        "a body of such grains holds, unless it ends there: pack.method=import "
        "pack.lower=[%.*g,%.*g,%.*g] pack.upper=[%.*g,%.*g,%.*g]",
        flat_top ? "floor" : "floor and top", facts->porosity, within, n, low.x, n,
        low.y, n, low.z, n, high.x, n, high.y, n, high.z);
}
