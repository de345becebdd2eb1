// SPDX-License-Identifier: GPL-3.0-or-later
// What films bring to nodes between two solutions of their flow.
//
// The solution says how much the sites of a basin get, and how far their levels are
// below that of the source. What they evaporate grows as the nodes before them dry, and
// the source's level falls as it comes to narrower throats. Films then bring no more
// than
//     capacity = (source's level now) * sum of inflow / (source's level - level).
// Clusters get what they need first, then nodes, those of high levels before others.
#pragma once

#include "emptying_times.h"
#include "film_flow.h"

struct film_inflow;

// For N_NODE nodes. The caller frees it with film_inflow_free; NULL is allowed.
struct film_inflow *film_inflow_create(int n_node);
void film_inflow_free(struct film_inflow *inflow);

// Takes over the inflows of FLOW, just solved, whose basins TIMES->films has.
void film_inflow_find(const struct emptying_times *times, const struct film_flow *flow);

// Sets TIMES->films->own of the nodes in basins, from what they evaporate now,
// TIMES->rate. Returns what nodes lack to which films have just come: the capacity was
// found without them. O(reservoirs that evaporate + basins).
double film_inflow_limit(const struct emptying_times *times);

// Writes to STREAM, or restores from it, what there is between two solutions.
void film_inflow_state(struct film_inflow *inflow, struct checkpoint_stream *stream);
