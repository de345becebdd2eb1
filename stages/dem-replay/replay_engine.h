// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of an engine to the replay; the two engines are replay_by_*.c. The
// replay knows steps, records and snapshots; an engine knows how a body comes to rest
// under the forces of one step. So both have the same results in the same places.
#pragma once

#include "replay.h"
#include "replay_checkpoint.h"

// A replay on the way. It owns .force; the engine owns .state. All else belongs to the
// caller of replay.
struct run {
    const struct packing *packing;
    const struct load *load;
    const struct replay_settings *settings;
    const struct replay_progress *progress; // may be NULL
    const struct keeper *keeper;
    struct response *response;
    const struct replay_engine *engine;
    void *state;               // of the engine
    bool is_whole;             // its bonds cannot break yet (STEP_WHOLE)
    struct vector *force;      // (n_particle) N, of this step
    struct net_load taken_off; // of it, where nothing holds the grains
    int n_before;              // bonds that an earlier replay, or weight, has broken
    struct replay_place place; // the step, and the cycle it began at
};

// Steps before the load, of a body with weight. The place of a run counts through them
// to the first row of the load, 0.
enum {
    STEP_WHOLE = -2, // under its weight with unbreakable bonds: overshoots on the way
                     // to rest break none. Only for engines with inertia
    STEP_WEIGHT = -1 // the same, with bonds as strong as they are
};

// What an engine does; choose_engine (parameters.h) calls check before the replay,
// which then calls begin, restore (from a checkpoint only), then for every step advance
// and the observations, at last save and end. Functions that fail leave the reason; end
// is called in any case and must cope with a begin that failed.
struct replay_engine {
    bool needs_support; // it cannot solve a body of which no grain is fixed
    int first_step;     // STEP_WHOLE or STEP_WEIGHT: where a body with weight begins
    // Whether it does what SETTINGS ask for; NULL: it does.
    enum status (*check)(const struct replay_settings *settings, struct reason *reason);
    // Writes a line for the model of the response to TEXT.
    void (*describe)(const struct replay_settings *settings, char *text, size_t size);
    // At rest, or where the earlier replay that SETTINGS name ended.
    enum status (*begin)(struct run *, struct reason *);
    // As it was when KEPT was kept on the way.
    enum status (*restore)(struct run *, const struct kept_state *kept,
                           struct reason *);
    enum status (*advance)(struct run *, struct reason *); // by the step and its force
    int64_t (*cycles)(const struct run *);                 // so far
    double (*unbalanced_ratio)(const struct run *);
    bool (*is_settled)(const struct run *); // all is at rest under the step's load
    double (*lateral_tension)(const struct run *); // response.lateral_tension
    // Of supports on the grains (support_reaction.h).
    struct net_load (*reaction)(const struct run *);
    // All since the bonds were whole, in their order; the engine owns them.
    const struct dem_crack *(*cracks)(const struct run *, int *count);
    // Fills in displacements, intact bonds and contacts, which become the snapshot's.
    void (*observe)(const struct run *, struct snapshot *);
    struct array_list (*save)(const struct run *); // for a later replay
    void (*end)(struct run *); // what is to be said goes into the response; all freed
};
// By time steps of discrete elements [K 4]; by each state of equilibrium directly.
extern const struct replay_engine replay_by_cycles, replay_by_equilibria;

// The engine that SETTINGS name.
const struct replay_engine *replay_engine(const struct replay_settings *settings);

// Sets run->force to the row of the load at the present step, or to the weight before
// it. A copy: what is taken off does not change the load. O(n_particle).
void take_forces(struct run *run);

// The STRAIN of each grain (n_particle) by the law of shrinkage, at ROW of the load or,
// -1, before it.
void shrinkage_by_law(const struct run *run, int row, double *strain);
