// SPDX-License-Identifier: GPL-3.0-or-later
// The quasi-static engine: equilibria of bonded grains, found as such, without the
// cycles of lib/dem; with bonds [K 4.31-4.44] and contacts that open, close and slip [K
// 4.11-4.26], for small displacements or on the geometry as it is.
//
// Newton's method with a factored stiffness; pairs that have changed since it was
// factored are a small dense system [contact_solver.h], until so many have that a new
// factor costs less. Bonds break one after another, the most overloaded first, each in
// the equilibrium that the last break has led to.
//
// With friction Newton's method may not find the contacts that slip, or there may be no
// equilibrium near the last one. Then a splitting of grains and contacts finds them,
// and dashpots slow the grains down until they rest [splitting/splitting.h]. A
// fragment (grains joined by intact bonds) that nothing holds leaves where it would
// move by more than a tenth of the mean radius or finds no rest: it has no load any
// more, and nothing touches it. Its flight, and what it would hit, is for lib/dem.
//
//     struct quasi_static *qs;
//     enum status status = quasi_static_create(&qs, &setup, &reason);
//     for (int row = 0; row < n_load && !status; row++) {
//         status = quasi_static_solve(qs, force[row], &reason);
//         quasi_static_displacements(qs, displacement);
//     }
//     quasi_static_free(qs);
// What SETUP points to is kept, not copied, and must live as long. The state depends on
// all loads before: history is that of friction and of bonds that broke. Rates do not
// come in; times of loads are the caller's. An engine is for one thread.
#pragma once

#include "checkpoint/keeper.h"
#include "dem/dem.h"
#include "geometry/net_load.h"

struct quasi_static_setup {
    const struct packing *packing; // with its bonds
    const uint8_t *fixed;          // (n_particle) 1: neither moves nor turns
    bool has_wall;                 // beneath, at the lower z wall
    bool unstressed;               // overlaps of the packing do not push
    bool shrinks;                  // quasi_static_shrink will be called
    struct dem_material material;  // density and damping do not matter
    struct dem_bond_material bond;
    const double *relative_strength; // (n_bond) of the bonds; NULL: 1
    bool is_free;     // nothing holds the grains: their net load is taken off
    double rolling;   // contact bonds: stiffness against rolling and torsion, of that
                      // against shear times both arms
    double tolerance; // on the residual of a grain, of the largest load
    int64_t most_iterations;  // steps in time to one equilibrium
    bool large_displacements; // found on the geometry as it is
    double increment; // then: turn of a grain or pair at a time, rad, or grains come
                      // closer, mean radii
    // Then: called with the share of a load that is balanced; may be NULL.
    void (*report)(void *context, double balanced);
    void *context;
};

struct quasi_static;

// The caller frees *RESULT with quasi_static_free. STATUS_BAD_DATA: nothing resists,
// a periodic box is too narrow for pairs to be near in one image only, grains coincide,
// or bonds are listed twice. *RESULT is NULL then.
enum status quasi_static_create(struct quasi_static **result,
                                const struct quasi_static_setup *setup,
                                struct reason *reason);
void quasi_static_free(struct quasi_static *qs);

// From the next equilibrium on each grain has become smaller by the linear STRAIN
// (n_particle) since the start, and its bonds and contacts with it, as by
// dem_set_shrinkage. Only if the setup `shrinks`. O(pairs).
void quasi_static_shrink(struct quasi_static *qs, const double *strain);
const double *quasi_static_shrinkage(const struct quasi_static *qs); // NULL: none

// The next equilibrium, under FORCE (n_particle) N, with the history of those before.
// STATUS_NOT_CONVERGED: displacements of what is held are not small; or if they may be
// large, equilibrium ends at a limit point and dynamics finds no rest. FORCE is read
// during the call only.
enum status quasi_static_solve(struct quasi_static *qs, const struct vector *force,
                               struct reason *reason);

// Drops what only speeds up the next equilibria. From there on all is as after
// quasi_static_restore from what quasi_static_save gave then: the same bytes. It costs
// a factor: the cache is old when there have been many since the last time.
bool quasi_static_cache_is_old(const struct quasi_static *qs);
void quasi_static_drop_cache(struct quasi_static *qs);
// A new list, to be freed with free_arrays. STATUS_BAD_DATA: it is not of such
// grains and bonds.
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
// Force, N, and moment about ABOUT, N m, of fixed grains and the wall on all others.
void quasi_static_reaction(const struct quasi_static *qs, struct vector about,
                           struct vector *force, struct vector *moment);
// The stress that grains and the wall put on each other, Pa, compression > 0, over the
// volume of the packing's box, as of dem_census.
void quasi_static_stress(const struct quasi_static *qs, double stress[3][3]);
// The forces from outside that count (n_particle) N; what was taken off is returned.
struct net_load quasi_static_load(const struct quasi_static *qs, struct vector *force);

// Mean |residual| of grains that move over mean |force| of pairs [K 4.20]; 0 where
// nothing is left, 1 where no pair carries anything.
double quasi_static_unbalanced_ratio(const struct quasi_static *qs);

int quasi_static_iterations(const struct quasi_static *qs); // so far
// (n_particle) of those that have left.
const bool *quasi_static_is_detached(const struct quasi_static *qs);
// Grains that have left, and the FIRST of them.
int quasi_static_detached(const struct quasi_static *qs, int *first);
// Loads under which something held did not come to rest, and the grain with the largest
// residual under the LAST of them.
int quasi_static_unconverged(const struct quasi_static *qs, int *last);
// How often the body snapped through or buckled, and the grain that moved most at the
// LAST time.
int quasi_static_instabilities(const struct quasi_static *qs, int *last);
