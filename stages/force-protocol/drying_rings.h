// SPDX-License-Identifier: GPL-3.0-or-later
// The pull of the rings that a drying has left at contacts, while they dry.
#pragma once

#include "basics/status.h"
#include "bridges/ratios.h"
#include "liquid_loads.h"

// Each ring pulls its two grains together. It owns its arrays but RECORD.
struct drying_rings {
    int n;
    const struct ring_record *record;
    double surface_tension;   // N/m
    int32_t (*grain)[2];      // (n)
    struct vector *direction; // (n) of length 1, from the first grain to the second
    double *radius;           // (n) effective [G 1], m
    double *asymmetry, *gap;  // (n) as bridge_ratios_forces takes them
    double *whole;            // (n) m3, while nothing has dried
    int *begin, *of_grain;    // (n_particle+1): rings of each grain, ascending
    struct bridge_ratios *table;
};

// The rings of RECORD (kept) in NETWORK. Making the tables takes a second or two of a
// core for grains of one size, some twenty for many. STATUS_BAD_DATA: a ring at a wall;
// STATUS_NOT_CONVERGED as bridge_ratios_create. The caller frees RINGS with
// drying_rings_free, also after a failure.
enum status drying_rings_init(const struct network *network,
                              const struct ring_record *record, double surface_tension,
                              double contact_angle, struct drying_rings *rings,
                              struct reason *reason);
void drying_rings_free(struct drying_rings *rings);

// PULL (n), N: of each ring now. OpenMP, the same for any number of threads. O(parts of
// all rings).
void drying_rings_pull(const struct drying_rings *rings,
                       const struct liquid_loads *liquid, double *pull);

// The sum of PULL on GRAIN.
struct vector drying_rings_force(const struct drying_rings *rings, const double *pull,
                                 int grain);
