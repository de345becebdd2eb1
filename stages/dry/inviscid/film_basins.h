// SPDX-License-Identifier: GPL-3.0-or-later
// Who supplies films between two solutions of their flow. Each site has a source from
// which most of its liquid comes: those of one source are its basin. When the source
// loses a throat, its level changes, and while the flow is nearly the same, all levels
// of the basin change with it. So the cluster whose least is now highest above, or
// least below, the level that it had supplies the basin.
#pragma once

#include "film_flow.h"

#include "checkpoint/stream.h"

struct film_basins;

// For clusters numbered below N_CLUSTER among N_PLACE places. No place is in a basin
// yet. The caller frees it with film_basins_free; NULL is allowed.
struct film_basins *film_basins_create(int n_place, int n_cluster);
void film_basins_free(struct film_basins *basins);

// Of FLOW, solved to NOISE; SOURCE (N_SOURCE) are the sites that feed others, and TURN
// is as below, of each site that is a cluster.
void film_basins_find(struct film_basins *basins, const struct film_flow *flow,
                      double noise, const int *turn, int n_source, const int *source);

// The basin of PLACE; -1: none.
int film_basins_of(const struct film_basins *basins, int place);

// PLACE, a node, is in BASIN from now on (-1: in none).
void film_basins_add_node(struct film_basins *basins, int place, int basin);

// The level of the source of BASIN when found, and the most that films bring to sites
// of it now.
double film_basins_highest(const struct film_basins *basins, int basin);
double film_basins_capacity(const struct film_basins *basins, int basin);

// CLUSTER is in BASIN (-1: in none), its level GAP above its least. It does not supply.
// Of equal gaps the least TURN, from 0 to below N_CLUSTER, is first.
void film_basins_set(struct film_basins *basins, int cluster, int basin, double gap,
                     int turn);

// The cluster of BASIN of the least gap, which supplies from now on; -1: none is left.
int film_basins_supplier(struct film_basins *basins, int basin);

// How far the level of CLUSTER, which is in a basin, is above its least now.
double film_basins_height(const struct film_basins *basins, int cluster);

// How far levels at PLACE have fallen since the solution.
double film_basins_fall(const struct film_basins *basins, int place);

// What nodes evaporate that films have no longer reached at some moment since then.
double film_basins_failing(const struct film_basins *basins);

int film_basins_count(const struct film_basins *basins);

// Writes to STREAM, or restores from it, what there is between two solutions.
void film_basins_state(struct film_basins *basins, struct checkpoint_stream *stream);
