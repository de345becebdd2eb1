// SPDX-License-Identifier: GPL-3.0-or-later
// The extra layer [K 3.3.5]: a regular grid of auxiliary grains of the mean radius,
// which touches the outermost grain on one side. The grid is spread evenly over the
// box, so that it also fits a periodic one.
//     count = floor(edge / (2 radius)) along each axis of the side,
//     place = lower + edge (i + 1/2) / count.
#include "basics/memory.h"
#include "pack.h"

#include <stdlib.h>
#include <string.h>

// Mean radius, as the first plus the mean difference: exact for equal grains.
static double mean_radius(const struct packing *packing)
{
    const double first = packing->radius[0];
    double more = 0;
    for (int i = 0; i < packing->n_particle; i++)
        more += (packing->radius[i] - first) / packing->n_particle;
    return first + more;
}

// The coordinate of the outermost surface of a grain towards WALL.
static double farthest_surface(const struct packing *packing, int wall)
{
    const double sign = wall % 2 ? 1 : -1;
    double far = -HUGE_VAL;
    for (int i = 0; i < packing->n_particle; i++)
        far = fmax(far, sign * component(packing->position[i], wall / 2) +
                            packing->radius[i]);
    return sign * far;
}

// Whether a grain fits within the round walls there, at any height.
static bool within_sides(const struct domain *domain, struct vector place,
                         double radius)
{
    struct domain tall = *domain;
    tall.periodic[2] = true;
    tall.cut = CUT_NONE;
    return domain_holds(&tall, place, radius);
}

enum status check_layer(const struct domain *domain, int wall, struct reason *reason)
{
    static const char *const names[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    const int axis = wall / 2;
    const bool flat =
        domain->shape == DOMAIN_BOX || (domain->shape != DOMAIN_SPHERE && axis == 2);
    if (flat && !domain->periodic[axis] && !(domain->dimensions == 2 && axis == 1))
        return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.extra_layer: must be false where there is no flat side %s",
                  names[wall]);
}

// The number of grains that fit side by side along AXIS.
static double count_beside(const struct domain *domain, struct vector edge, int axis,
                           double radius)
{
    if (domain->dimensions == 2 && axis == 1) return 1;
    return fmax(floor(component(edge, axis) / (2 * radius) * (1 + 1e-9)), 1);
}

// The place (I, J) in the layer, of COUNT along each of its two axes.
static struct vector place_of(const struct packing *packing, const int axis[2],
                              const double count[2], int i, int j)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    struct vector place = packing->lower;
    const double along[2] = {i + 0.5, j + 0.5};
    for (int k = 0; k < 2; k++)
        set_component(&place, axis[k],
                      component(place, axis[k]) +
                          component(edge, axis[k]) * along[k] / count[k]);
    return place;
}

enum status add_layer(const struct domain *domain, int wall, struct packing *packing,
                      struct reason *reason)
{
    const enum status status = check_layer(domain, wall, reason);
    if (status) return status;
    if (!packing->n_particle)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.extra_layer: must be false where there are no grains");
    const int out = wall / 2, axis[2] = {out == 0 ? 1 : 0, out == 2 ? 1 : 2};
    const double radius = mean_radius(packing), sign = wall % 2 ? 1 : -1;
    const double far = farthest_surface(packing, wall);
    const struct vector edge = subtract(packing->upper, packing->lower);
    const double count[2] = {count_beside(domain, edge, axis[0], radius),
                             count_beside(domain, edge, axis[1], radius)};
    if (count[0] * count[1] > 1e8)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.extra_layer: must make at most 1e8 grains");
    const size_t most = (size_t)packing->n_particle + (size_t)(count[0] * count[1]);
    packing->position = reallocate(packing->position, most, sizeof *packing->position);
    packing->radius = reallocate(packing->radius, most, sizeof *packing->radius);
    const bool all_solid = !packing->kind;
    packing->kind = reallocate(packing->kind, most, sizeof *packing->kind);
    if (all_solid) memset(packing->kind, GRAIN_SOLID, (size_t)packing->n_particle);
    for (int i = 0; i < count[0]; i++)
        for (int j = 0; j < count[1]; j++) {
            struct vector place = place_of(packing, axis, count, i, j);
            set_component(&place, out, far + sign * radius);
            if (domain->shape != DOMAIN_BOX && !within_sides(domain, place, radius))
                continue;
            packing->position[packing->n_particle] = place;
            packing->radius[packing->n_particle] = radius;
            packing->kind[packing->n_particle++] = GRAIN_AUXILIARY;
        }
    set_component(wall % 2 ? &packing->upper : &packing->lower, out,
                  far + sign * 2 * radius);
    return STATUS_OK;
}
