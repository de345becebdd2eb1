// SPDX-License-Identifier: GPL-3.0-or-later
// In a box narrower than twice the reach of two grains a grain may meet another one, or
// itself, across two sides at once. So the box is set side by side with itself,
//     times = ceil(2 reach / edge)   along each axis that repeats,
// and what is counted in it is that of the packing times the number of copies.
#include "repeated.h"

#include "basics/memory.h"

#include <math.h>

struct packing repeated_packing(const struct packing *packing, double reach,
                                int *copies)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    int times[3];
    for (int axis = 0; axis < 3; axis++)
        times[axis] = packing->periodic[axis]
                          ? (int)fmax(1, ceil(2 * reach / component(edge, axis)))
                          : 1;
    *copies = times[0] * times[1] * times[2];
    const int n = packing->n_particle;
    struct packing wide = {.n_particle = n * *copies,
                           .position = NEW_ARRAY(struct vector, n * *copies),
                           .radius = NEW_ARRAY(double, n **copies),
                           .lower = packing->lower,
                           .upper = {packing->lower.x + times[0] * edge.x,
                                     packing->lower.y + times[1] * edge.y,
                                     packing->lower.z + times[2] * edge.z}};
    for (int axis = 0; axis < 3; axis++)
        wide.periodic[axis] = packing->periodic[axis];
    for (int k = 0; k < wide.n_particle; k++) {
        const int i = k % n, copy = k / n, x = copy % times[0],
                  y = copy / times[0] % times[1], z = copy / times[0] / times[1];
        const struct vector offset = {x * edge.x, y * edge.y, z * edge.z};
        wide.position[k] = add(packing->position[i], offset);
        wide.radius[k] = packing->radius[i];
    }
    return wide;
}
