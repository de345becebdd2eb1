// SPDX-License-Identifier: GPL-3.0-or-later
// The step q of places is the largest of 1, 2 and 5 times a power of ten of which at
// least three quarters of the coordinates along each axis are multiples (of 2 q half
// are; six digits of a large number are coarser than those of a small one). Random
// doubles are no multiples of anything above their own digits, so that a step is no
// accident.
//
// Rounding changes the distance of two grains by up to q, rarely more: the standard
// deviation is q/sqrt(6). Pairs less than q apart may have touched, unless the gap
// counts as touching anyway.
//
// A lattice has round places, too, but nothing was lost there: its neighbours have a
// few distances, which rounded places do not have.
#include "rounded.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "geometry/fabric.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>

enum {
    FEWEST_GRAINS = 20,
    FEWEST_DISTANCES = 10 // of such pairs: fewer are those of a lattice
};
static const double SHARE_THAT_COUNTS = 0.01; // of the grains
static const double COARSEST = 0.2;           // of the radius of small grains

static bool is_multiple(double x, double step)
{
    const double count = x / step;
    return fabs(count - rint(count)) <= 1e-6;
}

static bool are_multiples(const struct packing *packing, double step)
{
    for (int axis = 0; axis < 3; axis++) {
        int n = 0;
        for (int i = 0; i < packing->n_particle; i++)
            n += is_multiple(component(packing->position[i], axis), step);
        if (4 * n < 3 * packing->n_particle) return false;
    }
    return true;
}

// From COARSEST down to FINEST; 0 where there is none.
static double step_of(const struct packing *packing, double coarsest, double finest)
{
    static const double of_ten[] = {5, 2, 1};
    for (int power = (int)floor(log10(coarsest)); power >= -300; power--)
        for (int k = 0; k < 3; k++) {
            const double step = of_ten[k] * pow(10, power);
            if (step < finest) return 0;
            if (step <= coarsest && are_multiples(packing, step)) return step;
        }
    return 0;
}

// How many of the sorted VALUE differ, by more than rounding.
static int count_distinct(const double *value, int n)
{
    int distinct = n > 0;
    for (int k = 1; k < n; k++)
        distinct += value[k] > value[k - 1] * (1 + 1e-9);
    return distinct;
}

// Pairs of grains less than STEP apart, but more than GAP radius sums, which are up to
// MOST; 0 for those of a lattice.
static int pairs_just_apart(const struct packing *packing, double step, double gap,
                            double most)
{
    const struct contacts near = find_contacts(packing, most);
    double *distance = NEW_ARRAY(double, near.count);
    int n = 0;
    for (int k = 0; k < near.count; k++) {
        const int i = near.pair[k][0], j = near.pair[k][1];
        const double sum = packing->radius[i] + packing->radius[j];
        const double apart = norm(nearest_image(packing, i, j));
        if (apart - sum < step && apart - sum > gap * sum) distance[n++] = apart;
    }
    qsort(distance, (size_t)n, sizeof *distance, rising_doubles);
    const int distinct = count_distinct(distance, n);
    free(distance);
    free((void *)near.pair);
    return distinct < FEWEST_DISTANCES ? 0 : n;
}

void judge_rounding(const struct packing *packing, const struct packing_facts *facts,
                    double gap, struct findings *findings)
{
    if (facts->n < FEWEST_GRAINS) return;
    const double finest = 2 * fmax(gap, 1e-9) * facts->tenth;
    const double step = step_of(packing, COARSEST * facts->tenth, finest);
    if (!(step > 0)) return;
    const double most = 1.05 * step / (2 * facts->tenth);
    const int n = pairs_just_apart(packing, step, gap, most);
    if (n <= SHARE_THAT_COUNTS * facts->n) return;
    add_finding(findings, FINDING_NOTE, "rounded",
                "places are multiples of %g m, and %d pairs of grains are less than "
                "that apart: rounded? Write more digits, or bond all that may touch by "
                "pack.touching_gap=%.2g",
                step, n, most);
}
