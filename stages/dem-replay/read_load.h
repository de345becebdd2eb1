// SPDX-License-Identifier: GPL-3.0-or-later
// The load of a replay, from the forces in an artifact, row by row, or for a packing
// that shrinks or drains without any.
#pragma once

#include "artifacts/artifact.h"
#include "parameters.h"

bool is_packing(const struct artifact *input);

// The load of INPUT, which must stay open: forces or a packing. Ends the program with
// status 65 where a packing has nothing to do, or grains shrink by a liquid that is not
// there. The caller frees it with free_load. Rows are read from the file when a replay
// asks for them: one band of rows is in memory.
struct load read_load(const struct artifact *input,
                      const struct replay_parameters *parameters, int n_particle);
void free_load(struct load *load);

// Has every row of LOAD take up the WEIGHT of the grains (n_particle) N, downwards. The
// load takes it over.
void add_weight(struct load *load, double *weight);

// The largest force (N) on a grain, without weight, in all rows that a replay of LOAD
// has asked for so far.
double largest_force(const struct load *load);
