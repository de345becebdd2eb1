// SPDX-License-Identifier: GPL-3.0-or-later
// What each reservoir loses of what wet nodes evaporate: the rates of its timer.
#ifndef CRAQUELURE_EVAPORATION_SHARES_H
#define CRAQUELURE_EVAPORATION_SHARES_H

#include "emptying_times.h"

// Of what a node with a path to the air evaporates, this part is taken from the
// reservoir of TIMER.
struct evaporation_share {
    double part;
    int node, timer;
};

// By cluster or by throat; -1 if THROAT holds no liquid.
static inline int reservoir_of(const struct emptying_times *times, int throat)
{
    return times->by_throat ? throat : times->occupancy->clusters.of_throat[throat];
}

// NODE, or both of THROAT, have other throats with liquid than before, or are linked to
// the air now: timers whose sums change are dirty. They begin where there was none,
// and run on without a share.
void share_by_node(struct emptying_times *times, int node);
void share_by_ends(struct emptying_times *times, int throat);

// The rate of TIMER is to be set anew.
void mark_dirty(struct emptying_times *times, int timer);

// Sets the rate of a dirty timer from its sum.
void evaporation_shares_set_rate(struct emptying_times *times, int timer);

// Whether all must be added up anew, as too little is left of a sum for its digits.
bool evaporation_shares_lack_digits(const struct emptying_times *times);

// Sets all rates: sums of positive numbers, so that nothing is lost.
void evaporation_shares_add_up(struct emptying_times *times);

void evaporation_shares_state(struct emptying_times *times,
                              struct checkpoint_stream *stream);

#endif
