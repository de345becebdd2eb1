// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds of a periodic packing join a grain to the nearest image of another: along each
// axis that repeats,
//     image = -round((x_1 - x_0) / edge),
//     bond_vector = (x_1 - x_0) + image * edge,
// from the positions before drying, in m. The packing does not say which image was
// bonded: in a box of two grains across, where two images are as near, one of them is
// taken, and always the same.
//
// Whether bonds hold: those that earlier replays or the weight alone broke never did as
// far as cracks are concerned (bonds_before); those of /cracks no longer do at the end
// (bonds_left).
#include "run.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

struct image bond_image(const struct packing *packing, int bond)
{
    const int32_t *pair = packing->bond[bond];
    const struct vector apart =
        subtract(packing->position[pair[1]], packing->position[pair[0]]);
    const struct vector edge = subtract(packing->upper, packing->lower);
    struct image image = {0};
    for (int axis = 0; axis < 3; axis++)
        if (packing->periodic[axis])
            image.along[axis] =
                (int8_t)-nearbyint(component(apart, axis) / component(edge, axis));
    return image;
}

struct vector bond_vector(const struct packing *packing, int bond)
{
    const int32_t *pair = packing->bond[bond];
    return image_apart(packing, packing->position[pair[0]], packing->position[pair[1]],
                       bond_image(packing, bond));
}

uint8_t *bonds_before(const struct run *run)
{
    uint8_t *left = NEW_ARRAY(uint8_t, run->packing.n_bond);
    if (run->packing.n_bond) memset(left, 1, (size_t)run->packing.n_bond);
    for (int k = 0; k < run->n_before; k++)
        left[run->before[k]] = 0;
    return left;
}

uint8_t *bonds_left(const struct run *run)
{
    uint8_t *left = bonds_before(run);
    for (int k = 0; k < run->n_crack; k++)
        left[run->bond[k]] = 0;
    return left;
}

void run_free(struct run *run)
{
    packing_free(&run->packing);
    free(run->bond);
    free(run->time);
    free(run->saturation);
    free(run->mode);
    free(run->before);
    free(run->held);
    free(run->snapshot_saturation);
    free(run->displacement);
    free(run->dryness);
    free(run->intact);
    *run = (struct run){0};
}
