// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "basics/progress.h"
#include "basics/status.h"
#include "domain.h"
#include "geometry/packing.h"
#include "sizes.h"

#include <stdbool.h>
#include <stdint.h>

// Room for N grains in the box around DOMAIN, all of them still at the origin with no
// radius, without bonds. The caller frees the packing.
struct packing packing_in(const struct domain *domain, int n);

// ---- lattices of touching grains ----------------------------------------------------

// By the unit cells in lattice.c.
enum lattice {
    LATTICE_CUBIC, // also the square lattice, one layer of it
    LATTICE_BODY_CENTRED,
    LATTICE_FACE_CENTRED,
    LATTICE_HEXAGONAL,  // hexagonal close packing; cell 1 : sqrt(3) : sqrt(8/3)
    LATTICE_TRIANGULAR, // one layer, in x and z
    LATTICE_HONEYCOMB   // rings of six in x and z, one layer on the other in y
};

// Edges of the box that COUNTS unit cells fill, m: whole cells where it repeats, around
// the grains elsewhere. RADIUS in m.
struct vector lattice_extent(enum lattice lattice, const int64_t counts[3],
                             double radius, const bool periodic[3]);

// The unit cells it takes to cover DOMAIN. STATUS_BAD_DATA when they do not fit a side
// that repeats. Counts are at least 1 where it repeats.
enum status lattice_counts(enum lattice lattice, const struct domain *domain,
                           double radius, int64_t counts[3], struct reason *reason);

// Grains of COUNTS unit cells; -1 when they are more than 1e8. Before those outside of
// a round domain are left away.
int64_t lattice_grains(enum lattice lattice, const int64_t counts[3]);

// Those of them that lie wholly in DOMAIN, x slowest. The caller frees the packing.
struct packing lattice_packing(enum lattice lattice, const int64_t counts[3],
                               double radius, const struct domain *domain);

// ---- random places ------------------------------------------------------------------

// COUNT grains at independent random points, uniformly distributed where a grain of
// that size fits: they may overlap. STATUS_BAD_DATA if what is cut out leaves no room.
// On success the caller frees *PACKING. RANDOM advances.
enum status poisson_points(const struct domain *domain, const struct sizes *sizes,
                           int count, gsl_rng *random, struct packing *packing,
                           struct reason *reason);

// Random sequential addition: each grain where a random point first leaves it free of
// overlap, the largest first. With COUNT = 0 in the order drawn, until MOST_TRIALS in a
// row fail; otherwise that is STATUS_NOT_CONVERGED. On success the caller frees
// *PACKING.
enum status random_sequential(const struct domain *domain, const struct sizes *sizes,
                              int count, int64_t most_trials, gsl_rng *random,
                              struct progress *progress, struct packing *packing,
                              struct reason *reason);

// COUNT grains at random points, relaxed until they overlap no more or are jammed, in a
// box that may repeat. STATUS_NOT_CONVERGED: neither within its steps. On success the
// caller frees *PACKING. RANDOM advances.
enum status soft_spheres(const struct domain *domain, const struct sizes *sizes,
                         int count, gsl_rng *random, struct progress *progress,
                         struct packing *packing, struct reason *reason);

// Keeps the grains with their centres from LOWER to UPPER along z, m, NAN: no end, and
// no bonds; PACKING and DOMAIN end on them and no longer repeat along z. Nothing if
// both are NAN. STATUS_BAD_DATA: no box, LOWER not below UPPER, or no grain between.
enum status cut_slab(double lower, double upper, struct domain *domain,
                     struct packing *packing, struct reason *reason);

// ---- inward spiral ------------------------------------------------------------------

// [K 3.1.2], in two dimensions: grains along the walls first, then each where it
// touches two others, spiralling inwards until no place is left, or COUNT (if not 0)
// are in. With DENSIFY voids then take grains down to LEAST, m, that touch three. On
// success the caller frees *PACKING.
enum status inward_spiral(const struct domain *domain, const struct sizes *sizes,
                          int count, bool densify, double least, gsl_rng *random,
                          struct packing *packing, struct reason *reason);

// ---- the extra layer ----------------------------------------------------------------

// Adds a regular layer of auxiliary grains of the mean radius on the outermost grain
// towards WALL, 0 to 5, over the whole box within the walls of DOMAIN, and ends the box
// with it [K 3.3.5]. They come last and have no bonds. STATUS_BAD_DATA if that side is
// round or periodic.
enum status add_layer(const struct domain *domain, int wall, struct packing *packing,
                      struct reason *reason);

// The check alone, for before the grains are moved.
enum status check_layer(const struct domain *domain, int wall, struct reason *reason);

// ---- contacts -----------------------------------------------------------------------

// Porosity of the box; overlaps count twice as solid. Can be below 0 where grains
// overlap much.
double packing_porosity(const struct packing *packing);
