// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of an engine to the replay; the two engines are replay_by_*.c.
#ifndef CRAQUELURE_REPLAY_ENGINE_H
#define CRAQUELURE_REPLAY_ENGINE_H

#include "replay.h"
#include "replay_checkpoint.h"

struct run {
    const struct packing *packing;
    const struct load *load;
    const struct replay_settings *settings;
    const struct replay_progress *progress; // may be NULL
    const struct keeper *keeper;
    struct response *response;
    const struct replay_engine *engine;
    void *state;               // of the engine
    bool is_whole;             // its bonds cannot break yet
    struct vector *force;      // (n_particle) N, of this step
    struct net_load taken_off; // of it, where nothing holds the grains
    int n_before;              // bonds that an earlier replay, or weight, has broken
    struct replay_place place;
};

// Steps before the load, of a body with weight.
enum {
    STEP_WHOLE = -2, // under its weight with unbreakable bonds: overshoots on the way
                     // to rest break none. Only for engines with inertia
    STEP_WEIGHT = -1 // the same, with bonds as strong as they are
};

struct replay_engine {
    bool needs_support; // it cannot solve a body without support
    int first_step;     // of those with weight
    // Whether it does what SETTINGS ask for; NULL: it does.
    enum status (*check)(const struct replay_settings *settings, struct reason *reason);
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
    struct net_load (*reaction)(const struct run *);
    const struct dem_crack *(*cracks)(const struct run *, int *count);
    void (*observe)(const struct run *, struct snapshot *);
    struct array_list (*save)(const struct run *); // for a later replay
    void (*end)(struct run *); // what is to be said goes into the response; all freed
};
extern const struct replay_engine replay_by_cycles, replay_by_equilibria;

const struct replay_engine *replay_engine(const struct replay_settings *settings);

// The forces of the step, as they are in the load, or the weight.
void take_forces(struct run *run);

#endif
