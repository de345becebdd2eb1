// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own (Kelvin): p_v = p_sat exp(-p_c M/(rho R
// T)) above a meniscus of capillary pressure p_c = 2 sigma cos(theta) / r.
//
// Each throat has a meniscus of its own, as liquid has that does not move. A node
// between several has the mean of their potentials, by the sections of the throats, as
// it shares out what it evaporates.
//
// So vapour goes from wide menisci to narrow ones, and may condense there: a throat
// partly empty then fills. In a full one the meniscus becomes flatter until it neither
// takes nor gives: its pressure is unknown, and found so that nothing condenses and no
// meniscus is more curved than its throat makes it (an obstacle problem).
#ifndef CRAQUELURE_CURVED_H
#define CRAQUELURE_CURVED_H

#include "conditions.h"
#include "losses.h"
#include "phases.h"

struct curved {
    double *own;     // (n_throat) potential above its meniscus: 0 flat, 1 as in the air
    double rate;     // into the air, scaled
    double residual; // largest so far of the balances, of that rate

    // Of the throats with liquid beside gas.
    int n;
    int *throat;              // (n)
    double *potential;        // (n)
    double *gain;             // (n) what it evaporates; below 0: takes up
    bool *floats;             // (n) flatter than its throat makes it
    int *place;               // (n_throat) of a throat, -1 between calls
    double *noise, all_noise; // (n) less gain than this is none; their sum
    double *step, *change;    // (n) room
    double *level, *flow;     // (n_site) room
};

struct curved curved_make(const struct phases *phases,
                          const struct drying_conditions *conditions);

// STATUS_BAD_DATA with the throat whose meniscus has no more vapour than the air: it
// never dries.
enum status check_curved(const struct drying_conditions *conditions,
                         const struct network *network, struct reason *reason);

// What each throat loses, or takes up (negative), with PHASES as they are. LOSSES come
// in ascending throats.
//
// STATUS_NOT_CONVERGED if the menisci are not found.
enum status curved_find(struct curved *curved, struct phases *phases,
                        struct losses *losses, struct reason *reason);

void curved_state(struct curved *curved, struct state *state);

void curved_free(struct curved *curved);

#endif
