// SPDX-License-Identifier: GPL-3.0-or-later
// A grain is fixed if it touches one of the walls, lies in the region, or is listed.
// The region includes its surface; where none is given its corners are NAN, which no
// centre lies between. Parameters are checked before anything is allocated.
//
// A wall holds grains that touch it to 1e-6 of their radius, or reach beyond it
// (touches_walls). Numbers of grains are those of the packing, from 0, and come as
// doubles: one that is no whole number is refused, not rounded.
#include "fixed_grains.h"

#include "basics/memory.h"
#include "geometry/support.h"

#include <math.h>

static bool lies_within(struct vector x, const double lower[3], const double upper[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (!(component(x, axis) >= lower[axis] && component(x, axis) <= upper[axis]))
            return false;
    return true;
}

static enum status check_walls(const struct packing *packing, unsigned walls,
                               struct reason *reason)
{
    for (int wall = 0; wall < WALL_COUNT; wall++)
        if (walls >> wall & 1 && packing->periodic[wall / 2])
            return refuse(reason, STATUS_BAD_DATA,
                          "held.walls: the box is periodic along %c and has no wall "
                          "%c%c (name others, or none and held.lower, held.upper)",
                          'x' + wall / 2, wall % 2 ? '+' : '-', 'x' + wall / 2);
    return STATUS_OK;
}

static enum status check_region(const struct fixed_grains *held, struct reason *reason)
{
    if (isnan(held->lower[0]) != isnan(held->upper[0]))
        return refuse(reason, STATUS_BAD_DATA,
                      "held.%s: must be given, as the other corner is",
                      isnan(held->lower[0]) ? "lower" : "upper");
    for (int axis = 0; axis < 3; axis++)
        if (held->lower[axis] > held->upper[axis])
            return refuse(reason, STATUS_BAD_DATA,
                          "held.upper: %c must be >= %g, of held.lower, got %g",
                          'x' + axis, held->lower[axis], held->upper[axis]);
    return STATUS_OK;
}

static enum status check_grains(const struct packing *packing,
                                const struct fixed_grains *held, struct reason *reason)
{
    for (int k = 0; k < held->grains.count; k++) {
        const double grain = held->grains.value[k];
        if (grain != floor(grain) || grain >= packing->n_particle)
            return refuse(reason, STATUS_BAD_DATA,
                          "held.grains: must be whole numbers below %d, got %g",
                          packing->n_particle, grain);
    }
    return STATUS_OK;
}

enum status find_fixed_grains(const struct packing *packing,
                              const struct fixed_grains *held, uint8_t **is_held,
                              struct reason *reason)
{
    enum status status = check_walls(packing, held->walls, reason);
    if (!status) status = check_region(held, reason);
    if (!status) status = check_grains(packing, held, reason);
    if (status) return status;
    *is_held = NEW_ARRAY(uint8_t, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        (*is_held)[i] = touches_walls(packing, i, held->walls) ||
                        lies_within(packing->position[i], held->lower, held->upper);
    for (int k = 0; k < held->grains.count; k++)
        (*is_held)[(int)held->grains.value[k]] = 1;
    return STATUS_OK;
}
