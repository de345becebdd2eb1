// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the fluid, throat by throat [C 13-18]. A throat with the pressure drop p_i
// - p_j and normal n puts on its corner k
//     pressure force  sector_k (p_i - p_j) n                       [C 14]
//     viscous force   A^f (p_i - p_j) n surface_k / sum of surfaces [C 17, 18]
// where A^f is the fluid part of the facet. Summed over all throats and walls the
// forces vanish, because each facet's area is split into its sectors and A^f. (C 17 is
// printed with p_j - p_i, which would drag grains against the flow.)
#include "forces.h"

#include "basics/memory.h"

#include <stdlib.h>

static void add_to(struct vector *sum, double factor, struct vector v)
{
    *sum = add(*sum, scale(factor, v));
}

// Pressure acts on the sectors of the facet [C 14]; its action on the fluid between
// them is passed on to the grains as drag [C 17], by their shares of the surface [C
// 18].
static void add_throat(const struct throat *throat, double drop, struct forces *forces)
{
    const double area = norm(throat->area);
    if (!(area > 0)) return;
    const struct vector normal = scale(1 / area, throat->area);
    const double drag = fluid_area(throat) * drop;
    const double surface = throat->surface[0] + throat->surface[1] + throat->surface[2];
    for (int k = 0; k < 3; k++) {
        const int32_t corner = throat->corner[k];
        struct vector *viscous =
            corner < 0 ? &forces->wall_viscous[-1 - corner] : &forces->viscous[corner];
        add_to(viscous, surface > 0 ? drag * throat->surface[k] / surface : 0, normal);
        if (corner >= 0)
            add_to(&forces->pressure[corner], throat->sector[k] * drop, normal);
    }
}

// The middle, along the axes that repeat, of the part of a wall that closes CELL: what
// corners other than corner WALL span. Between two grains and a second wall it is a
// trapezium.
static struct vector middle_of_part(const struct grains *grains,
                                    const struct pore_cell *cell, int wall)
{
    struct vector at[3], sum = {0, 0, 0};
    int n = 0, other = -1;
    for (int k = 0; k < 4; k++)
        if (cell->corner[k] >= 0)
            at[n++] = corner_position(grains, cell, k);
        else if (k != wall)
            other = -1 - cell->corner[k];
    double share[3] = {1, 1, 1}; // of each corner, in what the middle is
    if (n == 2) {
        const double h = wall_distance(grains, at[0], other),
                     g = wall_distance(grains, at[1], other);
        if (fabs(h + g) > 0) {
            share[0] = (2 * h + g) / (1.5 * (h + g));
            share[1] = (h + 2 * g) / (1.5 * (h + g));
        }
    }
    for (int i = 0; i < n; i++)
        sum = add(sum, scale(share[i] / n, at[i]));
    return sum;
}

// The part of a wall that closes a cell has the area, along the wall's normal, of the
// facet opposite to the wall. Along axes that repeat, parts are in whatever image their
// cell has: all count with the mean gradient of the middle of the box.
static void add_wall(const struct grains *grains, const struct cells *cells,
                     const struct throat *throat, int end,
                     const struct pressures *pressures, struct forces *forces)
{
    const struct pore_cell *cell = &cells->cell[throat->cell[end]];
    const int32_t *corner = cell->corner;
    for (int k = 0; k < 4; k++) {
        if (corner[k] >= 0 || corner[k] == throat->corner[0] ||
            corner[k] == throat->corner[1] || corner[k] == throat->corner[2])
            continue;
        const int wall = -1 - corner[k];
        const struct vector normal = wall_normal(wall);
        const double inwards = dot(throat->area, normal);
        const struct vector off =
            subtract(middle_of_part(grains, cell, k), scale(0.5, grains->box));
        const double pressure = pore_pressure(pressures, cells, throat->cell[end]) -
                                dot(pressures->gradient, off);
        add_to(&forces->wall_pressure[wall], pressure * (end == 0 ? -inwards : inwards),
               normal);
    }
}

struct forces find_forces(const struct grains *grains, const struct cells *cells,
                          const struct throats *throats,
                          const struct pressures *pressures)
{
    struct forces forces = {.viscous = NEW_ARRAY(struct vector, grains->n_base),
                            .pressure = NEW_ARRAY(struct vector, grains->n_base)};
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        const double drop = pressure_drop(pressures, grains, cells, throat);
        add_throat(throat, drop, &forces);
        for (int end = 0; end < 2; end++)
            add_wall(grains, cells, throat, end, pressures, &forces);
        add_to(&forces.velocity, throat->conductance * drop,
               throat_step(grains, cells, throat));
    }
    const struct vector box = grains->box;
    forces.velocity = scale(1 / box_volume(box), forces.velocity);
    forces.mean_pressure = mean_pressure(pressures, grains, throats);
    return forces;
}

void forces_free(struct forces *forces)
{
    free(forces->viscous);
    free(forces->pressure);
    *forces = (struct forces){0};
}
