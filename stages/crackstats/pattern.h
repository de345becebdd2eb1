// SPDX-License-Identifier: GPL-3.0-or-later
// The crack pattern of a layer seen from above, of one run: its map, for pictures, and
// its statistics (docs/craquelure.md).
#pragma once

#include "polygons.h"

// Over the drying: cracks down to a saturation.
struct pattern_stage {
    double saturation;
    int count; // polygons; 0: no pattern
    double crack_area, largest;
};

// It owns its arrays; freed with pattern_free.
struct pattern {
    struct columns columns;
    struct polygons polygons; // at the end
    double *damage;           // (columns.n) at the end
    double *opened; // (columns.n) saturation at which the damage passed the threshold
                    // of the end, to an interval; NAN: never
    int n_stage;
    struct pattern_stage *stage; // (n_stage) as saturation falls
};

// The pattern of RUN, followed through N_STAGE equal intervals of the saturation, and
// its statistics, written to VALUE[POLYGONS_FOUND] and what follows; NAN what needs a
// pattern, where there is none.
struct pattern find_pattern(const struct run *run, int n_stage, double *value);
void pattern_free(struct pattern *pattern);
