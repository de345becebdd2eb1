// SPDX-License-Identifier: GPL-3.0-or-later
// With n the unit vector along a bond before drying,
//     inclination = atan2(hypot(n_x, n_y), |n_z|),  0 (upright) to pi/2 (level),
//     class       = that of inclination / (pi/2) among nine: ten degrees each,
//     fabric     += n n  for each crack, by its mode.
// n and -n are the same bond: |n_z| and the product n n do not tell them apart. By
// atan2 angles near both ends keep their digits. The report divides the fabric by its
// trace, which is the number of cracks (report_tables.c).
//
// All bonds of the packing count in `bonds`, those too that the weight alone broke. A
// bond between coincident grains counts there as upright; its crack is left out.
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
