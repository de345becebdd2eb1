// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "pack.h"

struct packing cubic_lattice(const int64_t counts[3], double radius,
                             const bool periodic[3])
{
    const double spacing = 2 * radius;
    struct packing packing = {.n_particle = (int)(counts[0] * counts[1] * counts[2])};
    packing.position = NEW_ARRAY(struct vector, packing.n_particle);
    packing.radius = NEW_ARRAY(double, packing.n_particle);
    packing.bond = allocate(0, sizeof *packing.bond);
    packing.upper =
        (struct vector){spacing * (double)counts[0], spacing * (double)counts[1],
                        spacing * (double)counts[2]};
    int i = 0;
    for (int x = 0; x < counts[0]; x++)
        for (int y = 0; y < counts[1]; y++)
            for (int z = 0; z < counts[2]; z++, i++) {
                packing.position[i] = (struct vector){
                    spacing * (x + 0.5), spacing * (y + 0.5), spacing * (z + 0.5)};
                packing.radius[i] = radius;
            }
    for (int axis = 0; axis < 3; axis++)
        packing.periodic[axis] = periodic[axis];
    return packing;
}
