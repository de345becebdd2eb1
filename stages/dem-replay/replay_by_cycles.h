// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of the replay as cycles share: the discrete elements and what is known
// of the body beside them.
#pragma once

#include "dem/dem.h"
#include "loose.h"
#include "replay_engine.h"

struct by_cycles {
    struct dem *dem;
    struct loose_grains loose; // none if they keep their loads
    bool has_looked;           // whether they have been found
    int n_crack;               // cracks at that time
    struct drainage drainage;  // where load->drains
    const double *due; // (n) shrinkage by the last row of the load of an earlier
                       // replay; NULL: there was none
};

static inline struct by_cycles *state_of(const struct run *run)
{
    return run->state;
}

static inline struct dem *dem_of(const struct run *run)
{
    return state_of(run)->dem;
}

// ---- replay_by_cycles_state.c -------------------------------------------------------

// Creates the discrete elements of the run, with unbreakable bonds where RUN->is_whole.
enum status create_dem(const struct run *run, struct dem **dem, struct reason *reason);

// As of struct replay_engine (replay_engine.h).
enum status begin_by_cycles(struct run *run, struct reason *reason);
enum status restore_by_cycles(struct run *run, const struct kept_state *kept,
                              struct reason *reason);
struct array_list save_by_cycles(const struct run *run);

// ---- replay_by_cycles_load.c --------------------------------------------------------

// Whether loose grains are unloaded. Without bonds nothing can come loose, and liquid
// bridges hold loose grains.
bool unloads(const struct run *run);

// Cycles after which the load is adapted to the grains again.
int64_t load_holds(const struct run *run);

// Additional cycles of the first step, in which the load grows. After an earlier replay
// its last load is applied already.
int64_t ramp(const struct run *run);

// The strain STRAIN (n) of each grain by the law, at ROW of the load or, -1, before it.
void find_due(const struct run *run, int row, double *strain);

// Shrinks grains evenly over the cycles of the step, after the ramp: by now to what is
// due when the load is adapted next, so that the grains have felt all of it in the
// cycles of the step.
void shrink(struct run *run);

// Applies the forces of the step to the grains where they are now.
void apply_forces(struct run *run);
