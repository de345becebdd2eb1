// SPDX-License-Identifier: GPL-3.0-or-later
// Which throat empties next where the liquid has no viscosity or does not move.
//
// What a wet node evaporates is taken from the throats with liquid beside it, in
// proportion to their cross-sections. Without viscosity a cluster loses all its shares
// from its widest meniscus throat [K 3.4.2, steps 2 to 4]; immobile, each throat loses
// its own. A throat that loses has a timer: the moment at which it will have emptied
// (discrete-event simulation). Liquid that no vapour leaves has none.
//
// Rings at a node are a reservoir of their own, which loses what the node evaporates
// once no throat there holds liquid: while one does, its flatter meniscus keeps the
// vapour from them. They are numbered behind the throats: n_throat + node. Films let
// their cluster lose it in their place, as long as it has a throat with liquid; those
// of finite resistance, as far as they reach (film_supply.h).
#pragma once

#include "dry/liquid/occupancy.h"

// The part of a node's evaporation that one reservoir (cluster or throat) supplies.
struct evaporation_share;

struct film_supply;
struct timer_block;

struct emptying_times {
    struct occupancy *occupancy;
    const struct air_links *air; // what its nodes evaporate
    bool by_throat;              // a reservoir for each throat; else for each cluster
    int n_place;                 // throats; with rings n_throat + n_node
    struct film_supply *films;   // NULL: none of finite resistance

    int n_share;
    struct evaporation_share *share; // (n_share) of nodes that are linked to the air
    int *share_incidence; // (n_share) where the reservoir has a throat at the node
    int *share_place;     // (2 n_throat) in share, beside incidence.throat

    // One for each reservoir that loses.
    int *timer;    // (n_place) of the reservoir, by cluster, throat or rings; -1: none
    int n;         // so far, the unused included
    int *owner;    // (n) reservoir, -1: unused
    int *throat;   // (n) that loses, or rings; -1: not found yet
    int *shares;   // (n) how many
    bool *has_sum; // (n) whether SUM follows the shares
    struct compensated *sum; // (n) of the shares
    double *summed;          // (n) the largest it was since they were last added up
    double *rate;            // (n) of scaled volume
    double *left;            // (n) liquid of the throat
    double *left_lost;       // (n) what rounding takes from LEFT
    double *since;           // (n) the moment at which so much was left
    double *nothing;         // (n) if no more is left, the throat has emptied
    double *end, *tie; // (n) the moments at which it has lost all, or all but NOTHING
    struct timer_block *block; // the earliest ends of timers side by side
    double now;                // since all LEFT were last brought up to date
    double *saturation;        // (n_place) of those whose timer has stopped
    int n_unused;
    int *unused; // (n_unused) timers
    int n_losing;
    int *losing; // (n_losing) the throats and rings, ascending

    int n_dirty;
    int *dirty;     // (n_dirty) timers with other shares than before, or no throat
    bool *is_dirty; // (n)

    int n_ended, ended_capacity;
    int *ended; // (n_ended) throats and rings that empty now, ascending
};

// For OCCUPANCY as they are, with the liquid there is in each throat; they must live as
// long, and throats be emptied only here.
struct emptying_times emptying_times_init(struct occupancy *occupancy, bool by_throat);

// Goes to the moment at which the first throat, or several that tie to rounding, lose
// their last liquid; they become times->ended. Returns the time that has passed; -1 if
// nothing evaporates any more.
double emptying_times_advance(struct emptying_times *times);

// What evaporates until then; 0 if nothing does any more.
double emptying_times_next_loss(struct emptying_times *times);

// Gas fills the ended throats. The timers run on with the rates that follow.
void emptying_times_empty_ended(struct emptying_times *times);

// Saturation of THROAT, or of rings, now, from 0 to 1.
double emptying_times_saturation(const struct emptying_times *times, int throat);

// What all throats lose less what goes into the air, relative to the latter: rounding.
double emptying_times_imbalance(const struct emptying_times *times);

// Writes to STREAM, or restores from it, the state between two events.
void emptying_times_state(struct emptying_times *times,
                          struct checkpoint_stream *stream);

void emptying_times_free(struct emptying_times *times);
