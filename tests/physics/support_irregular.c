// SPDX-License-Identifier: GPL-3.0-or-later
#include "support_irregular.h"

#include "basics/memory.h"
#include "dem-replay/bonds.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct packing irregular_packing(int side, double size, bool repeats)
{
    const int n = side * side * side;
    const double edge = 2 * size * side;
    struct packing packing = {.n_particle = n,
                              .position = NEW_ARRAY(struct vector, n),
                              .radius = NEW_ARRAY(double, n),
                              .upper = {edge, edge, edge},
                              .periodic = {repeats, repeats, 0}};
    uint64_t seed = 1;
    for (int i = 0; i < n; i++) {
        const int at[3] = {i % side, i / side % side, i / (side * side)};
        for (int axis = 0; axis < 3; axis++)
            set_component(&packing.position[i], axis,
                          size * (2 * at[axis] + 0.7 + 0.6 * next_random(&seed)));
    }
    for (int i = 0; i < n; i++) {
        packing.radius[i] = size;
        for (int j = 0; j < n; j++)
            if (j != i)
                packing.radius[i] =
                    fmin(packing.radius[i], norm(nearest_image(&packing, i, j)) / 2);
    }
    bond_grains(&packing, BONDS_BY_DISTANCE, 0.25);
    return packing;
}

uint8_t *lowest_grains(const struct packing *packing, int side)
{
    uint8_t *lowest = NEW_ARRAY(uint8_t, packing->n_particle);
    memset(lowest, 1, (size_t)(side * side));
    return lowest;
}

struct vector turned(struct vector a, struct vector axis, double angle)
{
    const struct vector n = scale(1 / norm(axis), axis);
    return add(add(scale(cos(angle), a), scale(sin(angle), cross(n, a))),
               scale((1 - cos(angle)) * dot(n, a), n));
}

static int by_pair(const void *a, const void *b)
{
    return compare_pairs(a, b);
}

struct packing turned_packing(const struct packing *packing, struct vector axis,
                              double angle, const int *order)
{
    const size_t n = (size_t)packing->n_particle;
    struct packing other = *packing;
    const struct vector middle = scale(0.5, add(packing->lower, packing->upper));
    const struct vector half =
        scale(sqrt(3) / 2, subtract(packing->upper, packing->lower));
    other.lower = subtract(middle, half);
    other.upper = add(middle, half);
    other.position = NEW_ARRAY(struct vector, n);
    other.radius = NEW_ARRAY(double, n);
    other.bond =
        duplicate(packing->bond, (size_t)packing->n_bond, sizeof *packing->bond);
    int *number = NEW_ARRAY(int, n); // new, of the old
    for (int i = 0; i < packing->n_particle; i++) {
        const int was = order ? order[i] : i;
        number[was] = i;
        other.position[i] =
            add(middle, turned(subtract(packing->position[was], middle), axis, angle));
        other.radius[i] = packing->radius[was];
    }
    for (int b = 0; b < packing->n_bond; b++) {
        const int i = number[packing->bond[b][0]], j = number[packing->bond[b][1]];
        other.bond[b][0] = i < j ? i : j;
        other.bond[b][1] = i < j ? j : i;
    }
    qsort(other.bond, (size_t)other.n_bond, sizeof *other.bond, by_pair);
    free(number);
    return other;
}

struct vector *shrinking_load(const struct packing *packing, double size)
{
    struct vector *force = NEW_ARRAY(struct vector, packing->n_particle);
    const struct vector middle = scale(0.5, add(packing->lower, packing->upper));
    const double reach = norm(subtract(packing->upper, middle));
    uint64_t seed = 2;
    for (int i = 0; i < packing->n_particle; i++)
        force[i] = scale(size * (0.5 + 0.5 * next_random(&seed)) / reach,
                         subtract(middle, packing->position[i]));
    return force;
}
