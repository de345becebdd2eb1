// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid under one suction P in pores whose grains move. With a, b, c the corners of a
// facet, anticlockwise seen from outside the pore, as they are now,
//     area   A n = (b - a) x (c - a) / 2, out of the liquid,
//     force  F_i = - P A n / 3 at each corner, over all menisci at grain i,
//     throat rho: the circle that touches the three grains (inscribed_disc.h); gas
//            enters where P >= 2 gamma cos(theta) / rho, that is rho >= LEAST,
//     room   sum over the corners of what the tetrahedron has outside the grain there,
//            less three times the tetrahedron.
// The suction on the spheres below a facet and the pull of the meniscus in it add up to
// P A n, for liquid at rest is in balance (Gauss: a closed surface has no net area).
// So no solid angle is needed, and n grains around a pore of liquid feel no net force.
#include "network/pore_liquid.h"

#include "basics/memory.h"
#include "geometry/tetra_ball_volume.h"
#include "network/inscribed_disc.h"
#include "network/pore_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of its first volume: a pore below or above is no longer one. Flat ones count with
// SMALLEST_SHARE of the mean.
static const double INSIDE_OUT = -0.2, BURST = 8, SMALLEST_SHARE = 0.1;

// ---- begin --------------------------------------------------------------------------

// Pores beside walls stand for what is beyond: open above, else closed. Returns the
// number of each cell among the pores.
static int32_t *number_pores(const struct cells *cells, int *n)
{
    const int upper_z = -6;
    int32_t *number = NEW_ARRAY(int32_t, cells->n);
    *n = 0;
    for (int c = 0; c < cells->n; c++) {
        bool open = false, beside = false;
        for (int k = 0; k < 4; k++) {
            beside |= cells->cell[c].corner[k] < 0;
            open |= cells->cell[c].corner[k] == upper_z;
        }
        number[c] = open ? BEYOND_OPEN : beside ? BEYOND_CLOSED : (*n)++;
    }
    return number;
}

// How many boxes away from its place in PACKING the cells see a grain: they move grains
// into the box.
static struct image wrapping(const struct packing *packing, const struct grains *grains,
                             int grain)
{
    struct image image = {0};
    for (int axis = 0; axis < 3; axis++) {
        const double lower = component(packing->lower, axis);
        const double edge = component(packing->upper, axis) - lower;
        const double seen = component(grains->position[grain], axis) * grains->unit;
        const double place = component(packing->position[grain], axis) - lower;
        image.along[axis] = (int8_t)nearbyint((seen - place) / edge);
    }
    return image;
}

static void take_cell(struct liquid_pore *pore, const struct pore_cell *cell,
                      const int32_t *number, const struct packing *packing,
                      const struct grains *grains)
{
    for (int k = 0; k < 4; k++) {
        pore->corner[k] = cell->corner[k];
        pore->image[k] = image_sum(cell->corner_image[k],
                                   wrapping(packing, grains, cell->corner[k]));
        pore->beyond[k] =
            cell->neighbour[k] < 0 ? BEYOND_CLOSED : number[cell->neighbour[k]];
    }
}

static struct vector corner_at(const struct pore_liquid *liquid,
                               const struct liquid_pore *pore, int k,
                               const struct vector *at)
{
    const int8_t *boxes = pore->image[k].along;
    return add(at[pore->corner[k]],
               (struct vector){boxes[0] * liquid->edge.x, boxes[1] * liquid->edge.y,
                               boxes[2] * liquid->edge.z});
}

static double tetrahedron(const struct pore_liquid *liquid,
                          const struct liquid_pore *pore, const struct vector *at)
{
    const struct vector a = corner_at(liquid, pore, 0, at);
    const struct vector u = subtract(corner_at(liquid, pore, 1, at), a);
    const struct vector v = subtract(corner_at(liquid, pore, 2, at), a);
    const struct vector w = subtract(corner_at(liquid, pore, 3, at), a);
    return dot(u, cross(v, w)) / 6;
}

enum status pore_liquid_init(struct pore_liquid *liquid, const struct packing *packing,
                             struct reason *reason)
{
    struct grains grains = {0};
    struct cells cells = {0};
    *liquid = (struct pore_liquid){.n_particle = packing->n_particle,
                                   .edge = subtract(packing->upper, packing->lower)};
    const enum status status = find_cells(packing, &grains, &cells, reason);
    if (status) {
        grains_free(&grains);
        return status;
    }
    int32_t *number = number_pores(&cells, &liquid->n);
    liquid->pore = NEW_ARRAY(struct liquid_pore, liquid->n);
    for (int c = 0; c < cells.n; c++) {
        if (number[c] < 0) continue;
        struct liquid_pore *pore = &liquid->pore[number[c]];
        take_cell(pore, &cells.cell[c], number, packing, &grains);
        pore->volume = fabs(tetrahedron(liquid, pore, packing->position));
        liquid->mean_volume += pore->volume / liquid->n;
    }
    free(number);
    cells_free(&cells);
    grains_free(&grains);
    find_menisci(liquid);
    if (liquid->n > 0) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "no four of its %d grains enclose a pore that could hold liquid",
                  packing->n_particle);
}

void pore_liquid_free(struct pore_liquid *liquid)
{
    free(liquid->pore);
    free(liquid->meniscus);
    *liquid = (struct pore_liquid){0};
}

// ---- menisci ------------------------------------------------------------------------

static bool is_meniscus(const struct pore_liquid *liquid, int pore, int facet)
{
    const int32_t beyond = liquid->pore[pore].beyond[facet];
    if (liquid->pore[pore].has_gas) return false;
    return beyond == BEYOND_OPEN || (beyond >= 0 && liquid->pore[beyond].has_gas);
}

void find_menisci(struct pore_liquid *liquid)
{
    int capacity = liquid->n_meniscus = 0;
    free(liquid->meniscus);
    liquid->meniscus = NULL;
    for (int p = 0; p < liquid->n; p++)
        for (int k = 0; k < 4; k++) {
            if (!is_meniscus(liquid, p, k)) continue;
            GROW_ARRAY(liquid->meniscus, liquid->n_meniscus, capacity);
            liquid->meniscus[liquid->n_meniscus++] = (struct meniscus){p, k};
        }
}

void let_gas_in(struct pore_liquid *liquid, const uint8_t *which)
{
    for (int p = 0; p < liquid->n; p++)
        liquid->pore[p].has_gas |= which[p] != 0;
    find_menisci(liquid);
}

struct facet_corners {
    struct vector at[3];
};

// Anticlockwise seen from outside the pore.
static struct facet_corners corners_of(const struct pore_liquid *liquid, int pore,
                                       int facet, const struct vector *at)
{
    struct facet_corners corners;
    for (int m = 0; m < 3; m++)
        corners.at[m] =
            corner_at(liquid, &liquid->pore[pore], facet_corner[facet][m], at);
    return corners;
}

void add_meniscus_forces(const struct pore_liquid *liquid, const struct vector *at,
                         double suction, struct vector *force)
{
    for (int m = 0; m < liquid->n_meniscus; m++) {
        const struct meniscus *meniscus = &liquid->meniscus[m];
        const struct liquid_pore *pore = &liquid->pore[meniscus->pore];
        const struct facet_corners c =
            corners_of(liquid, meniscus->pore, meniscus->facet, at);
        const struct vector twice =
            cross(subtract(c.at[1], c.at[0]), subtract(c.at[2], c.at[0]));
        const struct vector pull = scale(-suction / 6, twice);
        for (int k = 0; k < 3; k++) {
            const int32_t grain = pore->corner[facet_corner[meniscus->facet][k]];
            force[grain] = add(force[grain], pull);
        }
    }
}

// ---- throats ------------------------------------------------------------------------

double throat_radius_at(const struct pore_liquid *liquid, int pore, int facet,
                        const struct vector *at, const double *radius)
{
    const struct facet_corners c = corners_of(liquid, pore, facet, at);
    const struct vector u = subtract(c.at[1], c.at[0]), v = subtract(c.at[2], c.at[0]);
    const double along = norm(u);
    if (!(along > 0)) return 0;
    const double x = dot(u, v) / along;
    const double centre[3][2] = {
        {0, 0}, {along, 0}, {x, norm(subtract(v, scale(x / along, u)))}};
    double radii[3];
    for (int k = 0; k < 3; k++)
        radii[k] = radius[liquid->pore[pore].corner[facet_corner[facet][k]]];
    return inscribed_disc(centre, radii);
}

int mark_entered(const struct pore_liquid *liquid, const struct vector *at,
                 const double *radius, double least, uint8_t *which)
{
    int n = 0;
    for (int m = 0; m < liquid->n_meniscus; m++) {
        const struct meniscus *meniscus = &liquid->meniscus[m];
        if (which[meniscus->pore]) continue;
        if (throat_radius_at(liquid, meniscus->pore, meniscus->facet, at, radius) <
            least)
            continue;
        which[meniscus->pore] = 1;
        n++;
    }
    return n;
}

int mark_distorted(const struct pore_liquid *liquid, const struct vector *at,
                   uint8_t *which)
{
    int n = 0;
    for (int p = 0; p < liquid->n; p++) {
        const struct liquid_pore *pore = &liquid->pore[p];
        if (pore->has_gas || which[p]) continue;
        const double first = fmax(pore->volume, SMALLEST_SHARE * liquid->mean_volume);
        const double share = tetrahedron(liquid, pore, at) / first;
        if (share >= INSIDE_OUT && share <= BURST) continue;
        which[p] = 1;
        n++;
    }
    return n;
}

struct throat {
    double radius;
    int32_t pore;
};

// The widest first; of equals the pore with the lower number.
static int by_radius(const void *a, const void *b)
{
    const struct throat *x = a, *y = b;
    if (x->radius != y->radius) return x->radius > y->radius ? -1 : 1;
    return (x->pore > y->pore) - (x->pore < y->pore);
}

double mark_widest(const struct pore_liquid *liquid, const struct vector *at,
                   const double *radius, double volume, uint8_t *which)
{
    const int n = liquid->n_meniscus;
    struct throat *throat = NEW_ARRAY(struct throat, n);
    for (int m = 0; m < n; m++) {
        const struct meniscus *meniscus = &liquid->meniscus[m];
        throat[m] = (struct throat){
            throat_radius_at(liquid, meniscus->pore, meniscus->facet, at, radius),
            meniscus->pore};
    }
    if (n > 0) qsort(throat, (size_t)n, sizeof *throat, by_radius);
    double narrowest = 0, marked = 0;
    for (int m = 0; m < n && marked < volume && throat[m].radius > 0; m++) {
        if (which[throat[m].pore]) continue;
        which[throat[m].pore] = 1;
        marked += fmax(0, pore_room(liquid, throat[m].pore, at, radius));
        narrowest = throat[m].radius;
    }
    free(throat);
    return narrowest;
}

// ---- volumes ------------------------------------------------------------------------

double pore_room(const struct pore_liquid *liquid, int pore, const struct vector *at,
                 const double *radius)
{
    double room = -3 * tetrahedron(liquid, &liquid->pore[pore], at);
    for (int k = 0; k < 4; k++) {
        const int32_t grain = liquid->pore[pore].corner[k];
        const struct vector apex = corner_at(liquid, &liquid->pore[pore], k, at);
        const struct facet_corners c = corners_of(liquid, pore, k, at);
        room +=
            tetrahedron_outside_ball(radius[grain], subtract(c.at[0], apex),
                                     subtract(c.at[1], apex), subtract(c.at[2], apex));
    }
    return room;
}

double liquid_volume(const struct pore_liquid *liquid, const struct vector *at,
                     const double *radius, double *tetrahedra)
{
    double room = 0, whole = 0;
    for (int p = 0; p < liquid->n; p++) {
        if (liquid->pore[p].has_gas) continue;
        room += pore_room(liquid, p, at, radius);
        whole += tetrahedron(liquid, &liquid->pore[p], at);
    }
    if (tetrahedra) *tetrahedra = whole;
    return room;
}

void find_dryness(const struct pore_liquid *liquid, double *dryness)
{
    double *all = NEW_ARRAY(double, liquid->n_particle);
    memset(dryness, 0, (size_t)liquid->n_particle * sizeof *dryness);
    for (int p = 0; p < liquid->n; p++)
        for (int k = 0; k < 4; k++) {
            const struct liquid_pore *pore = &liquid->pore[p];
            all[pore->corner[k]] += pore->volume;
            if (pore->has_gas) dryness[pore->corner[k]] += pore->volume;
        }
    for (int i = 0; i < liquid->n_particle; i++)
        if (all[i] > 0) dryness[i] /= all[i];
    free(all);
}
