// SPDX-License-Identifier: GPL-3.0-or-later
// Two-way capillarity: gas enters the pores of a layer from above while its grains move
// and its bonds break. Menisci pull at the grains where they are, and throats are as
// wide as grains have left them (network/pore_liquid.h).
//
// Units are SI, times are counts of time steps of the engine. A step of the load has
// ROUNDS rounds by evaporation: gas enters, the suction moves to what the narrowest of
// the throats needs, grains follow for ROUND time steps. Between two entries forces
// follow the grains, connections do not.
#pragma once

#include "dem/dem.h"
#include "network/pore_liquid.h"

enum capillary_control {
    CONTROL_SUCTION,    // rises evenly; gas enters whatever it can
    CONTROL_EVAPORATION // liquid goes evenly, from the widest throats; the suction is
                        // that which the narrowest of them needs
};

// Of which places: of the grains as they are, or (one way) as they began.
enum geometry_of { GEOMETRY_PRESENT, GEOMETRY_FIRST };

// How to drain. It owns nothing.
struct capillarity {
    enum capillary_control control;
    enum geometry_of forces, throats;
    double suction;      // Pa, the largest; 0: there is no liquid
    double tension;      // N/m, times the cosine of the contact angle
    double last_drained; // by evaporation: share of the liquid that goes, in (0,1]
    int64_t steps;       // of the load
    int64_t round;       // time steps between two entries of gas
    int64_t rounds;      // by evaporation: entries in a step of the load
};

// What each row of the load ends with; it owns its arrays (n_time).
struct drainage_history {
    double first_liquid;            // m3, before the first row
    double *suction;                // Pa
    double *liquid;                 // m3 in pores
    double *drained;                // m3 that pores held when gas entered them, so far
    int32_t *gas_pores, *distorted; // pores with gas; of them, by mark_distorted
};

// Time steps of a step of the load in which gas enters, at least.
double least_cycles(const struct capillarity *how);

struct drainage_history drainage_history_init(int n_time);
void drainage_history_free(struct drainage_history *history);

// A drainage on the way. It owns its arrays.
struct drainage {
    const struct capillarity *how;
    struct pore_liquid liquid;
    int n_particle;
    struct vector *first, *at;     // (n_particle) m; at: when gas last entered
    double *first_radius, *radius; // (n_particle) m
    double begin;                  // m3 of liquid
    double drained;                // m3
    double target;                 // m3 of it by the end of the step, by evaporation
    int32_t n_gas, n_distorted;
    double from, to;              // Pa: the suction changes evenly
    int64_t since, until;         // between these time steps
    int64_t round_began, entered; // time steps: this round; gas, last
};

// The pores of PACKING, full but where gas reaches from above through throats of half a
// mean diameter. STATUS_BAD_DATA as pore_liquid_init, and if no pore is left with
// liquid.
enum status drainage_begin(struct drainage *drainage, const struct capillarity *how,
                           const struct packing *packing, struct reason *reason);
void drainage_free(struct drainage *drainage);

// Lets the suction change to SUCTION over CYCLES time steps from NOW.
void aim_at_suction(struct drainage *drainage, double suction, int64_t now,
                    int64_t cycles);

// Adds to FORCE what menisci do to the grains of DEM now.
void add_capillary_forces(const struct drainage *drainage, const struct dem *dem,
                          struct vector *force);

// Gas enters pores, each beside where it is; by evaporation as many as hold the liquid
// of a round, and the suction follows. Returns how many.
int enter_gas(struct drainage *drainage, const struct dem *dem);

// Gas takes the pores that have turned inside out or burst (mark_distorted).
void empty_distorted(struct drainage *drainage, const struct dem *dem);

// By evaporation: what the end of ROW should have taken, and whether it is taken.
void aim_at_volume(struct drainage *drainage, int row);
bool has_evaporated(const struct drainage *drainage);

// Notes the state in ROW of HISTORY; returns the saturation, in [0,1].
double note_drainage(const struct drainage *drainage, const struct dem *dem, int row,
                     struct drainage_history *history);

// The lateral tension of the liquid now, Pa over the volume of the box.
double liquid_tension(const struct drainage *drainage, const struct dem *dem);
