// SPDX-License-Identifier: GPL-3.0-or-later
// With n the unit vector along a bond before drying,
//     inclination = atan2(hypot(n_x, n_y), |n_z|),  0 (upright) to pi/2 (level),
//     fabric     += n n  for each crack, by its mode.
// The report divides the fabric by its trace (report_tables.c).
#include "orientation.h"

#include "count.h"

// The class of a bond along N, by its inclination to z: from upright to level.
static int inclination_class(struct vector n)
{
    const double angle = atan2(hypot(n.x, n.y), fabs(n.z));
    return class_of(angle / M_PI_2, INCLINATION_CLASSES);
}

void add_orientation(struct orientation *orientation, const struct run *run)
{
    const struct packing *packing = &run->packing;
    for (int b = 0; b < packing->n_bond; b++)
        orientation->bonds[inclination_class(bond_vector(packing, b))]++;
    for (int k = 0; k < run->n_crack; k++) {
        const struct vector along = bond_vector(packing, run->bond[k]);
        const double length = norm(along);
        if (!(length > 0)) continue; // coincident grains have no direction
        const struct vector n = scale(1 / length, along);
        orientation->cracks[inclination_class(n)][run->mode[k]]++;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                orientation->fabric[run->mode[k]][3 * i + j] +=
                    component(n, i) * component(n, j);
    }
}
