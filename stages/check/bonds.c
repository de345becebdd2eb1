// SPDX-License-Identifier: GPL-3.0-or-later
// Connectivity of the bonds. The gap that would join most grains is the largest edge of
// a minimum spanning forest grown until one piece has 95 % of the grains (Kruskal
// 1956): pairs are sorted by gap over the sum of radii and united one after the other.
// Pairs are searched up to gaps of 0.02, 0.1 and 0.5 sums of radii in turn, as wide
// searches find many more pairs; beyond 0.5 the gap stays NAN.
#include "bonds.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"
#include "geometry/neighbours.h"
#include "geometry/support.h"
#include "suggest.h"

#include <stdio.h>
#include <stdlib.h>

static const double MOST_GRAINS = 0.95; // a body, but for a few that lie loose

struct near_pair {
    double gap; // of the sum of the radii
    int grain[2];
};

static int compare_gaps(const void *a, const void *b)
{
    const struct near_pair *p = a, *q = b;
    return (p->gap > q->gap) - (p->gap < q->gap);
}

// Pairs of grains up to GAP apart, the nearest first; the caller frees them.
static struct near_pair *pairs_by_gap(const struct packing *packing, double gap,
                                      int *count)
{
    int all;
    int32_t(*pair)[2] = neighbour_pairs(packing, gap, &all);
    struct near_pair *near = NEW_ARRAY(struct near_pair, all);
    *count = 0;
    for (int k = 0; k < all; k++) {
        const int i = pair[k][0], j = pair[k][1];
        const double sum = packing->radius[i] + packing->radius[j];
        near[(*count)++] =
            (struct near_pair){norm(nearest_image(packing, i, j)) / sum - 1, {i, j}};
    }
    free(pair);
    qsort(near, (size_t)*count, sizeof *near, compare_gaps);
    return near;
}

// The gap at which the nearest pairs, joined one after the other, make a piece of
// WANTED grains; NAN if all pairs up to MOST do not.
static double joining_gap(const struct packing *packing, int wanted, double most)
{
    const int n = packing->n_particle;
    int count;
    struct near_pair *near = pairs_by_gap(packing, most, &count);
    int *piece = NEW_ARRAY(int, n), *size = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++) {
        piece[i] = i;
        size[i] = 1;
    }
    double gap = NAN;
    for (int k = 0; k < count && isnan(gap); k++) {
        const int a = set_root(piece, near[k].grain[0]);
        const int b = set_root(piece, near[k].grain[1]);
        if (a == b) continue;
        const int both = size[a] + size[b];
        unite_sets(piece, a, b);
        size[set_root(piece, a)] = both;
        if (both >= wanted) gap = fmax(near[k].gap, 0);
    }
    free(near);
    free(piece);
    free(size);
    return gap;
}

static void count_pieces(const struct packing *packing, struct bond_facts *facts)
{
    const int n = packing->n_particle;
    int *piece = bonded_pieces(packing), *size = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++)
        size[piece[i]]++;
    for (int i = 0; i < n; i++) {
        facts->pieces += size[i] > 0;
        facts->largest = size[i] > facts->largest ? size[i] : facts->largest;
        facts->without += size[piece[i]] == 1;
    }
    free(piece);
    free(size);
}

struct bond_facts bond_facts(const struct packing *packing)
{
    const int n = packing->n_particle;
    struct bond_facts facts = {.gap = NAN};
    uint8_t *holds = NEW_ARRAY(uint8_t, n);
    for (int i = 0; i < n; i++) {
        holds[i] = !packing->periodic[2] && touches_walls(packing, i, WALL_Z_LOWER);
        facts.at_bottom += holds[i];
    }
    facts.supported = count_supported(packing, holds);
    free(holds);
    count_pieces(packing, &facts);
    const int wanted = (int)ceil(MOST_GRAINS * n);
    static const double within[] = {0.02, 0.1, 0.5}; // wider ones find many more pairs
    for (int k = 0; k < 3 && isnan(facts.gap) && facts.largest < wanted; k++)
        facts.gap = joining_gap(packing, wanted, within[k]);
    return facts;
}

// ---- findings -----------------------------------------------------------------------

// What to do where bonds are missing.
static void say_gap(const struct bond_facts *facts, char text[200])
{
    if (isnan(facts->gap))
        snprintf(text, 200,
                 "grains lie too far apart to bond: pack.method=deposition lets them "
                 "settle, radius_expansion packs them densely");
    else
        snprintf(
            text, 200,
            "pack.touching_gap=%.2g (or dem-replay.bond.by=distance, bond.gap) joins "
            "most of them",
            1.05 * facts->gap + 1e-6);
}

void judge_bonds(const struct packing *packing, const struct packing_facts *packed,
                 const struct bond_facts *facts, struct findings *findings)
{
    const int n = packed->n;
    char what[200];
    say_gap(facts, what);
    if (n < 2) return;
    if (!packing->n_bond)
        add_finding(findings, FINDING_WRONG, "bonds",
                    "no bonds, so that none can break: %s", what);
    else if (facts->largest < MOST_GRAINS * n)
        add_finding(
            findings, facts->largest < n / 2 ? FINDING_WRONG : FINDING_NOTE, "pieces",
            "bonds join %d of %d grains to one piece (%d pieces, %d grains without "
            "a bond): %s",
            facts->largest, n, facts->pieces, facts->without, what);
}

void judge_support(const struct packing *packing, const struct packing_facts *packed,
                   const struct bond_facts *facts, struct findings *findings)
{
    if (!packing->n_bond || packing->periodic[2] || facts->at_bottom >= 3) return;
    add_finding(findings, FINDING_NOTE, "support",
                "%d grain%s the lower z wall, all that dem-replay holds by default: "
                "hold those with centres below %.*g m by dem-replay.held, or "
                "none by support=free",
                facts->at_bottom, facts->at_bottom == 1 ? " touches" : "s touch",
                3 + digits_of_origin(packed), bottom_of(packed));
}
