// SPDX-License-Identifier: GPL-3.0-or-later
// Capillary forces replayed on the bonded grains, step after step [K 5.2].
//
// In short: for each row of the load the engine brings the body to rest under it, and
// what has happened is noted in a response. main.c makes load and settings from
// artifacts and parameters; replay itself reads no file and prints nothing.
#pragma once

#include "basics/status.h"
#include "capillarity.h"
#include "checkpoint/keeper.h"
#include "dem/dem.h"
#include "geometry/net_load.h"
#include "shrinkage.h"

#include <math.h>
#include <stdbool.h>

// What holds the body while forces act on it.
enum support {
    SUPPORT_FREE,  // no support; net force and moment are removed from the load
    SUPPORT_FIXED, // some grains are fixed: they neither move nor rotate
    SUPPORT_WALL   // a rigid wall beneath, at the lower z wall
};

// How each state of rest is found; docs/equilibrium.md compares both.
enum engine {
    ENGINE_EXPLICIT,    // cycles of discrete elements [K 4]
    ENGINE_QUASI_STATIC // equilibrium itself
};

enum loose_loads {
    LOOSE_LOADED,  // loose grains keep their loads
    LOOSE_UNLOADED // their net loads are removed [loose.h]
};

enum unsettled {
    UNSETTLED_STOPS,  // a load that does not come to rest: STATUS_NOT_CONVERGED
    UNSETTLED_GOES_ON // it is counted
};

// Forces over time, as forces.h5 holds them: row k is step k of the replay. A row of
// values is asked for when the replay comes to it, so that not all need be in memory:
// rows come in their order from the first on, also where a replay goes on from its
// state, each of them again as often as needed. What is returned is valid until another
// row of the same is asked for. The caller of replay owns it.
struct load {
    int n_time;
    double *time, *saturation; // (n_time) s, rising; of the network, from 1 down
    void *source;              // of rows
    const struct vector *(*force)(void *source, int row); // (n_particle) N
    // (n_particle) of each grain, also of the row before the last one asked for; NULL:
    // not known, or .drained.
    const double *(*dryness)(void *source, int row);
    double *most_liquid; // (n_particle) kg, that each grain ever has, where .dryness
                         // goes by it; else NULL
    double *drained;     // (n_time * n_particle) dryness where it drains; else NULL
    bool shrinks;        // grains shrink under it: it acts also where it has no force
    bool drains; // gas enters pores, likewise; rows of .saturation and .drained are
                 // filled in as the replay comes to them
};

// How to replay. It owns nothing: arrays must outlive the replay.
struct replay_settings {
    struct dem_material material;
    struct dem_bond_material bond;
    double *relative_strength;      // (n_bond) of those of `bond`; NULL: 1
    uint8_t *held;                  // (n_particle) 1: neither moves nor turns
    struct dem_liquid liquid;       // of no volume: none
    bool tensile_damping;           // dashpots may pull grains that part
    bool unstressed;                // overlaps of the packing do not push
    struct shrinkage shrinkage;     // explicit; it owns nothing
    struct capillarity capillarity; // explicit; of no suction: none
    enum support support;
    enum engine engine;
    const char *engine_reason;    // why this one
    enum loose_loads loose;       // explicit
    enum unsettled unsettled;     // explicit
    double equilibrium_tolerance; // quasi-static: left on a grain, of the largest load
    int64_t most_iterations;      // quasi-static: steps in time to one equilibrium
    double rolling;               // quasi-static, contact bonds: of shear stiffness
    bool large_displacements;     // quasi-static: on the geometry as it is
    double increment;             // then: of turns, rad, and of strains
    bool density_scaling;    // explicit: every grain has the inertia of the mean one
    double time_step_safety; // explicit: of the critical step [K 4.47]; NAN: half the
                             // stability limit (dem/dem.h)
    bool force_time_step;    // explicit: a step above the limit is taken, not refused
    int64_t cycles;          // at every step of the load
    int64_t ramp;        // before them at the first, while the load grows from nothing
    double tolerance;    // on [K 4.20]: go on until below; NAN: the cycles are enough
    int64_t most_cycles; // beyond them at one step; then it is unsettled
    int n_snapshot;
    const double *snapshot; // saturations, the highest first; SATURATION <= this
    int threads;
    const struct array_list *begin; // .engine of an earlier replay of the same packing;
                                    // NULL: at rest, all whole
    bool keep_state;                // whether .engine is wanted
    const struct vector *weight;    // (n_particle) N, of which each row of the load has
                                 // its part: comes to rest before the first, and what
                                 // breaks under it is no crack of drying; NULL: none
};

// The state of the grains when a load has been carried. It owns its arrays.
struct snapshot {
    int step; // row of the load
    double time, saturation;
    struct vector *displacement; // (n_particle) m, from the places of the packing
    struct vector *force;        // (n_particle) N, external
    uint8_t *intact;             // (n_bond)
    struct dem_contact *contact; // (n_contact)
    int n_contact;
    double *dryness; // (n_particle) share of the pores around it that gas has entered;
                     // NULL: not known
    double *shrinkage; // (n_particle) linear strain; NULL: none shrinks
};

// What came out of a replay; it owns its arrays, freed with response_free. Rows
// (n_time) are those of the load. All is in SI; the moment of a reaction is about the
// lower corner of the box.
struct response {
    int n_crack; // of this replay; an earlier one's are not among them
    struct dem_crack *crack;
    int *crack_step;          // (n_crack) row of the load it broke under
    double *unbalanced_ratio; // (n_time) at the end of each step
    int64_t *cycles;          // (n_time) of time steps; quasi-static: of iterations
    int32_t *cracks;          // (n_time) so far
    uint8_t *settled; // (n_time) 1: all came to rest under it; without a load always
    uint8_t *loaded;  // (n_time) whether there is one (is_loaded)
    double *lateral_tension;   // (n_time) Pa, mean of x and y: of grains, and of liquid
                               // that drains, over the box; NULL: neither shrinks nor
                               // drains
    struct net_load *reaction; // (n_time) of supports on the grains, or in place of
                               // them: what was taken off, the other way
    double most_at_once; // by which a grain shrank between two time steps, a strain;
                         // since the checkpoint that the replay went on from
    int n_snapshot;
    struct snapshot *snapshot;
    double time_step, time_step_limit; // s; 0 when quasi-static
    // Grains that nothing held, so that they left an equilibrium or were unloaded: of
    // those that had a bond, how many, and the first; of the others.
    int n_detached, first_detached, n_unbonded;
    int n_unsettled; // steps that are not settled
    int n_unconverged,
        unconverged_grain; // loads under which something held did not come to rest,
                           // and the grain furthest from it under the last
    int n_instability, instability_grain; // ends of equilibrium gone through in time,
                                          // and the grain that moved most at the last
    struct drainage_history drainage;     // NULL without capillarity
    struct array_list engine; // at the end, if it was to be kept; quasi-static: all
                              // loads up to there
    int n_earlier_crack; // of the replays that this one goes on from, weight included
    struct dem_crack *earlier_crack;
    int n_weight_crack; // before drying, under the weight alone
    struct dem_crack *weight_crack;
    double weight_unbalanced_ratio; // when drying began; NAN: without weight
};

// Who follows the replay: FRACTION of the load that is done.
struct replay_progress {
    void (*report)(void *context, double fraction); // may be NULL
    void *context;
};

// Whether STEP has a force on any of N grains, or shrinks them. Without any, the ratio
// of [K 4.20] divides one decaying number by another.
bool is_loaded(const struct load *load, int n, int step);

// Replays LOAD on PACKING. STATUS_NOT_CONVERGED: the time step would be unstable, the
// run diverged, or a step did not settle within its cycles or iterations;
// STATUS_BAD_DATA: KEEPER, which may be NULL, begins with a state that is not one of
// such a replay, or SETTINGS do. The caller frees *RESPONSE with response_free. On
// failure *RESPONSE is empty, and the reason names the step if one had begun. The same
// inputs give the same bytes for any number of threads, and for a run in one piece or
// continued from its checkpoints.
enum status replay(const struct packing *packing, const struct load *load,
                   const struct replay_settings *settings,
                   const struct replay_progress *progress, const struct keeper *keeper,
                   struct response *response, struct reason *reason);
// Unbalanced ratio [K 4.20] below which a load counts as settled: the tolerance, or K's
// 1e-4 [K 5.2] where there is none.
static inline double ratio_at_rest(const struct replay_settings *settings)
{
    return isnan(settings->tolerance) ? 1e-4 : settings->tolerance;
}

// Frees what the response owns and empties it.
void response_free(struct response *response);
