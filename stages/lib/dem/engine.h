// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct dem; for the files of this folder only. All in scaled units.
//
// A cycle sweeps pairs and grains together. The pair sweep (pair_kernel.h) reads the
// records of both grains, advances the history of the pair and writes what each of the
// two feels into that grain's own slot. As pairs are sorted by their first grain, no
// pair after those of grain g has to do with g any more: the grain sweep (grains.c)
// follows close behind, adds up the slots of each grain, which lie side by side in the
// order of its pairs, and moves it while everything is still in the cache. Each thread
// does so with its share of the groups; grains that another thread's pairs have to do
// with too wait until all are done. Nothing is summed across threads, so the order of
// every sum is fixed.
#ifndef CRAQUELURE_DEM_ENGINE_H
#define CRAQUELURE_DEM_ENGINE_H

#include "dem/dem.h"

#include <stddef.h>

enum { PAIRS_IN_GROUP = 8, CACHE_LINE = 64 };

// A grain may move half of this (in mean radii) before the pairs are sought again.
#define SEARCH_SKIN 0.2

// Where a grain is: its displacement from where it began, and its radius as the fourth.
struct place {
    _Alignas(32) double displacement[3];
    double radius;
};

// Velocity and angular velocity, or force and moment; the fourth of each is 0.
struct motion {
    _Alignas(CACHE_LINE) double linear[4];
    double angular[4];
};

// Eight pairs as the kernel takes them. Unused ones at the end pair the grain that is
// not there (index n_particle) with itself, far apart.
struct pair_group {
    _Alignas(CACHE_LINE) int32_t first[PAIRS_IN_GROUP];
    int32_t second[PAIRS_IN_GROUP];
    int32_t first_slot[PAIRS_IN_GROUP];
    int32_t second_slot[PAIRS_IN_GROUP];

    double separation[3][PAIRS_IN_GROUP]; // x_j - x_i where both began
    double distance[PAIRS_IN_GROUP];      // |separation|
    double overlap[PAIRS_IN_GROUP];       // R_i + R_j - distance
    double root_mass[PAIRS_IN_GROUP];     // sqrt(m_ij) [K 4.30]
    double shear_force[3][PAIRS_IN_GROUP];

    double bond_radius[PAIRS_IN_GROUP];     // 0 without a bond
    double normal_strength[PAIRS_IN_GROUP]; // -1 without an intact bond
    double shear_strength[PAIRS_IN_GROUP];
    double bond_shear_force[3][PAIRS_IN_GROUP];
    double bond_bending[3][PAIRS_IN_GROUP]; // M^s
    double bond_twist[PAIRS_IN_GROUP];      // M^n along n

    int8_t crack[PAIRS_IN_GROUP]; // mode of a bond broken in this cycle, -1 otherwise
    int32_t idle;                 // no pair touches or is bonded, and all slots hold 0
};

// What all pairs share.
struct contact_law {
    double normal_stiffness; // of a contact, K^n_ij
    double shear_stiffness;
    double friction;
    double normal_damping; // c_n over sqrt(m_ij) [K 4.28-4.29]
    double shear_damping;
    double bond_normal_stiffness; // per area
    double bond_shear_stiffness;
};

struct pair_list {
    int n_pair;
    int32_t (*particle)[2]; // (n_pair) sorted by first, then second
    int32_t *bond;          // (n_pair) the bond of the packing, broken or not; or -1
    int n_group;
    struct pair_group *group; // (n_group)
};

// A grain that is near a wall.
struct wall_pair {
    int32_t particle, wall;
    int32_t slot;
    double overlap; // where the grain began
    double root_mass;
    struct vector shear_force;
};

struct units {
    double length, mass, stiffness, time;
};

// The sweep over groups BEGIN..END-1; how many bonds broke.
typedef int pair_sweep(struct pair_group *group, int begin, int end,
                       const struct place *place, const struct motion *motion,
                       struct motion *slot, const struct contact_law *law,
                       double time_step);
pair_sweep pair_sweep_narrow, pair_sweep_wide;

struct dem {
    struct units unit;
    struct contact_law law;
    struct contact_law wall_law; // against a rigid flat
    double local_damping;
    double time_step;
    double time_step_limit;
    int64_t cycle;
    int threads;
    pair_sweep *sweep;

    int n_particle;
    struct vector *start;  // (n_particle) where each began
    struct place *place;   // (n_particle+1), the last is the grain that is not there
    struct motion *motion; // (n_particle+1) half a step behind the places
    double (*external)[4]; // (n_particle) force
    double (*mobility)[2]; // (n_particle) 1/m, 1/I; 0 when fixed
    double *mass;          // (n_particle)
    double largest_radius;
    double coordinate_error; // rounding of the positions as given
    double period[3];        // 0 where the box does not repeat
    double box_lower[3];

    int n_bond;
    int32_t (*bond_particle)[2]; // (n_bond)
    double *bond_radius;         // (n_bond)
    double *bond_strength[2];    // (n_bond) by enum dem_crack_mode; -1 once broken

    struct pair_list pairs;
    int n_wall;
    struct dem_wall *wall; // unit normals, scaled
    int n_wall_pair;
    struct wall_pair *wall_pair; // by grain, then wall
    int *slot_offset;            // (n_particle+1)
    int *first_group;            // (n_particle) with a pair of the grain
    int *last_group;             // (n_particle) with a pair whose first is <= the grain
    struct motion *slot;         // (slot_offset[n_particle] + 2)

    struct vector *place_at_search; // (n_particle) displacement when pairs were sought
    double travelled;               // no grain has moved further since

    int n_crack, crack_capacity;
    struct dem_crack *crack;
};

// COUNT zeroed elements of SIZE bytes on a cache line, to be freed with free().
void *allocate_aligned(size_t count, size_t size);

// Seeks the pairs anew, with the history of those that stay [neighbours.c].
void find_pairs(struct dem *dem);
// Seeks them if a grain may have moved further than half the skin.
void keep_pairs(struct dem *dem);

void sweep_walls(struct dem *dem);

// The largest square of a speed, the surface's from turning included; SOUND is false
// when a grain would have moved too far to be true, which then stays where it was.
struct pace {
    double largest;
    bool sound;
};

// Moves, of the grains BEGIN..END-1, those with a pair in a group before FROM_GROUP if
// LATE, the others if not [grains.c].
struct pace move_grains(struct dem *dem, int begin, int end, int from_group, bool late);

// Force and moment on a grain, from its slots and from outside.
struct motion load_on_grain(const struct dem *dem, int particle);

// The largest stable time step [stability.c].
double stability_limit(const struct dem *dem);

static inline struct vector as_vector(const double a[3])
{
    return (struct vector){a[0], a[1], a[2]};
}

static inline struct vector lane_vector(const double (*a)[PAIRS_IN_GROUP], int lane)
{
    return (struct vector){a[0][lane], a[1][lane], a[2][lane]};
}

// How pair P lies when its grains are at BACK time steps before now.
struct pair_geometry {
    struct vector normal;
    double stretch; // distance less the distance at the start
    double overlap;
    struct vector position; // the contact point
};
struct pair_geometry pair_geometry(const struct dem *dem, int pair, double back);

#endif
