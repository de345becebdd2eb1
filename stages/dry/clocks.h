// SPDX-License-Identifier: GPL-3.0-or-later
// Which throat empties next where the liquid has no viscosity or does not move: each
// throat that loses liquid has a clock, which is set anew only when its rate changes.
//
// What a wet node evaporates is charged to the throats with liquid beside it, in
// proportion to their cross-sections. Without viscosity all charges of a cluster go to
// its widest meniscus throat [K 3.4.2, steps 2 to 4]; immobile, each throat bears its
// own.
#ifndef CRAQUELURE_CLOCKS_H
#define CRAQUELURE_CLOCKS_H

#include "phases.h"

struct clock;

struct clocks {
    struct phases *phases;
    bool by_throat;         // a clock for each throat; else for each cluster
    struct compensated now; // scaled
    double (*charge)[2];    // (n_throat) from each end
    double *section; // (n_throat) of those that hold liquid, of the rest 0; any scale

    struct clock *clock; // by throat or cluster
    int n_clock, clock_capacity;
    int n_heap;
    int *heap; // (n_heap) clocks that run, the first to end on top
    int n_touched;
    int *touched; // clocks whose rate or throat has changed at this moment

    int n_losing, losing_capacity;
    int *losing; // (n_losing) throats whose clocks run, ascending

    int n_ended, ended_capacity;
    int *ended; // (n_ended) throats that empty now, ascending
};

// For PHASES as they are; they must live as long, and throats be emptied only here.
struct clocks clocks_make(struct phases *phases, bool by_throat);

// Goes to the moment at which the first throat, or several that tie to rounding, lose
// their last liquid; they become clocks->ended. Returns the time that has passed; -1 if
// nothing evaporates any more.
double clocks_advance(struct clocks *clocks);

// Gas fills the ended throats. The clocks run on with the rates that follow.
void clocks_empty_ended(struct clocks *clocks);

// Of a throat now: of its volume.
double clocks_saturation(const struct clocks *clocks, int throat);

// What the throats lose, all together, less what goes into the air; of the latter.
double clocks_imbalance(const struct clocks *clocks);

void clocks_free(struct clocks *clocks);

#endif
