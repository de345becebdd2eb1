// SPDX-License-Identifier: GPL-3.0-or-later
// Films of finite resistance: which reservoirs lose what others evaporate.
//
// A reservoir (a cluster, or the rings at a node) evaporates the sum E of its shares.
// It loses
//     own E + scale drawn:
// of what it evaporates the part `own`, from 0 to 1, while films bring the rest, and
// `drawn`, which films take from it to elsewhere. `scale` makes the sum of all losses
// what goes into the air, exactly; it is 1 when the flow in films has just been found.
#pragma once

#include "emptying_times.h"

struct film_supply {
    double *own, *drawn; // (n_place) by reservoir: cluster, or n_throat + node
    double scale;
    double evaporation; // scaled, of nodes without liquid in throats, that films bring
    int n_source;
    int *source; // (n_source) by basin, the cluster it draws from; -1: none is left
    struct film_basins *basins;
    struct film_inflow *inflow;

    bool *reached; // (n_node) films reach it: its rings keep their liquid
    bool *floats;  // (n_throat) by cluster: films bring all it evaporates
    bool *falls;   // (n_throat) one of a basin whose level has fallen to float since
    // (n_throat) What films bring to it at the level it had, and what more by each unit
    // of level that it falls, over what it evaporated then.
    double *brought, *response;
    struct compensated *level;  // (n_place) cube of the menisci's radius, scaled
    bool *is_known;             // (n_place) the level is that of the last solution
    double *evaporates;         // (n_place) scaled, when last found; 0: no shares
    int32_t *curve;             // (n_node) nodes, near ones after each other
    struct film_factor *factor; // kept from one solution to the next
    bool is_due;                // reservoirs have changed so that flows must be found
    double stray;               // what films bring now beyond what was drawn then
    double at_risk;             // what films might not bring from other sources
    double lack;                // what they do not bring where they came since
    double saturation;          // when last found
    bool failed;                // they were not
    int64_t solutions;          // so far
};

// For TIMES, whose occupancy has a film law. The caller frees it with film_supply_free;
// NULL is allowed.
struct film_supply *film_supply_create(const struct emptying_times *times);
void film_supply_free(struct film_supply *films);

// Whether flows are to be found again at this event.
bool film_supply_is_due(const struct emptying_times *times);

// Finds the flows, from the sums of shares in TIMES->rate: sets OWN, DRAWN, SOURCE.
void film_supply_find(struct emptying_times *times);

// Replaces the sums of shares in TIMES->rate by what reservoirs lose.
void film_supply_set_rates(struct emptying_times *times);

// Whether the state may be kept now: what is left from earlier solutions to find the
// next one faster will be forgotten first.
bool film_supply_may_be_kept(const struct film_supply *films);

// Writes to STREAM, or restores from it, the state between two events at which it may
// be kept.
void film_supply_state(struct emptying_times *times, struct checkpoint_stream *stream);

// Whether clusters that films draw from, now or later, have liquid: a restored state
// may say otherwise.
bool film_supply_fits(const struct emptying_times *times);

// THROAT of CLUSTER has emptied, and what has parted from it are clusters of their own.
void film_supply_empty_throat(struct emptying_times *times, int throat, int cluster);
