// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium of bonded grains itself, without cycles that lead there: for small
// displacements about where they began, or for large ones as an option [large.h], with
// bonds [K 4.31-4.44], contacts that open, close and slip [K 4.11-4.26].
//
// The stiffness is factored once; what breaks, opens, closes or slips later is a small
// dense correction to it (corrections.h), until there is so much of that that a new
// factor is made. Bonds break one after another: the most overloaded first, of equals
// the first listed, and the next is looked for when the load has found its way round.
//
// With friction there may be no equilibrium near the last one. Then dynamics decides:
// dashpots at all pairs slow the way to the next, and the way is walked in steps of
// time. What does not come to rest so and depends on no support leaves the aggregate,
// as does a fragment (grains joined by intact bonds) that would move by more than a
// tenth of the mean radius: its load counts no more, and nothing touches it. Where it
// flies and what it would hit is left to the other engine.
#ifndef CRAQUELURE_QUASI_STATIC_H
#define CRAQUELURE_QUASI_STATIC_H

#include "checkpoint/keeper.h"
#include "dem/dem.h"
#include "geometry/net_load.h"

struct quasi_static_setup {
    const struct packing *packing; // with its bonds
    const uint8_t *fixed;          // (n_particle)
    bool has_wall;                 // beneath, at the lower z wall
    bool unstressed;               // overlaps of the packing do not push
    struct dem_material material;  // density and damping have no part in it
    struct dem_bond_material bond;
    const double *relative_strength; // (n_bond) of that of the material; NULL: 1
    bool is_free;     // nothing holds the grains: their net load is taken off
    double rolling;   // contact bonds: stiffness against rolling and twist, of that
                      // against shear times both arms
    double tolerance; // largest force or moment left on a grain, of the largest load
    int64_t most_iterations;  // steps in time to one equilibrium
    bool large_displacements; // found on the geometry as it is
    double increment; // then: turn of a grain or pair at a time, rad, or grains come
                      // closer, mean radii
    // Then: told on the way which share of a load is balanced; may be NULL.
    void (*report)(void *context, double balanced);
    void *context;
};

struct quasi_static;

// The caller frees *RESULT with quasi_static_free. STATUS_BAD_DATA: nothing resists.
enum status quasi_static_create(struct quasi_static **result,
                                const struct quasi_static_setup *setup,
                                struct reason *reason);
void quasi_static_free(struct quasi_static *qs);

// The next one, under FORCE (n_particle) N, with the history of those before.
// STATUS_NOT_CONVERGED: what is left has moved so far that displacements are not small;
// or if they may be large, equilibrium ends on the way.
enum status quasi_static_solve(struct quasi_static *qs, const struct vector *force,
                               struct reason *reason);

// Forgets what only speeds up those that come. From there on all is as after
// quasi_static_restore from what quasi_static_save gave then: the same bytes. It costs
// a factor: whether there have been many since the last.
bool quasi_static_cache_is_old(const struct quasi_static *qs);
void quasi_static_drop_cache(struct quasi_static *qs);
// A new list, to be freed with dem_free_arrays. STATUS_BAD_DATA: it is not one of such
// an equilibrium.
struct array_list quasi_static_save(const struct quasi_static *qs);
enum status quasi_static_restore(struct quasi_static *qs, const struct array_list *list,
                                 struct reason *reason);

// As the same functions of the engine [dem.h] say. The cycle of a crack is the
// iteration.
const struct dem_crack *quasi_static_cracks(const struct quasi_static *qs, int *count);
void quasi_static_displacements(const struct quasi_static *qs,
                                struct vector *displacement);
void quasi_static_bonds_intact(const struct quasi_static *qs, uint8_t *intact);
struct dem_contact *quasi_static_contacts(const struct quasi_static *qs, int *count);
// What held grains and the wall carry: force, N, and moment about ABOUT, N m, that they
// put on the other grains.
void quasi_static_reaction(const struct quasi_static *qs, struct vector about,
                           struct vector *force, struct vector *moment);
// The forces from outside that count, (n_particle) N, and what was taken off them.
struct net_load quasi_static_load(const struct quasi_static *qs, struct vector *force);
double quasi_static_unbalanced_ratio(const struct quasi_static *qs);

int quasi_static_iterations(const struct quasi_static *qs); // so far
// (n_particle) of those that have left.
const bool *quasi_static_is_detached(const struct quasi_static *qs);
// Grains that have left, and the FIRST of them.
int quasi_static_detached(const struct quasi_static *qs, int *first);
// Loads under which something held did not come to rest, and the grain that had most
// left to balance under the LAST of them.
int quasi_static_unconverged(const struct quasi_static *qs, int *last);
// How often it snapped through or buckled, and the grain that gave way most at the
// LAST.
int quasi_static_instabilities(const struct quasi_static *qs, int *last);

#endif
