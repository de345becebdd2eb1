// SPDX-License-Identifier: GPL-3.0-or-later
// Which throat empties next where the liquid has no viscosity or does not move.
//
// What a wet node evaporates is charged to the throats with liquid beside it, in
// proportion to their cross-sections. Without viscosity all charges of a cluster go to
// its widest meniscus throat [K 3.4.2, steps 2 to 4]; immobile, each throat bears its
// own. A throat that loses has a clock; all that is not beside the gas piece that
// reaches the air has none.
#ifndef CRAQUELURE_CLOCKS_H
#define CRAQUELURE_CLOCKS_H

#include "dry/liquid/occupancy.h"

struct charge; // to an account, of a cluster or of a throat, for what a node evaporates

struct clocks {
    struct phases *phases;
    bool by_throat; // an account for each throat; else for each cluster

    int n_charge;
    struct charge *charge; // (n_charge) of nodes that are linked to the air
    int *charge_incidence; // (n_charge) where the account has a throat at the node
    int *charge_place;     // (2 n_throat) in charge, beside incidence.throat

    // One for each account that is charged.
    int *clock;    // (n_throat) of the account, by cluster or by throat; -1: none
    int n;         // so far, the unused included
    int *owner;    // (n) account, -1: unused
    int *throat;   // (n) that loses, -1: not found yet
    int *charges;  // (n) how many
    bool *has_sum; // (n) whether SUM follows the charges
    struct compensated *sum; // (n) of the charges
    double *summed;          // (n) the largest it was since they were last added up
    double *rate;            // (n) of scaled volume
    double *left;            // (n) liquid of the throat
    double *left_lost;       // (n) what rounding takes from LEFT
    double *since;           // (n) the moment at which so much was left
    double *nothing;         // (n) if no more is left, the throat has emptied
    double *end, *tie;  // (n) the moments at which it has lost all, or all but NOTHING
    double now;         // since all LEFT were last brought up to date
    double *saturation; // (n_throat) of throats whose clock has stopped
    int n_unused;
    int *unused; // (n_unused) clocks
    int n_losing;
    int *losing; // (n_losing) the throats, ascending

    int n_touched;
    int *touched;     // (n_touched) clocks with other charges than before, or no throat
    bool *is_touched; // (n)

    int n_ended, ended_capacity;
    int *ended; // (n_ended) throats that empty now, ascending
};

// For PHASES as they are, with the liquid there is in each throat; they must live as
// long, and throats be emptied only here.
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

// Between two events.
void clocks_state(struct clocks *clocks, struct checkpoint_stream *stream);

void clocks_free(struct clocks *clocks);

#endif
