// SPDX-License-Identifier: GPL-3.0-or-later
// The pairs of an engine as the kernel takes them: in groups of eight, the same
// quantity of all eight side by side (structure of arrays within a group). All in
// scaled units (dem.h). Owner of the arrays is struct pair_list; free_pairs frees them.
// Why eight: a group is one AVX-512 vector or two of AVX2, so one layout serves both
// kernels, and every array of eight doubles is one cache line. Why not one array for
// each quantity: what a group needs of one kind then lies in successive lines.
//
// A scene pays for what it has. In bytes a pair: 56 for its place, 8 for its rows of
// sums, 24 for the last load and 48 for moments; a shear history 24; coefficients of
// its own 40; a bond 96; a bridge 40; rolling 40; the ledger of energy 32. Of a group
// that does nothing, a cycle reads the places of its pairs and the records of their
// grains, no more.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PAIRS_IN_GROUP = 8, CACHE_LINE = 64 };
// Groups store indices of grains and rows times this: processors then reach a record of
// 32 or 64 bytes by one scaled address.
enum { INDEX_SCALE = 8 };

// Eight pairs: pair p is lane p % PAIRS_IN_GROUP of group p / PAIRS_IN_GROUP. Unused
// lanes at the end pair the dummy grain (index n_particle) with itself, far apart.
// Displacements are added to SEPARATION, so x_j - x_i keeps the digits of the
// displacements (pair_kinematics.h). In a box that repeats it is that of the nearest
// image when the pair was found.
struct pair_group {
    _Alignas(CACHE_LINE) uint32_t first[PAIRS_IN_GROUP];
    uint32_t second[PAIRS_IN_GROUP];
    double separation[3][PAIRS_IN_GROUP]; // x_j - x_i where both began
    double distance[PAIRS_IN_GROUP];      // |separation|
    double overlap[PAIRS_IN_GROUP];       // R_i + R_j - distance; 0 if that is at rest
    double inverse_distance[PAIRS_IN_GROUP]; // for parallel bonds
};

// Where the loads on the two grains of each pair are added up: rows of dem->sum. Scaled
// as the grains' indices are. A row of a shared grain belongs to one pair alone.
struct sum_group {
    _Alignas(CACHE_LINE) uint32_t first[PAIRS_IN_GROUP];
    uint32_t second[PAIRS_IN_GROUP];
};

// What the pairs of a group did in the last cycle, if it is kept. FORCE acts on the
// second grain, the first feels the opposite. The moment on the first grain is stored
// with the opposite sign. Kept in the last cycle of a run only: contacts, censuses and
// loads are read from it.
struct load_group {
    _Alignas(CACHE_LINE) double force[3][PAIRS_IN_GROUP];
};
struct moment_group {
    _Alignas(CACHE_LINE) double first[3][PAIRS_IN_GROUP];
    double second[3][PAIRS_IN_GROUP];
};

// What a group has besides, where the scene needs it. History of the shear force: In
// the contact plane of the last step, on the second grain; the spring's part alone,
// without dashpot.
struct shear_group {
    _Alignas(CACHE_LINE) double force[3][PAIRS_IN_GROUP];
};

// Coefficients of each pair, as in struct contact_law, where pairs differ. Without
// FEATURE_PAIR_LAWS it is not allocated: dem->law holds for all.
struct law_group {
    _Alignas(CACHE_LINE) double normal_stiffness[PAIRS_IN_GROUP];
    double shear_stiffness[PAIRS_IN_GROUP];
    double normal_damping[PAIRS_IN_GROUP];
    double shear_damping[PAIRS_IN_GROUP];
    double friction[PAIRS_IN_GROUP];
};

// Bonds, and what parallel ones carry on the second grain. Times A R spares the kernel
// a division for each bond (pair_bond.h).
struct bond_group {
    _Alignas(CACHE_LINE) double radius[PAIRS_IN_GROUP]; // 0 without an intact bond
    double normal_strength[PAIRS_IN_GROUP];             // -1 without an intact bond
    double shear_strength[PAIRS_IN_GROUP]; // of parallel bonds, both times A R
    double shear_force[3][PAIRS_IN_GROUP]; // of parallel bonds, as all below
    double bending[3][PAIRS_IN_GROUP];     // M^s
    double twist[PAIRS_IN_GROUP];          // M^n along n
    double free_stretch[PAIRS_IN_GROUP];   // of no tension; < 0 once shrunk
    int8_t crack[PAIRS_IN_GROUP]; // mode of a bond broken in this cycle, -1 otherwise
};

// Energy that each pair has lost since close_pair_ledger, by the way it went. In scaled
// units of energy. Only with balance_energy.
struct loss_group {
    _Alignas(CACHE_LINE) double dashpots[PAIRS_IN_GROUP];
    double slip[PAIRS_IN_GROUP];
    double broken[PAIRS_IN_GROUP];
    double bridges[PAIRS_IN_GROUP];
};

// Liquid bridges. Volumes and gaps over the effective radius: then one table of the
// force serves every pair.
struct liquid_group {
    _Alignas(CACHE_LINE) double pull[PAIRS_IN_GROUP]; // of the bridge, in this cycle
    double radius[PAIRS_IN_GROUP];                    // effective [G 1]
    double asymmetry[PAIRS_IN_GROUP]; // of the two radii [bridges/ratios.h]
    // Over its cube; 0: no bridge. Of adhesion the unit of gaps.
    double volume[PAIRS_IN_GROUP];
    double rupture[PAIRS_IN_GROUP]; // the gap at which it ruptures, over the radius
};

// Rolling resistance: coefficients, and the moment of the rolling spring on the second
// grain. In the contact plane of the last step, as the shear force.
struct rolling_group {
    _Alignas(CACHE_LINE) double moment[3][PAIRS_IN_GROUP];
    double arm[PAIRS_IN_GROUP];     // rolling friction times effective radius
    double damping[PAIRS_IN_GROUP]; // moment per angular velocity; Hertz: times U^0.25
};

// The same coefficients of one contact. ARM is a length, DAMPING as in rolling_group.
struct rolling_law {
    double arm, damping;
};

// Coefficients of a contact with overlap U. Linear: normal force = normal_stiffness U,
// shear stiffness and damping as they are. Hertz: normal force = normal_stiffness
// U^1.5, shear stiffness times U^0.5, both dampings times U^0.25.
struct contact_law {
    double normal_stiffness; // of a contact, K^n_ij
    double shear_stiffness;
    double friction;
    double normal_damping; // force per velocity
    double shear_damping;
};

// All pairs that are swept, in the order in which loads are added. Pairs of grains that
// merely may come near are in it, too: most do nothing, and those that cannot for a
// while are taken out (inactive_pairs.c).
struct pair_list {
    void *block; // that holds the arrays of groups
    size_t block_size;
    int n_pair;
    int32_t (*particle)[2]; // (n_pair) sorted by first, then second
    int32_t *bond;          // (n_pair) the bond of the packing, broken or not; or -1
    int n_group;
    struct pair_group *group; // (n_group)
    struct sum_group *sum;    // (n_group)
    struct load_group *load;  // (n_group)
    // (n_group) whether a grain of it is shared between threads: then `sum` says where
    // loads are added up, otherwise they go to the rows of the grains.
    uint8_t *has_shared_grain;
    uint8_t *idle; // (n_group) no pair touches or is bonded, and all loads kept are 0
    // (n_group) or NULL where not needed
    struct moment_group *moment;
    struct shear_group *shear;
    struct law_group *laws;
    struct bond_group *bonds;
    struct loss_group *loss;
    struct liquid_group *liquid;
    struct rolling_group *rolling;
};

// The grains of LANE, as indices; set_grains scales them. Not of an unused lane, whose
// grain is the dummy.
static inline int first_grain(const struct pair_group *group, int lane)
{
    return (int)(group->first[lane] / INDEX_SCALE);
}

static inline int second_grain(const struct pair_group *group, int lane)
{
    return (int)(group->second[lane] / INDEX_SCALE);
}

static inline void set_grains(struct pair_group *group, int lane, int first, int second)
{
    group->first[lane] = INDEX_SCALE * (uint32_t)first;
    group->second[lane] = INDEX_SCALE * (uint32_t)second;
}

// The vector of LANE in a group's components. A[axis][lane].
static inline struct vector lane_vector(const double (*a)[PAIRS_IN_GROUP], int lane)
{
    return (struct vector){a[0][lane], a[1][lane], a[2][lane]};
}

// Frees what it owns, not the struct. The struct holds dangling pointers then: assign
// another list to it. The arrays of groups lie in one block.
void free_pairs(struct pair_list *pairs);
// Copies history and image of a pair that was in the old list; SWAPPED: its grains are
// in the other order now. Vectors of swapped pairs change sign, because they act on the
// other grain now; the twist does not, because n turns round as well. Indices of pairs,
// not of groups. Both lists have the same kinds of arrays, being of one engine.
void carry_over(struct pair_list *new, int new_pair, const struct pair_list *old,
                int old_pair, bool swapped);
