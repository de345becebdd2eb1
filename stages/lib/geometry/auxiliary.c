// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that stay keep their order; a bond with one that goes is dropped.
//
// A side of the box has a layer along it if centres of auxiliary grains lie beyond all
// other grains there. Those of a layer that is wider than the other grains lie beyond
// these on its edges, too: so the side with the most such grains is taken first, and
// each grain counts at one side.
#include "geometry/auxiliary.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// New numbers of the grains that stay, -1 for the others. Returns how many stay.
static int number_grains(const struct packing *packing, int32_t *number)
{
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        number[i] = is_auxiliary(packing, i) ? -1 : n++;
    return n;
}

static void copy_bonds(const struct packing *from, const int32_t *number,
                       struct packing *to)
{
    to->n_bond = 0;
    for (int b = 0; b < from->n_bond; b++) {
        const int32_t first = number[from->bond[b][0]];
        const int32_t second = number[from->bond[b][1]];
        if (first < 0 || second < 0) continue;
        if (from->bond_strength) to->bond_strength[to->n_bond] = from->bond_strength[b];
        to->bond[to->n_bond][0] = first;
        to->bond[to->n_bond++][1] = second;
    }
}

struct packing without_auxiliary(const struct packing *packing)
{
    struct packing kept = *packing;
    int32_t *number = NEW_ARRAY(int32_t, packing->n_particle);
    kept.n_particle = number_grains(packing, number);
    kept.kind = NULL;
    kept.position = NEW_ARRAY(struct vector, kept.n_particle);
    kept.radius = NEW_ARRAY(double, kept.n_particle);
    kept.bond = allocate((size_t)packing->n_bond, sizeof *kept.bond);
    if (packing->bond_strength) kept.bond_strength = NEW_ARRAY(double, packing->n_bond);
    copy_without_auxiliary(packing, packing->position, sizeof *kept.position,
                           kept.position);
    copy_without_auxiliary(packing, packing->radius, sizeof *kept.radius, kept.radius);
    copy_bonds(packing, number, &kept);
    free(number);
    return kept;
}

void copy_without_auxiliary(const struct packing *packing, const void *from,
                            size_t size, void *to)
{
    const char *value = from;
    char *place = to;
    if (!packing->kind) memcpy(to, from, (size_t)packing->n_particle * size);
    for (int i = 0; packing->kind && i < packing->n_particle; i++, value += size) {
        if (is_auxiliary(packing, i)) continue;
        memcpy(place, value, size);
        place += size;
    }
}

// ---- the box ------------------------------------------------------------------------

// Of the lower (upper) wall across AXIS: the coordinate times -1 (1).
static double outwards(int wall, double x)
{
    return wall % 2 ? x : -x;
}

// Where the grains that are not auxiliary end towards WALL, outwards; -HUGE_VAL
// without any.
static double end_of_grains(const struct packing *packing, int wall)
{
    double end = -HUGE_VAL;
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i))
            end = fmax(end, outwards(wall, component(packing->position[i], wall / 2)) +
                                packing->radius[i]);
    return end;
}

// How many of the grains that are LEFT lie beyond END at WALL; if TAKEN they are left
// no more.
static int count_beyond(const struct packing *packing, int wall, double end,
                        uint8_t *left, bool taken)
{
    int count = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const double at = outwards(wall, component(packing->position[i], wall / 2));
        if (!left[i] || !(at > end)) continue;
        count++;
        if (taken) left[i] = 0;
    }
    return count;
}

// The wall with most of the grains that are LEFT beyond its END (WALL_COUNT); -1: none
// lies beyond one.
static int most_covered(const struct packing *packing, const double *end, uint8_t *left)
{
    int most = 0, found = -1;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        if (packing->periodic[wall / 2]) continue;
        const int count = count_beyond(packing, wall, end[wall], left, false);
        if (count <= most) continue;
        most = count;
        found = wall;
    }
    return found;
}

struct window box_without_auxiliary(const struct packing *packing)
{
    struct window box = {packing->lower, packing->upper};
    double end[WALL_COUNT];
    for (int wall = 0; wall < WALL_COUNT; wall++)
        end[wall] = end_of_grains(packing, wall);
    if (!packing->kind || isinf(end[0])) return box;
    uint8_t *left = NEW_ARRAY(uint8_t, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        left[i] = is_auxiliary(packing, i);
    for (int wall; (wall = most_covered(packing, end, left)) >= 0;) {
        count_beyond(packing, wall, end[wall], left, true);
        struct vector *corner = wall % 2 ? &box.upper : &box.lower;
        const double other = component(wall % 2 ? box.lower : box.upper, wall / 2);
        if (end[wall] + outwards(wall, -other) > 0) // not where grains lie outside
            set_component(corner, wall / 2, outwards(wall, end[wall]));
    }
    free(left);
    return box;
}
