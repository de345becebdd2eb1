// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a replay besides the engine's, as named arrays. The names, lengths and
// units of all arrays stand at the top of replay_checkpoint.c.
//
// There are two uses. A checkpoint is of a replay on the way: its response so far, and
// by cycles the forces of the step. With keep_state the end of a replay by equilibria
// goes into the response, as all loads up to there. Lists that are made own copies;
// whoever gets one frees it with free_arrays. Lists that are read keep what they have:
// pointers into them live as long as they do.
#pragma once

#include "checkpoint/keeper.h"
#include "dem/dem.h"
#include "replay.h"

// Where in the load a replay is.
struct replay_place {
    int step;      // below 0: comes to rest under its weight (replay_engine.h)
    int64_t began; // cycle of the engine when the step began
};

// A number of each grain that a snapshot has, (n_particle); NULL: it has none.
typedef double **snapshot_numbers(struct snapshot *);
double **snapshot_dryness(struct snapshot *snapshot);
double **snapshot_shrinkage(struct snapshot *snapshot);

// These of all snapshots of RESPONSE, (n_snapshot, N), N the number of grains; each
// must have them. The caller frees it.
double *join_numbers(const struct response *response, snapshot_numbers *of, int n);

// RESPONSE and PLACE as a new list, which keep_state frees. N_TIME: rows of the load.
// Its size grows with snapshots and their contacts, not with the cycles done.
struct array_list save_response(const struct response *response,
                                const struct packing *packing, int n_time,
                                struct replay_place place);

// Adds the FORCE (n_particle, N) on the grains to LIST, and the net load TAKEN_OFF it.
// Only replays by cycles need them.
void save_load(struct array_list *list, const struct vector *force, int n_particle,
               struct net_load taken_off);

// Reads FORCE and *TAKEN_OFF from such a LIST; STATUS_BAD_DATA: they are not in it.
enum status restore_load(const struct array_list *list, int n_particle,
                         struct vector *force, struct net_load *taken_off,
                         struct reason *reason);

// An equilibrium is determined by all loads that led to it, so these are its state:
// those of EARLIER (NULL: none) or WEIGHT (n_particle; NULL: none), and then LOAD. A
// new list.
struct array_list save_loads(const struct array_list *earlier,
                             const struct vector *weight, const struct load *load,
                             const struct packing *packing);

// Whether LIST was kept by equilibria (save_loads), not by cycles. Neither can go on
// from a state of the other.
bool saved_by_equilibria(const struct array_list *list);

// STATUS_BAD_DATA, with the NAME of the engine that kept the list in the reason.
enum status refuse_other_engine(struct reason *reason, const char *name);

// The loads in such a LIST, which owns them, as (*n_load, n_particle) N: what has to be
// repeated to get the state back. NULL, with the reason, if they are not in it or are
// not whole rows of this packing.
const struct vector *saved_loads(const struct array_list *list,
                                 const struct packing *packing, int *n_load,
                                 struct reason *reason);

// Restores from such a LIST how many bonds broke under the weight, and the unbalanced
// ratio when drying began, to RESPONSE. The engine has N_CRACK cracks, which there
// cannot be more of. STATUS_BAD_DATA: they are not in it, or out of range.
enum status restore_weight(struct response *response, int n_crack,
                           const struct array_list *list, struct reason *reason);

// The engine when its state was kept: its cycle, and its cracks without those of an
// earlier replay and of the weight.
struct engine_past {
    const struct dem_crack *crack;
    int n_crack;
    int64_t cycle;
    int first_step; // no step is before it
};

// Fills RESPONSE, as empty as replay begins with, from LIST and the PAST, and *PLACE
// with the step that was on the way. There are at most MOST_SNAPSHOTS. STATUS_BAD_DATA,
// with the array and the rule in the reason: not the list of such a replay. What
// RESPONSE has by then is freed with response_free.
enum status restore_response(struct response *response, const struct packing *packing,
                             const struct load *load, int most_snapshots,
                             const struct engine_past *past,
                             const struct array_list *list, struct replay_place *place,
                             struct reason *reason);
