// SPDX-License-Identifier: GPL-3.0-or-later
// Pore-network drying [K 3.4, 3.3.5, 5.4]: when each throat empties, as vapour leaves a
// network of liquid-filled throats through its open walls.
//
// Model. Vapour diffuses, quasi-steadily and isothermally, through the throats that are
// completely empty and through a boundary layer above the open wall [K 3.9]. A node
// that touches both liquid and gas is wet: its vapour is saturated, and what it
// evaporates is shared to the liquid throats at the node in proportion to their
// cross-sections. With rings a throat leaves liquid at the contacts around it, which
// keeps its nodes wet until it has dried; films bring more to it if asked for. Left
// out: adsorption, viscosity of the gas, gradients of temperature [K 3.4.2].
//
// Everything here is in SI units. Inside, lengths are scaled by the mean throat length
// and vapour by its driving force, so that the same network at another scale gives the
// same dimensionless result.
//
//     struct drying_history history;
//     enum status status = dry_network(&network, &conditions, NULL, &history, &reason);
//     for (int k = 0; !status && k < history.n_step; k++)
//         history.saturation[k] at history.time[k]
//     drying_history_free(&history);
// The saturation of all throats at a step is found by adding the changes of all steps
// up to it (profiles.c, network/drying_record.h). Conditions must be complete: names of
// liquids are looked up before (dry/parameters.h). The same input gives the same bytes,
// on any number of threads.
#pragma once

#include "basics/status.h"
#include "checkpoint/keeper.h"
#include "dry/conditions.h"
#include "network/network.h"

struct ring_history;
struct film_history;

enum event_kind {
    EVENT_EMPTIED = 0, // completely
    EVENT_REFILLED = 1 // by flow from its cluster, after it was partly empty
};

// What happened, from the start to the dry network. Step 0 is the initial state;
// each later step is the moment at which a throat has just emptied, or several that tie
// to rounding (as all do that recede at one speed from one node). In viscous liquid it
// may also be that of a throat that has filled again, or of a change of
// saturation_step. Between two steps every throat's saturation is linear in time, and
// the rate is constant.
struct drying_history {
    int n_step;
    double *time;       // (n_step) s, increasing (as far as its digits reach) from 0
    double *saturation; // (n_step) liquid over the throats' volume; to exactly the stop
    double *rate;       // (n_step) kg/s into the drying air from this step to the next;
                        // the last is 0 when all is dry
    int32_t *clusters;  // (n_step) connected pieces of liquid

    int n_event;           // one for each throat that held liquid, and the refills
    double *event_time;    // (n_event) s
    int32_t *event_throat; // (n_event) index in the network
    uint8_t *event_kind;   // (n_event) enum event_kind

    // Throats whose saturation at step k differs from that at step k-1, ascending
    // within a step: entries change_offset[k] .. change_offset[k+1]-1. At step 0 those
    // of kind THROAT_NETWORK that do not begin full (the others never hold liquid).
    int64_t *change_offset;    // (n_step+1)
    int32_t *change_throat;    // (change_offset[n_step])
    double *change_saturation; // of the throat, 0 to 1; exactly 0 once empty

    // Saturation of the network when gas first reaches a node on a closed wall opposite
    // an open one; 0 if it never does (or only as the last throat empties).
    double breakthrough_saturation;
    // Saturation at which the rate first is below first_period_rate_fraction times the
    // first rate, and when (s), also where no step is recorded then; 0 if it never is.
    double first_period_end_saturation, first_period_end_time;

    struct ring_history *rings; // what became of rings (ring_history.h); NULL: none
    struct film_history *films; // with rings=films (film_history.h); NULL: none

    double boundary_layer_thickness; // m
    int boundary_layers;
    double initial_liquid; // kg in the throats at the first step; all of it is lost if
                           // the run goes on until all are dry
    double evaporated;     // kg: integral of the rate into the drying air
    double
        vapour_residual; // |what throats lose less what reaches the air|, of the rate
    int n_pressure;      // snapshots so far
    double *pressure;    // (n_snapshot, n_node) Pa, of viscous liquid less that of the
                      // gas, in the first step with at most the snapshot's saturation;
                      // 0 in gas. NULL: none asked for, or the liquid is not viscous
    double
        liquid_residual; // of the liquid's balances, of the largest flow in a cluster
    int64_t flow_solutions, flow_rounds; // clusters solved, and rounds to find menisci
};

// Who follows the run: REPORT is called after each event with the fraction of throats
// that have emptied.
struct drying_progress {
    void (*report)(void *context, double fraction); // may be NULL
    void *context;
    const struct keeper *keeper; // keeps the state on the way; may be NULL
};

// Dries NETWORK, of which only the throats of kind THROAT_NETWORK take part, to the
// end. HISTORY is overwritten; the caller frees it with drying_history_free, also after
// a failure. PROGRESS may be NULL.
//
// STATUS_BAD_DATA: conditions under which nothing would dry or that are not positive;
// no open wall; a throat of zero length or radius (merge-nodes removes the
// first); no throat reaches the open wall; liquid without a way to it.
// STATUS_NOT_CONVERGED: rates too small for the arithmetic to dry anything.
//
// Cost of an event: the square of the wet nodes that see each other through the gas, at
// most; the rest goes with those it changes, and with what is recorded. STATUS_BAD_DATA
// also for a keeper with rings=films: such a state cannot be kept.
enum status dry_network(const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_progress *progress,
                        struct drying_history *history, struct reason *reason);

// Frees what the history owns and empties it; safe on an empty one.
void drying_history_free(struct drying_history *history);
