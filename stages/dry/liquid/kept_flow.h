// SPDX-License-Identifier: GPL-3.0-or-later
// The flow of a cluster between two times at which it is found [K 3.10]. K finds the
// flow after each throat; here potentials stay for a while (flow->step), and the losses
// follow what has changed. For viscous.c, and for viscous_events.c, which goes from
// event to event.
#pragma once

#include "flow_solver.h"

// The flow of the cluster has just been found. O(throats of the cluster).
void kept_flow_note(const struct liquid_flow *flow,
                    const struct cluster_problem *problem);

// Whether CLUSTER has a flow that is kept.
bool kept_flow_is_known(const struct liquid_flow *flow, int cluster);

// Whether it may serve on while the cluster evaporates EVAPORATION and its losses are
// SCALE times what they were as it was found.
bool kept_flow_may_serve(const struct liquid_flow *flow, int cluster,
                         double evaporation, double scale);

// What flows to the meniscus of THROAT if that moves.
double kept_flow_inflow(const struct liquid_flow *flow, int cluster, int throat);

// THROAT is full again: its meniscus stops.
void kept_flow_stop(struct liquid_flow *flow, int cluster, int throat);
