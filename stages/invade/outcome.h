// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an invasion: throats, nodes, and the liquid that stays. The invasion
// (network/invasion.h) only says what gas enters in which order; volumes and pressures
// come in here.
#pragma once

#include "network/invasion.h"

// What holds the liquid, and when gas takes its place.
enum held_by {
    HELD_BY_THROATS, // a throat, when gas enters it
    HELD_BY_PORES    // half of each throat at a node, when gas comes to the node
};

// Events count from 1; 0: gas from the start; -1: liquid in the end. Where gas enters
// nodes, a throat empties with the first of its two. It owns its arrays.
struct outcome {
    enum held_by held_by;
    int32_t *throat_event; // (n_throat)
    int32_t *node_event;   // (n_node)

    int n;
    double volume;           // m3 of a full network
    double *pressure;        // (n) Pa, at which gas enters
    double at_first;         // saturation before the events: less than 1 where pores at
                             // the inlet hold gas from the start
    double *saturation;      // (n) after the event, of that volume
    double *ring_saturation; // (n) the part of it in rings; NULL: not looked at

    // Pressures higher than all before, and the saturation just before the next of
    // them.
    int n_curve;
    double *curve_pressure, *curve_saturation; // (n_curve)
    double *curve_rings; // (n_curve) the part of the saturation in rings, or NULL

    int32_t *throat_cluster; // (n_throat) -1: gas; clusters by their lowest throat
    int n_cluster;
    int32_t *cluster_throats; // (n_cluster) how many
    double *cluster_volume;   // (n_cluster) m3
    uint8_t *cluster_trapped; // (n_cluster) 1: no liquid leads to the outlet
};

// PRESSURE (n_throat or n_node): entry pressures, Pa (entry.h). The caller frees the
// outcome with outcome_free.
struct outcome outcome_init(const struct network *network,
                            const struct invasion_conditions *conditions,
                            const struct invasion *invasion, const double *pressure,
                            enum held_by held_by);

// When the pieces of THROAT lose their liquid: all of it, or its halves at both nodes.
// Returns how many pieces there are.
int events_of_pieces(const struct network *network, const struct outcome *outcome,
                     int throat, int32_t event[2]);

// After EVENT events, 0 to n.
double saturation_after(const struct outcome *outcome, int event);

// Counts the VOLUME (n), m3, that stays in rings after each event.
void outcome_add_rings(struct outcome *outcome, const double *volume);

void outcome_free(struct outcome *outcome);
