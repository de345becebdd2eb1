// SPDX-License-Identifier: GPL-3.0-or-later
// What wet nodes charge clocks with: the rates of struct clocks, which they keep.
#ifndef CRAQUELURE_CHARGES_H
#define CRAQUELURE_CHARGES_H

#include "emptying_times.h"

// What a node that is linked to the air charges an account with, of what it evaporates.
struct charge {
    double share;
    int node, clock;
};

// By cluster or by throat; -1 if THROAT holds no liquid.
static inline int account_of(const struct clocks *clocks, int throat)
{
    return clocks->by_throat ? throat : clocks->phases->clusters.of_throat[throat];
}

// NODE, or both of THROAT, have other throats with liquid than before, or are linked to
// the air now: clocks whose sums change are touched. They begin where there was none,
// and run on without a charge.
void charge_by_node(struct clocks *clocks, int node);
void charge_by_ends(struct clocks *clocks, int throat);

// The rate of CLOCK is to be set anew.
void touch_clock(struct clocks *clocks, int clock);

// Sets the rate of a touched clock from its sum.
void charges_set_rate(struct clocks *clocks, int clock);

// Whether all must be added up anew, as too little is left of a sum for its digits.
bool charges_lack_digits(const struct clocks *clocks);

// Sets all rates: sums of positive numbers, so that nothing is lost.
void charges_add_up(struct clocks *clocks);

void charges_state(struct clocks *clocks, struct checkpoint_stream *stream);

#endif
