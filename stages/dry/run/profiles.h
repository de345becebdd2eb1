// SPDX-License-Identifier: GPL-3.0-or-later
// The distribution of liquid at chosen saturations of the network, from the history of
// a run: profiles over the depth [K Figs. 3.31b, 3.48b], saturation of the surface,
// sizes of clusters, and snapshots of all throats.
#pragma once

#include "drying.h"

// Whether SATURATION is at LEVEL or below. It is a sum of many differences: a run that
// begins at a level may do so above it by rounding.
static inline bool is_down_to(double saturation, double level)
{
    return saturation <= level * (1 + 1e-12);
}

// Slices over the depth, and classes of cluster sizes: 1, 2-3, 4-7, ... throats.
enum { PROFILE_SLICES = 20, PROFILE_CLASSES = 31 };

struct profiles {
    int n_level;
    int *step;         // (n_level) first with at most the level's saturation
    double *depth;     // (PROFILE_SLICES) of their middles, 0 at the open wall
    double *slice;     // (n_level, PROFILE_SLICES) saturation
    double *surface;   // (n_level) saturation of throats with a node on that wall
    int32_t *clusters; // (n_level, PROFILE_CLASSES)
    double *throat_saturation; // (n_level, n_throat); NULL unless asked for
};

// What makes one cluster of liquid, as in the history of the run.
enum liquid_paths {
    PATHS_PARTED_BY_GAS, // throats that share a node to which no gas has come
    PATHS_THROATS,       // throats that share a node
    PATHS_FILMS          // all that were one cluster in the full network
};

// Saturations of slices and of the surface count what is in rings too; those of throats
// do not. LEVEL (N_LEVEL) falls from one to the next. A slice without throats has
// saturation 0. Each throat counts where its middle is. The caller frees the result
// with profiles_free. O(n_change + n_level * n_throat).
struct profiles profiles_init(const struct network *network,
                              const struct drying_history *history, unsigned open_walls,
                              enum liquid_paths paths, int n_level, const double *level,
                              bool keep_throats);

void profiles_free(struct profiles *profiles);
