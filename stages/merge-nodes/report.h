// SPDX-License-Identifier: GPL-3.0-or-later
// How merging changed the distributions of coordination, length and radius, as JSON [K
// Figs. 3.24, 3.25].
#pragma once

#include "merge.h"

#include <jansson.h>

// Copies of what is counted, of a network as it is.
struct census {
    int n_node, n_throat, max_throats; // at one node
    int *coordination;                 // (n_node)
    double *length, *radius;           // (n_throat) m
    double volume;                     // of all throats, m3
};

// O(n_node + n_throat). The caller frees it with census_free; NETWORK may have changed
// by then.
struct census take_census(const struct network *network);
void census_free(struct census *census);

// {"merged", "fused", "kept": numbers of throats as in merge.h, "lost_volume": m3,
// "before": {…}, "after": {…}}, with in each of the two
//     nodes, throats, volume (m3),
//     coordination {mean, nodes: [of 0, 1, 2, … throats]},
//     length and radius {mean, standard_deviation, middle: [m], throats: [numbers]}.
// The classes of length and of radius are the same before and after. The caller owns
// it.
json_t *merging_json(const struct merge_report *report, const struct census *before,
                     const struct census *after);
