// SPDX-License-Identifier: GPL-3.0-or-later
// Conductances [C 7-10]. With A the fluid part of the facet, V the volume of the
// throat and S its solid surface,
//     hydraulic:  g = factor A R_h^2,            R_h = V / S            [C 8, 9]
//     effective:  g = 2 pi R_eff^4,              R_eff = (sqrt(A / pi) + inscribed) / 4
// and conductance = g / length for a viscosity of 1 [C 20]. R_eff is half of the mean
// of the two radii, the circle of equal area and the inscribed one [C 10]. With
// sections, conductance is the series of the slices of the throat instead (facet.h). A
// throat is closed where grains cover its facet, or where its volume or surface is not
// positive.
#include "throats.h"

#include "basics/memory.h"
#include "facet.h"

#include <stdlib.h>
#include <string.h>

// In units: farther apart than two centres of one pore.
static const double SAME_PORE = 1e-6;

struct corner facet_corner_of(const struct grains *grains, const struct pore_cell *cell,
                              int facet, int k)
{
    const int place = facet_corner[facet][k];
    const int32_t corner = cell->corner[place];
    if (corner >= 0)
        return (struct corner){.at = corner_position(grains, cell, place),
                               .radius = grains->radius[corner]};
    const int wall = -1 - corner;
    return (struct corner){.normal = wall_normal(wall),
                           .plane = wall % 2 ? component(grains->box, wall / 2) : 0};
}

double fluid_area(const struct throat *throat)
{
    return norm(throat->area) -
           (throat->sector[0] + throat->sector[1] + throat->sector[2]);
}

struct vector throat_step(const struct grains *grains, const struct cells *cells,
                          const struct throat *throat)
{
    return subtract(
        in_image(grains, cells->cell[throat->cell[1]].centre, throat->image),
        cells->cell[throat->cell[0]].centre);
}

// R^h_ij = phi_ij / gamma_ij [C 9].
static double hydraulic_radius(const struct throat *throat, enum sides sides)
{
    const double surface = throat->surface[0] + throat->surface[1] + throat->surface[2];
    if (!(surface > 0)) return 0;
    double radius = throat->volume / surface;
    for (int k = 0; k < 3 && sides == SIDES_SYMMETRIC_YADE; k++)
        if (throat->corner[k] < 0) radius *= sqrt(M_SQRT1_2);
    return radius;
}

// K_ij by the open section; by the circle that fits between the grains where their
// sectors cover the section, since one reaches beyond the facet.
static double section_conductance(const struct throat *throat,
                                  const struct corner corner[3], struct vector from,
                                  struct vector to, bool walls_resist)
{
    const struct throat_shape shape =
        facet_section_shape(corner, throat->area, from, to, walls_resist);
    if (shape.flow > 0) return shape.flow;
    return M_PI / 8 * pow(inscribed_radius(corner), 4) / throat->length;
}

// K_ij [C 8, 10, 20].
static double conductance_of(const struct throat *throat, const struct corner corner[3],
                             struct vector from, struct vector to,
                             const struct throat_rule *rule)
{
    const double area = fluid_area(throat);
    if (!(area > 0)) return 0;
    if (rule->conductance == CONDUCTANCE_SECTION)
        return section_conductance(throat, corner, from, to,
                                   rule->sides == SIDES_NO_SLIP);
    if (rule->conductance == CONDUCTANCE_EFFECTIVE) {
        const double inscribed = inscribed_radius(corner);
        const double effective = (sqrt(area / M_PI) + inscribed) / 4;
        return inscribed > 0 ? 2 * M_PI * pow(effective, 4) / throat->length : 0;
    }
    const double radius = hydraulic_radius(throat, rule->sides);
    return radius > 0 ? rule->factor * area * radius * radius / throat->length : 0;
}

// Scales the sectors of overlapping grains to the area of the facet; false if they
// cover it.
static bool fit_sectors(struct throat *throat)
{
    const double area = norm(throat->area);
    const double sum = throat->sector[0] + throat->sector[1] + throat->sector[2];
    if (sum < area) return true;
    for (int k = 0; k < 3; k++)
        throat->sector[k] *= area / sum;
    return false;
}

// Whether both cells are one pore; a throat from a pore to its copy in the next box is
// none of these.
static bool is_inside(const struct cells *cells, const struct throat *throat)
{
    return cells->cell[throat->cell[0]].pore == cells->cell[throat->cell[1]].pore &&
           throat->length < SAME_PORE;
}

static void measure_throat(const struct grains *grains, const struct cells *cells,
                           const struct pore_cell *cell, int facet,
                           const struct throat_rule *rule, struct throat *throat)
{
    struct corner corner[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = facet_corner_of(grains, cell, facet, k);
        throat->corner[k] = cell->corner[facet_corner[facet][k]];
    }
    const struct vector to = add(cell->centre, throat_step(grains, cells, throat));
    const struct facet shape =
        measure_facet(corner, cell->centre, to, rule->facet_pieces == PIECES_SIGNED);
    throat->area = shape.area;
    memcpy(throat->sector, shape.sector, sizeof throat->sector);
    for (int k = 0; k < 3; k++)
        throat->surface[k] = throat->corner[k] < 0 && rule->sides != SIDES_NO_SLIP
                                 ? 0
                                 : shape.surface[k];
    throat->volume = shape.volume;
    throat->length = shape.length;
    const bool open = fit_sectors(throat);
    if (is_inside(cells, throat))
        throat->length = 0;
    else if (open)
        throat->conductance = conductance_of(throat, corner, cell->centre, to, rule);
}

// Whether facet K of cell C is listed from there, and not from the other side.
static bool is_first(const struct cells *cells, int c, int k)
{
    const int32_t other = cells->cell[c].neighbour[k];
    if (other != c) return c < other;
    return image_number(cells->cell[c].neighbour_image[k]) > 0;
}

struct throats find_throats(const struct grains *grains, const struct cells *cells,
                            const struct throat_rule *rule)
{
    struct throats throats = {0};
    int *first = NEW_ARRAY(int, cells->n + 1);
    for (int c = 0; c < cells->n; c++) {
        first[c] = throats.n;
        for (int k = 0; k < 4; k++)
            throats.n += is_first(cells, c, k);
    }
    throats.throat = NEW_ARRAY(struct throat, throats.n);
    int n_closed = 0;
#pragma omp parallel for schedule(static) reduction(+ : n_closed)
    for (int c = 0; c < cells->n; c++) {
        const struct pore_cell *cell = &cells->cell[c];
        struct throat *throat = &throats.throat[first[c]];
        for (int k = 0; k < 4; k++) {
            if (!is_first(cells, c, k)) continue;
            throat->cell[0] = c;
            throat->cell[1] = cell->neighbour[k];
            throat->image = cell->neighbour_image[k];
            measure_throat(grains, cells, cell, k, rule, throat);
            n_closed += throat->length > 0 && !(throat->conductance > 0);
            throat++;
        }
    }
    throats.n_closed = n_closed;
    free(first);
    return throats;
}

void throats_free(struct throats *throats)
{
    free(throats->throat);
    *throats = (struct throats){0};
}
