// SPDX-License-Identifier: GPL-3.0-or-later
// Which throat of viscous liquid empties or refills next, where flow (flow_step) and
// vapour (vapour_step) are kept for a while: an event costs what it changes, and not
// all menisci.
//
// Between two solutions of its flow a throat of a cluster loses
//     loss = scale rate,   and where it refills   loss = rate, below 0,
//     scale = (evaporation + refilling) / losing,
// with sums over the cluster's throats: the cluster loses what it evaporates. In
// this way a throat that empties hands its loss to the others; the next solution
// spreads it as the flow does. The cluster has a clock that runs SCALE times as fast as
// time: by it throats empty at fixed readings, whatever the scale.
//
// Where vapour is kept everything happens vapour_pace times as fast (vapour.h), from 1
// just after the vapour was found to more before it is found again. Liquid does not
// flow the faster for it. So nodes evaporate PACE times what they do without what is on
// its way, the mean between the last two times, and time runs by the rest:
//     duration = span PACE / vapour_pace.
#pragma once

#include "indexed_heap.h"
#include "losses.h"
#include "viscous.h"

enum meniscus_queue { QUEUE_LOSING, QUEUE_REFILLING, QUEUES };

// Sums over the throats of a cluster, in scaled volume over scaled time.
struct cluster_events {
    struct compensated evaporation, losing, refilling;
    double scale;
    struct compensated found; // when its flow was last found
    double clock, time;       // the reading of its clock at TIME since then
    struct indexed_heap queue[QUEUES];
    bool is_touched;
};

struct viscous_events {
    struct occupancy *occupancy;
    struct liquid_flow *flow;
    struct compensated now; // since all losses were last found
    double pace;            // as above
    double duration, span;  // since the vapour was last found: of the mean
    bool must_find;         // all losses are to be found
    bool found_vapour;      // in all of the gas, at the last event
    double *share;          // (2 n_throat) what a throat evaporates at each of its ends
    double *evaporation;    // (n_throat) at both
    double *rate;           // (n_throat) as above; 0: its meniscus stays
    double *since; // (n_throat) when its liquid was last brought up to date, and
    double *end;   // (n_throat) when it will have emptied: by its cluster's clock;
                   //     or have refilled: by time since its flow was found
    int *place;    // (n_throat) in a queue of its cluster
    int capacity;
    struct cluster_events *cluster; // (capacity) by identity
    double *next;                   // (capacity) time of its next event
    int *next_place;                // (capacity) in
    struct indexed_heap queue;      // of clusters
    int n_touched, *touched;        // (n_touched) clusters that must be settled
    struct loss *loss;              // (n_throat)
};

// What happens next: THROAT empties, or refills. -1: nothing.
struct viscous_event {
    int throat;
    bool refills;
    double span; // scaled time until then
};

// Keeps OCCUPANCY and FLOW, which must live as long. The caller frees it with
// viscous_events_free.
struct viscous_events *viscous_events_create(struct occupancy *occupancy,
                                             struct liquid_flow *flow);
void viscous_events_free(struct viscous_events *events);

// Brings the liquid of all throats up to now, and forgets all losses: they are to be
// found.
void viscous_events_forget(struct viscous_events *events);

// Finds all losses if viscous_events_forget has come before. STATUS_NOT_CONVERGED as
// liquid_flow_find.
enum status viscous_events_find(struct viscous_events *events, struct reason *reason);

struct viscous_event viscous_events_next(const struct viscous_events *events);

// What evaporates per span.
double viscous_events_rate(const struct viscous_events *events);

// Goes on by SPAN, at most that of the next event. Returns its duration.
double viscous_events_advance(struct viscous_events *events, double span);

// EVENT, which is due, happens: gas fills the throat, or it is full again; vapour and
// losses follow. STATUS_NOT_CONVERGED as liquid_flow_find.
enum status viscous_events_happen(struct viscous_events *events,
                                  struct viscous_event event, struct reason *reason);

// Saturation of THROAT now.
double viscous_events_saturation(const struct viscous_events *events, int throat);
