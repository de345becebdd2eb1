// SPDX-License-Identifier: GPL-3.0-or-later
// A grain of density rho and radius R weighs
//     W = rho g (4/3) pi R^3,
// and the liquid around it, M kg by force-protocol's shares, M g. Two Bond numbers say
// what that is beside the suction p_c:
//     Bo = mean W / largest |F|                      of a grain,
//     Bo = sum (W + M g) / (A p_c) = rho_body g H / p_c   of the body,
// A the horizontal area of the box, or of the cylinder or other body in it (the mean
// over the height), and H the height of what stands in it.
#include "weight.h"

#include "basics/memory.h"

#include <math.h>

static double grain_weight(const struct weighing *of, int i)
{
    const double radius = of->packing->radius[i];
    return of->density * of->gravity * (4 * M_PI / 3) * radius * radius * radius;
}

static double liquid_weight(const struct weighing *of, int i)
{
    return of->liquid ? of->liquid[i] * of->gravity : 0;
}

double *grain_weights(const struct weighing *of)
{
    double *weight = NEW_ARRAY(double, of->packing->n_particle);
    for (int i = 0; i < of->packing->n_particle; i++)
        weight[i] = grain_weight(of, i);
    return weight;
}

struct vector *standing_weight(const struct weighing *of)
{
    struct vector *standing = NEW_ARRAY(struct vector, of->packing->n_particle);
    for (int i = 0; i < of->packing->n_particle; i++)
        standing[i].z = -grain_weight(of, i) - liquid_weight(of, i);
    return standing;
}

struct bond_numbers find_bond_numbers(double largest, double suction,
                                      const struct weighing *of)
{
    const struct packing *packing = of->packing;
    const int n = packing->n_particle;
    double grains = 0, liquid = 0;
    for (int i = 0; i < n; i++) {
        grains += grain_weight(of, i);
        liquid += liquid_weight(of, i);
    }
    const double area = packing_base_area(packing);
    return (struct bond_numbers){
        .grain = largest > 0 ? grains / n / largest : NAN,
        .body = suction > 0 ? (grains + liquid) / (area * suction) : NAN};
}
