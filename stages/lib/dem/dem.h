// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete elements [K 4]: spherical grains with linear contacts [K 4.11-4.22], Coulomb
// slip [K 4.25-4.26], contact dashpots [K 4.27-4.30] and breakable parallel bonds
// [K 4.31-4.44], moved by leapfrog [K 4.1-4.6].
//
// SI outside. Inside, lengths are counted in mean radii, masses in mean grain masses
// and stiffnesses in the largest pair stiffness, and every grain is followed by its
// displacement from where it began, so scenes of equal dimensionless numbers give equal
// digits and an overlap of 1e-9 radii keeps all of its own. The results are the same
// bytes for any number of threads, with AVX2 and with AVX-512.
#ifndef CRAQUELURE_DEM_H
#define CRAQUELURE_DEM_H

#include "basics/status.h"
#include "geometry/packing.h"

#include <stdbool.h>
#include <stdint.h>

// The grains, all of one material.
struct dem_material {
    double density; // kg/m3, > 0
    double
        normal_stiffness; // N/m of a grain, >= 0; two in series make a contact [K 4.22]
    double shear_stiffness; // N/m of a grain, >= 0
    double friction;        // >= 0
    double damping_ratio;   // zeta of [K 4.28], >= 0
    // Local damping: each component of the net force and moment on a grain is made
    // smaller by this share of itself while the grain moves its way, and larger while
    // it moves against it, so that whatever oscillates comes to rest (dashpots do not
    // see grains that roll on each other). Not physical: for statics. In [0,1).
    double local_damping;
};

// The cylinder of glue between two bonded grains [K 4.2, parallel bond].
struct dem_bond_material {
    double normal_stiffness; // N/m3, >= 0
    double shear_stiffness;  // N/m3, >= 0
    double normal_strength;  // Pa, >= 0; INFINITY never breaks
    double shear_strength;   // Pa, >= 0
    double radius_fraction;  // bond radius over the smaller grain's, in (0,1]
};

// A rigid half space: grains stay on the side NORMAL points to. A grain touches it with
// its own stiffness (in series with an infinite one) and the friction of the grains.
struct dem_wall {
    struct vector point;  // m
    struct vector normal; // any length but zero
};

// What dem_create builds from. Nothing of it is kept: the caller may free it
// afterwards.
struct dem_setup {
    const struct packing *packing; // with the bonds listed in it
    struct dem_material material;
    struct dem_bond_material bond;
    const uint8_t *fixed; // (n_particle) 1: neither moves nor turns; NULL: none
    int n_wall;
    const struct dem_wall *wall; // (n_wall)
    double time_step_safety;     // time step over the critical one of [K 4.47], > 0
    bool force_time_step;        // run even past the stability limit
    int threads;                 // >= 1; used where there is enough to share
};

enum dem_crack_mode { DEM_CRACK_NORMAL = 0, DEM_CRACK_SHEAR = 1 };

struct dem_crack {
    int32_t bond;           // as numbered in the packing
    uint8_t mode;           // enum dem_crack_mode
    int64_t cycle;          // cycles completed when it broke
    struct vector position; // m, the contact point
};

// A pair that touches or is bonded, as it was in the last cycle.
struct dem_contact {
    int32_t particle[2]; // lower first; the second is -1-w for wall w
    int32_t bond;        // the intact bond between them, or -1
    double overlap;      // m, < 0 apart
    struct vector force; // N, F_ij of [K 4.10] with bond and dashpots: the second grain
                         // feels it, the first its opposite; along n_ij in compression
    struct vector position; // m, the contact point [K 4.9]
};

struct dem_energy {
    double kinetic; // J, translation and rotation
    double elastic; // J, contacts and bonds
};

struct dem_momentum {
    struct vector linear;  // kg m/s
    struct vector angular; // kg m2/s about the origin of the first positions;
                           // meaningless when the box repeats
};

struct dem;

// Starts at rest, without external force. Overlaps in the packing push from the start,
// but those of the rounding of coordinates count as touching; bonds are stress free as
// they lie. On success *RESULT is the caller's to free
// with dem_free; otherwise it is NULL.
// STATUS_BAD_DATA: a physically impossible number, coincident grains, a bond between
// grains that do not exist or listed twice, or a periodic box too narrow for one image
// of each pair. STATUS_NOT_CONVERGED: the time step is past the stability limit.
enum status dem_create(struct dem **result, const struct dem_setup *setup,
                       struct reason *reason);
void dem_free(struct dem *dem);

// External force on every grain from the next cycle on, (n_particle) N.
void dem_set_force(struct dem *dem, const struct vector *force);

// Velocities (n_particle) m/s and angular velocities (n_particle) rad/s; NULL leaves
// them.
void dem_set_velocity(struct dem *dem, const struct vector *velocity,
                      const struct vector *spin);

// CYCLES time steps. STATUS_NOT_CONVERGED: it diverged and stopped (a grain would move
// a tenth of the mean radius in one step, or a number is not finite); what is asked for
// later is finite but means nothing.
enum status dem_run(struct dem *dem, int64_t cycles, struct reason *reason);

// Runs until dem_unbalanced_ratio is below TOLERANCE, which is looked at every 16
// cycles. STATUS_NOT_CONVERGED: diverged, or MAX_CYCLES were not enough.
enum status dem_run_until(struct dem *dem, double tolerance, int64_t max_cycles,
                          struct reason *reason);

int64_t dem_cycle(const struct dem *dem);    // cycles completed
double dem_time_step(const struct dem *dem); // s
// s, stable below, for the pairs near each other at the start (stability.c). Grains
// that gather more neighbours later may need less: then only divergence is noticed.
double dem_time_step_limit(const struct dem *dem);

// Mean |F_i| over the grains that are not fixed, over mean |F_ij| over the contacts
// [K 4.20]; 0 when nothing pulls, infinite when nothing resists. O(pairs).
double dem_unbalanced_ratio(const struct dem *dem);
struct dem_energy dem_energy(const struct dem *dem);
struct dem_momentum dem_momentum(const struct dem *dem);

// The state, written into arrays of n_particle vectors: m, m, m/s, rad/s. Positions are
// not brought back into a box that repeats.
void dem_positions(const struct dem *dem, struct vector *position);
void dem_displacements(const struct dem *dem, struct vector *displacement);
void dem_velocities(const struct dem *dem, struct vector *velocity);
void dem_spins(const struct dem *dem, struct vector *spin);

// The contacts by first, then second grain, then those with walls; a new array of
// *COUNT that the caller frees.
struct dem_contact *dem_contacts(const struct dem *dem, int *count);

// Into an array of n_bond: 1 intact, 0 broken.
void dem_bonds_intact(const struct dem *dem, uint8_t *intact);

// Every crack so far, by cycle, then by pair. The engine's, until the next dem_run.
const struct dem_crack *dem_cracks(const struct dem *dem, int *count);

#endif
