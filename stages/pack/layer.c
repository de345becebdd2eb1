// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "pack.h"

#include <stdlib.h>
#include <string.h>

// The mean as the first radius and what the others differ by: exact for equal grains.
static double mean_radius(const struct packing *packing)
{
    const double first = packing->radius[0];
    double more = 0;
    for (int i = 0; i < packing->n_particle; i++)
        more += (packing->radius[i] - first) / packing->n_particle;
    return first + more;
}

static double highest_surface(const struct packing *packing)
{
    double top = -HUGE_VAL;
    for (int i = 0; i < packing->n_particle; i++)
        top = fmax(top, packing->position[i].z + packing->radius[i]);
    return top;
}

// Whether the side walls leave room there, whatever the height.
static bool within_sides(const struct domain *domain, struct vector place,
                         double radius)
{
    struct domain tall = *domain;
    tall.periodic[2] = true;
    tall.cut = CUT_NONE;
    return domain_holds(&tall, place, radius);
}

enum status add_layer(const struct domain *domain, struct packing *packing,
                      struct reason *reason)
{
    if (domain->shape == DOMAIN_SPHERE || packing->periodic[2])
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.extra_layer: must be false where there is no top face");
    if (!packing->n_particle)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.extra_layer: must be false where there are no grains");
    const double radius = mean_radius(packing), top = highest_surface(packing);
    const struct vector edge = subtract(packing->upper, packing->lower);
    // as many as fit, evenly spread, so that they also fit a side that repeats
    const double across = fmax(floor(edge.x / (2 * radius) * (1 + 1e-9)), 1);
    const double deep = domain->dimensions == 2
                            ? 1
                            : fmax(floor(edge.y / (2 * radius) * (1 + 1e-9)), 1);
    if (across * deep > 1e8)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.extra_layer: must make at most 1e8 grains");
    const size_t most = (size_t)packing->n_particle + (size_t)(across * deep);
    packing->position = reallocate(packing->position, most, sizeof *packing->position);
    packing->radius = reallocate(packing->radius, most, sizeof *packing->radius);
    packing->kind = reallocate(packing->kind, most, sizeof *packing->kind);
    memset(packing->kind, GRAIN_SOLID, (size_t)packing->n_particle);
    for (int x = 0; x < across; x++)
        for (int y = 0; y < deep; y++) {
            const struct vector place = {packing->lower.x + edge.x * (x + 0.5) / across,
                                         packing->lower.y + edge.y * (y + 0.5) / deep,
                                         top + radius};
            if (domain->shape != DOMAIN_BOX && !within_sides(domain, place, radius))
                continue;
            packing->position[packing->n_particle] = place;
            packing->radius[packing->n_particle] = radius;
            packing->kind[packing->n_particle++] = GRAIN_AUXILIARY;
        }
    packing->upper.z = top + 2 * radius;
    return STATUS_OK;
}
