// SPDX-License-Identifier: GPL-3.0-or-later
// Random points, and random sequential addition (RSA; Widom 1966): a grain is placed at
// the first of many uniform points where it overlaps no other. With a fixed count the
// largest come first, since they have the fewest places; without, grains come in the
// order drawn until a given number of trials in a row fail. Every placed grain is
// uniformly distributed over the places that are free of overlap. With equal grains RSA
// jams near a solid fraction of 0.38 in three dimensions and 0.55 in two.
#include "basics/memory.h"
#include "grids.h"
#include "pack.h"

#include <stdlib.h>

enum status poisson_points(const struct domain *domain, const struct sizes *sizes,
                           int count, gsl_rng *random, struct packing *packing,
                           struct reason *reason)
{
    *packing = packing_in(domain, count);
    for (int i = 0; i < count; i++) {
        packing->radius[i] = sizes_draw(sizes, random);
        if (domain_random_point(domain, packing->radius[i], random,
                                &packing->position[i]))
            continue;
        packing_free(packing);
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.cut.shape: must leave room for the grains");
    }
    return STATUS_OK;
}

static int falling(const void *a, const void *b)
{
    const double *first = a, *second = b;
    return (*first < *second) - (*first > *second);
}

// A place where a grain overlaps no other. False after MOST_TRIALS points in a row
// without one.
static bool find_place(const struct grids *grids, const struct domain *domain,
                       double radius, int64_t most_trials, gsl_rng *random,
                       struct vector *place)
{
    int other;
    for (int64_t k = 0; k < most_trials; k++)
        if (domain_random_point(domain, radius, random, place) &&
            !grids_near(grids, *place, radius, 0, &other, 1))
            return true;
    return false;
}

static struct packing take_grains(const struct domain *domain,
                                  const struct grids *grids)
{
    struct packing packing = packing_in(domain, grids_count(grids));
    for (int i = 0; i < packing.n_particle; i++) {
        packing.position[i] = grids_centre(grids, i);
        packing.radius[i] = grids_radius(grids, i);
    }
    return packing;
}

static double solid_share(const struct domain *domain, const struct grids *grids)
{
    const double room = domain_volume(domain);
    const double thick = domain->upper.y - domain->lower.y;
    double share = 0;
    for (int i = 0; i < grids_count(grids); i++) {
        const double radius = grids_radius(grids, i);
        share += M_PI * radius * radius / room *
                 (domain->dimensions == 2 ? thick : 4 * radius / 3);
    }
    return share;
}

// The number of smallest grains that would fill the domain, at most 1e6.
static double most_grains(const struct domain *domain, double smallest)
{
    const double volume = 4 * smallest * smallest * smallest;
    return fmin(domain_volume(domain) / volume, 1e6);
}

enum status random_sequential(const struct domain *domain, const struct sizes *sizes,
                              int count, int64_t most_trials, gsl_rng *random,
                              struct progress *progress, struct packing *packing,
                              struct reason *reason)
{
    double *radius = sizes_draw_many(sizes, count, random);
    if (count) qsort(radius, (size_t)count, sizeof *radius, falling);
    enum status status = domain_check_filling(domain, radius, count, reason);
    if (status) {
        free(radius);
        return status;
    }
    struct grids *grids =
        grids_create(domain, sizes->smallest, sizes->largest,
                     count ? count : most_grains(domain, sizes->smallest));
    bool jammed = false;
    for (int i = 0; !jammed && (!count || i < count); i++) {
        const double next = count ? radius[i] : sizes_draw(sizes, random);
        struct vector place;
        jammed = !find_place(grids, domain, next, most_trials, random, &place);
        if (!jammed) grids_add(grids, place, next);
        if (count) progress_update(progress, (double)i / count);
    }
    if (jammed && count)
        status = refuse(reason, STATUS_NOT_CONVERGED,
                        "only %d of %d grains fit, a solid share of %.4f: %lld trials "
                        "in a row found no place (pack.most_trials)",
                        grids_count(grids), count, solid_share(domain, grids),
                        (long long)most_trials);
    else
        *packing = take_grains(domain, grids);
    grids_free(grids);
    free(radius);
    return status;
}
