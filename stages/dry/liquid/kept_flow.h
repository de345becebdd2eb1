// SPDX-License-Identifier: GPL-3.0-or-later
// The losses of a cluster between two times at which its flow is found [K 3.10]. K
// finds the flow after each throat; here potentials and inflows stay for a while
// (flow->step), and the losses follow what has changed. For viscous.c only.
#pragma once

#include "flow_solver.h"

// The flow of the cluster has just been found. O(throats of the cluster).
void kept_flow_note(const struct liquid_flow *flow,
                    const struct cluster_problem *problem);

// Whether that flow may serve on. If so, flow->moving and the solver's inflow become
// such that the losses of its menisci, evaporation - inflow, add up to
// problem->evaporation. If not, moving has stayed a guess that find_menisci may start
// from. O(menisci of the cluster).
bool kept_flow_goes_on(struct liquid_flow *flow, const struct cluster_problem *problem);
