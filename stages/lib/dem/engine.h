// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct dem; for the files of this folder only. All in scaled units
// (dem.h).
//
// A cycle sweeps pairs and grains together. The pair sweep (pair_kernel.h) reads the
// records of both grains, advances the history of the pair and adds the load to the
// sums of both grains, pair after pair in the order of the list. Pairs are sorted by
// their first grain, so after those of grain g no pair involves g any more. So the
// grain sweep (grains.c) follows close behind: it moves each grain by its sum and
// clears that, while everything is still in the cache.
//
// Each thread does so with its chunk of the groups. A grain with pairs in the chunks of
// several threads is shared (a boundary row of the sum): each of its pairs has a row of
// its own, and when all threads are done its sum is made of those rows, in the order of
// pairs. So the order of every sum is fixed, for any number of threads.
//
// Grains of large scenes are numbered along a space-filling curve
// (space_filling_order.c), so that the partners of a grain are near it in memory. `id`
// is their index in the packing, `index` the inverse.
//
// What holds between two calls: all rows of `sum` are 0; pairs are sorted by first,
// then second grain, in the engine's numbers; a pair that may touch before a grain has
// moved by half of its skin is in the list; no pair is inactive but within a run;
// `place` is one step ahead of the forces in pairs and walls (places_ahead), `motion`
// half a step behind `place`.
//
// Who writes what while threads run: a thread writes its share of the wall pairs, the
// groups of its chunks, rows of `sum` that no other thread has, and the grains that it
// finishes; counts of bridges are atomic; all else is written by the first thread while
// the others wait at a barrier (dem.c). Functions here without a word on threads are
// for one thread.
#pragma once

#include "basics/compensated.h"
#include "bridges/table.h"
#include "dem/dem.h"
#include "dem/pairs.h"

#include <stddef.h>

// A grain may move half of this (in mean radii) before the pairs are sought again; at
// the start, later tuned to how fast grains move (neighbours.c).
#define FIRST_SKIN 0.2
// No grain may move further than this (in mean radii) in one time step.
#define MAX_STEP 0.1
// Share of the stability limit that an automatic time step is, unless the setup says
// otherwise.
#define AUTOMATIC_SHARE 0.5
// Fewer pairs, of grains or with walls, are left to one thread: starting others, or
// waiting for them once more, would cost more.
enum { MIN_PARALLEL_PAIRS = 5000, MIN_PARALLEL_WALL_PAIRS = 200 };

// What a scene needs; the bits choose a compiled pair sweep.
enum feature {
    FEATURE_ROTATION = 1,  // grains turn and contacts have a history of shear
    FEATURE_HERTZ = 2,     // stiffness grows with the overlap
    FEATURE_PAIR_LAWS = 4, // pairs differ in stiffness, damping or friction
    FEATURE_CONTACT_BOND = 8,
    FEATURE_PARALLEL_BOND = 16,
    FEATURE_BOND = FEATURE_CONTACT_BOND | FEATURE_PARALLEL_BOND,
    FEATURE_ROLLING = 32, // contacts resist rolling, and have a history of that
    FEATURE_MOMENT = FEATURE_PARALLEL_BOND | FEATURE_ROLLING // pairs carry couples
};

// All sums of bits; of most there is no sweep, see EACH_SET.
enum { FEATURE_SETS = 64 };

// Place of a grain: its displacement from where it began; the radius fills the record,
// so that the kernel loads four doubles at once.
struct place {
    _Alignas(32) double displacement[3];
    double radius;
};

// Velocity and angular velocity of one grain, or force and moment; the fourth of each
// is 0.
struct motion {
    _Alignas(CACHE_LINE) double linear[4];
    double angular[4];
};

// A material in scaled units.
struct material {
    double density;
    double normal_stiffness, shear_stiffness, damping_ratio; // linear
    double young_modulus, poisson_ratio;                     // Hertz
    double rolling_damping;
};

// The liquid of a wet scene, and what holds for all bridges.
struct liquid {
    struct dem_liquid is;        // scaled; of adhesion its work is the surface tension
    bool is_adhesion;            // no liquid: dry grains adhere [adhesion.c]
    struct bridge_ratios *table; // of BRIDGE_TABLE
    double cutoff;               // the longest gap that any bridge can have
    double wall_cutoff;          // to a wall
    // (n_particle) number of bridges of each grain, at the end of the last cycle and as
    // they come and go in this one; whether the two differ.
    int32_t *bridges, *next;
    int changed;
};

// A grain that is near a wall. Few beside the pairs of grains, so they are structs, one
// after the other, and not in lanes. It is in scaled units; loads and moments are those
// of the last force. A pair lives as long as the grain is near the wall
// (find_wall_pairs), and keeps its history over searches.
struct wall_pair {
    int32_t particle, wall;
    double depth;               // overlap at the last force
    struct vector load, moment; // on the grain, at the last force
    struct contact_law law;
    struct vector shear_force;
    struct vector normal; // towards the wall, at the last force
    // What the wall gets of this force, and what was lost in the step.
    struct vector wall_moment; // about its point
    double resistance, dashpots, slip, bridge_work;
    struct rolling_law rolling;
    struct vector rolling_moment; // of the rolling spring on the wall
    // Of the liquid bridge, where walls are wet; as those of a liquid_group.
    double bridge_radius, bridge_volume, bridge_rupture, bridge_pull;
};

// Scaled. What was asked for and what is differ for a servo, which sets its own
// velocity along the normal.
struct rigid_wall {
    struct dem_wall is;         // scaled, unit normal; velocity and spin as asked for
    struct vector displacement; // of its point
    struct vector displacement_at_search;
    struct vector velocity, spin; // half a step behind
    struct vector force, moment;  // what grains did to it in the last cycle
    double resistance; // of its contacts now: stiffness times dt plus damping, in sum
    double work;       // on the grains, if the balance is wanted
};

// Compensated sums, because a million steps of one length would drift.
struct driven_group {
    struct dem_group is; // scaled, unit axis or 0; velocity and spin as asked for
    struct compensated translation[3], angle; // of all steps so far
    struct vector moved;                      // the translation, rounded
    double sine, versine;                     // of the angle; 1 - its cosine
    struct vector velocity;                   // half a step behind, as the next
    double spin;
};

// What 1 is in scaled units: m, kg, N/m and s. Time follows from the others: sqrt(mass
// / stiffness).
struct units {
    double length, mass, stiffness, time;
};

// The pair sweep over groups BEGIN..END-1; returns how many bonds broke. One compiled
// function a set of features and instruction set; create.c takes one of them.
typedef int pair_sweep(const struct dem *dem, int begin, int end);
// The sets of features that can occur: bonds always turn, contact bonds are linear, and
// bonded grains do not resist rolling but by their bonds.
#define EACH_SET(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(9) DO(13)
#define EACH_PARALLEL_BOND_SET(DO) DO(17) DO(19) DO(21) DO(23)
#define EACH_ROLLING_SET(DO) DO(33) DO(35) DO(37) DO(39)
#define DECLARE(features) pair_sweep sweep_avx2_##features, sweep_avx512_##features;
EACH_SET(DECLARE)
EACH_PARALLEL_BOND_SET(DECLARE)
EACH_ROLLING_SET(DECLARE)
#undef DECLARE
// Gaps of the pairs of group K, in effective radii of their liquid bridges; GAP aligned
// to a cache line. Returns a bit for each lane that touches or has a bridge.
typedef unsigned pair_gaps(const struct dem *dem, int k, double gap[PAIRS_IN_GROUP]);
pair_gaps pair_gaps_avx2, pair_gaps_avx512;
extern pair_sweep *const pair_sweeps_avx2[FEATURE_SETS];
extern pair_sweep *const pair_sweeps_avx512[FEATURE_SETS];

// It owns all its arrays. Grains are in the order of `id`, not of the packing; results
// are put back into that order before they leave the engine. In blocks: laws and time;
// grains; bonds; pairs and walls; how loads are added up; when pairs are sought; the
// balance; cracks. What a checkpoint holds of it is listed in state_columns.c.
struct dem {
    struct units unit;
    enum dem_law kind;
    unsigned features;   // bits of enum feature that the scene needs
    bool springs_differ; // pairs differ in more than damping
    int n_material;
    struct material *material; // (n_material)
    double *pair_friction;     // (n_material^2)
    double *pair_restitution;
    double *pair_rolling_friction;
    double contact_time;          // DEM_TIMED
    struct contact_law law;       // of every pair, unless FEATURE_PAIR_LAWS
    double bond_normal_stiffness; // per area
    double bond_shear_stiffness;  // per area
    // beta: share of moments that stresses of parallel bonds count
    double moment_contribution;
    enum dem_bond_kind bond_kind;
    double local_damping;    // share, [0,1)
    bool no_tensile_damping; // normal forces >= 0 where no bond holds
    double time_step;
    double time_step_limit; // that of dem_time_step_limit
    double critical_step;   // of two grains [K 4.47], which the safety multiplies
    const char *safety_key; // not owned; NULL: none
    // Neither time_step nor safety was given; and it has been shortened since,
    // for pairs found later, or adapted.
    bool step_is_automatic, step_was_shortened;
    bool step_is_adapted;    // by dem_adapt_time_step
    double automatic_share;  // of the limit
    double time_before;      // simulated until the time step last changed
    int64_t step_since;      // the cycle at which it did
    double expected_overlap; // of Hertz contacts
    int64_t cycle;           // completed
    int threads;             // asked for, >= 1
    pair_sweep *sweep;       // of these features, for this processor
    pair_gaps *gaps;         // for this processor

    int n_particle;
    int32_t *id;          // (n_particle) index in the packing
    int32_t *index;       // (n_particle) the inverse
    struct vector *start; // (n_particle) where each began
    struct place *place;  // (n_particle+1), the last is the grain that is not there
    // (n_particle+1) velocities and angular velocities, half a step behind the places:
    // records of four, x y z 0, MOTION_STRIDE doubles apart [place_motions].
    // velocity_of and spin_of find those of a grain.
    double *velocity, *spin;
    size_t motion_stride;
    double (*external)[4];  // (n_particle) force, weight included
    bool has_external;      // some external force is not 0
    struct vector *applied; // (n_particle) without weight; NULL: none
    struct vector gravity;
    double (*mobility)[2]; // (n_particle) 1/m, 1/I; 0 when fixed or driven
    bool equal_mobility;   // all mobilities are the same
    double *mass;          // (n_particle) inertia
    double *weight;        // (n_particle) mass that gravity pulls
    // (n_particle) that dem_even_steps multiplies inertia by; NULL: 1
    double *inertia_factor;
    uint8_t *material_of; // (n_particle)
    int n_driven;
    struct driven_group *group; // (n_driven)
    uint8_t *group_of;          // (n_particle) 1 + its group, or 0; NULL: no groups
    struct vector *lever; // (n_particle) from the point of its group, at the start
    // (n_particle) as the packing numbers them; NULL: nothing shrinks [shrinkage.c]
    double *shrinkage, *first_radius;
    bool density_scaling; // inertia of all is the mean mass
    double least_mass;    // over the mean mass; 0: none
    bool falls_alike;     // weights in proportion to inertia, as much in all
    double largest_radius, smallest_radius;
    double coordinate_error; // rounding of the positions as given
    bool unstressed;         // overlaps at the start count as none
    bool friction_feels_dashpot;
    double period[3];                  // 0 where the box does not repeat
    double box_lower[3], box_upper[3]; // as it is now, rescaled

    int n_bond;
    int32_t (*bond_particle)[2]; // (n_bond) lower first, in the engine's numbers
    double *bond_radius;         // (n_bond) of parallel bonds; else 0
    double *bond_strength[2];    // (n_bond) by enum dem_crack_mode; -1 once broken

    struct pair_list pairs;
    struct inactive_pairs *inactive; // what is not swept for now; NULL: nothing
    double
        min_inactive_gap;  // of two grains that may rest; tuned, never seen in results
    struct liquid *liquid; // NULL: dry, and no adhesion
    int n_wall;
    struct rigid_wall *wall; // (n_wall) in the order of the setup
    int n_wall_pair;
    struct wall_pair *wall_pair; // by grain, then wall
    int *wall_offset;            // (n_particle+1) into wall_pair
    int *pair_offset;            // (n_particle+1) into pair_of
    int32_t *pair_of;            // (2 n_pair) the pairs of each grain, in their order
    int pair_of_room;            // pairs that have room in it
    void *spare_block;           // of an earlier list of pairs, for the next [pairs.c]
    size_t spare_size;
    int *first_group;   // (n_particle) with a pair of the grain
    int *last_group;    // (n_particle) with a pair whose first is <= the grain
    int n_chunk;        // of the groups, for as many threads
    uint8_t *is_shared; // (n_particle)
    int n_shared;
    int32_t *shared_grain; // (n_shared)
    int32_t *first_row;    // (n_shared+1) of `sum`, the first of each
    // Rows of 4 or, if grains turn, 8 doubles: force and moment; 0 between cycles. One
    // for each grain and for the dummy, then one for each pair of a shared grain.
    double *sum;
    size_t sum_room;  // doubles that have room in it
    bool keeps_loads; // of all pairs, in this cycle

    // The search for pairs [neighbours.c]; skins are tuned.
    double skin;       // of a grain at rest, the least
    double horizon;    // cycles for which skins of moving grains are deeper
    double mean_skin;  // of all grains
    double *half_skin; // (n_particle) a grain may move so far before the next search
    double used;       // no grain has moved by a larger share of it since the last
    struct vector *place_at_search; // (n_particle) displacement when pairs were sought
    double last_travel;             // no grain has moved further in the last cycle
    double closed_in;      // what rescaling and shrinkage brought surfaces nearer since
    int64_t search_cycle;  // when pairs were sought
    int searches_in_order; // since grains were last renumbered

    bool balance_energy;
    struct dem_energy energy_ledger; // the parts that only grow, of pairs that are gone
    double (*grain_ledger)[2];       // (n_particle) gained, lost to local damping

    int n_crack, crack_capacity;
    struct dem_crack *crack; // (n_crack) by cycle, then bond; SI
};

// Refuses a setup that cannot be [check_setup.c]. STATUS_BAD_DATA with one line, else
// STATUS_OK; reads SETUP only, before anything is allocated.
enum status check_setup(const struct dem_setup *setup, struct reason *reason);

// Material KIND of the setup, 0 the first. In SI, as the user gave it.
static inline const struct dem_material *material(const struct dem_setup *setup,
                                                  int kind)
{
    return kind == 0 ? &setup->material : &setup->other[kind - 1];
}

// Whether NORMAL of such a wall means anything.
static inline bool has_direction(enum dem_wall_shape shape)
{
    return shape == DEM_PLANE || shape == DEM_CYLINDER || shape == DEM_RING;
}

// Finds the pairs; those that were there keep their history [neighbours.c].
// O(n_particle) for grains of similar size.
void find_pairs(struct dem *dem);
// Makes these the pairs, sorted, and all that depends on them; takes over both arrays.
// Those that were there before keep their history [pairs.c]. Both arrays have N_PAIR
// rows; first < second in each. BOND is -1 for none.
void take_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond);
// Counts that surfaces came nearer by DISTANCE each, of which no displacement tells.
void count_approach(struct dem *dem, double distance);
// Whether pairs must be found again, as a grain may have moved further than half its
// skin. Renewing finds and takes them, and numbers grains anew from time to time.
bool pairs_are_due(struct dem *dem);
void renew_pairs(struct dem *dem);
// Lays out the rows of `sum` for the pairs that are swept [sums.c]. O(n_particle +
// n_pair). After any change of the list or of n_chunk. Grains become shared only where
// n_chunk is above 1.
void arrange_sums(struct dem *dem);
// Leaves out pairs that can do nothing, with LEFT cycles to go, and takes them back
// before they can, and for the last cycle; BEGINS at the start of a run
// [inactive_pairs.c]. Results do not depend on which pairs rest: those that rest could
// not touch.
void update_inactive_pairs(struct dem *dem, int64_t left, bool begins);
void reactivate_pairs(struct dem *dem);
// Adds the losses of all pairs to the energy ledger and clears them.
void close_pair_ledger(struct dem *dem);
// Allocates lists of N_PAIR pairs, with what the scene needs; takes over both arrays.
void new_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond);
// Frees a list, or keeps its block for the next one.
void give_back_pairs(struct dem *dem, struct pair_list *pairs);
// Sets separation, distance and overlap of the pair in lane LANE of GROUP, as of where
// its grains began.
void set_pair_place(const struct dem *dem, struct pair_group *group, int lane);
// Makes lane PAIR a pair of the dummy grain, which does nothing.
void set_dummy_pair(struct dem *dem, int pair);
// Sets the coefficients of pair PAIR where pairs differ. From materials, radii and
// inertia of its two grains.
void set_pair_law(struct dem *dem, int pair);

// Numbers grains along a curve, and pairs and bonds with them [space_filling_order.c].
void renumber_grains(struct dem *dem);
// Gives grains the order in which grain k is ID[k] of the packing, each once. What
// pairs point to is left to whoever makes them again.
void set_grain_order(struct dem *dem, const int32_t *id);

// Coefficients of the contact of two grains, or of a grain and a wall [materials.c]. I
// and J are indices of the engine.
struct contact_law pair_law(const struct dem *dem, int i, int j);
// Where grains are alike, of all pairs, whatever inertia dem_even_steps gives each.
struct contact_law common_law(const struct dem *dem);
struct contact_law wall_law(const struct dem *dem, int i, const struct dem_wall *wall);
double plane_strain_compliance(const struct material *m); // (1 - nu^2)/E, Hertz
// Rolling resistance [rolling.c]; nothing without FEATURE_ROLLING. Of a pair with the
// normal STIFFNESS of its law, of two grains like I; stiffness and damping of rolling
// at a secant STIFFNESS and OVERLAP of the contact.
void set_pair_rolling(struct dem *dem, int pair, double stiffness);
struct rolling_law pair_rolling(const struct dem *dem, int pair);
struct rolling_law rolling_of_two(const struct dem *dem, int i);
double rolling_stiffness(const struct rolling_law *law, double stiffness);
double rolling_damping(const struct dem *dem, const struct rolling_law *law,
                       double overlap);
void set_wall_rolling(const struct dem *dem, struct wall_pair *pair);
// Elastic energy of a rolling spring with MOMENT, at a secant STIFFNESS of the contact.
double rolling_energy(const struct rolling_law *law, double stiffness,
                      struct vector moment);
double pair_rolling_energy(const struct dem *dem, int pair, double stiffness);
// One step of the rolling spring of PAIR: where the shear force goes [walls.c], how
// fast the wall turns against the grain, the contact's secant stiffness before and now,
// and what counts as the normal force. Returns the moment on the wall, dashpot
// included; adds what is lost.
struct wall_rolling {
    struct vector turned;  // the moment of the step before, in the plane of now
    struct vector rolling; // relative angular velocity, in that plane
    double stiffness_before, stiffness, retained, normal_force, damping, time_step;
};
struct vector advance_wall_rolling(struct wall_pair *pair,
                                   const struct wall_rolling *step, double *slip,
                                   double *dashpots);

// Sets masses, mobilities and the common law from radii and materials. FIXED is as in
// the setup, by index in the packing; NULL keeps those that are fixed. With
// density_scaling every grain gets the mean inertia, but keeps its weight.
void set_masses(struct dem *dem, const uint8_t *fixed);
// Of grain I, of its radius and density.
double own_mass(const struct dem *dem, int i);
// Sets external forces from what is applied and gravity.
void set_external(struct dem *dem);
void set_equal_mobility(struct dem *dem); // sets equal_mobility
// STATUS_BAD_DATA: the periods times STRETCH are too short for one image of each pair.
enum status check_periods(const struct dem *dem, const double stretch[3],
                          struct reason *reason);

// Liquid bridges [liquid.c]; all but the first two only in wet scenes. The longest gap,
// scaled, at which pairs must still be listed.
double bridge_cutoff(const struct dem *dem); // 0 in dry ones
void free_liquid(struct liquid *liquid);     // or NULL
// Scales IS; before pairs are sought. BRIDGE_TABLE is made here, which can fail.
enum status take_liquid(struct dem *dem, const struct dem_liquid *is,
                        struct reason *reason);
// Adhesion in place of liquid, of this WORK, scaled [adhesion.c].
void take_adhesion(struct dem *dem, double work);
void set_bridge_radius(const struct dem *dem, int pair);
void form_bridges(struct dem *dem);  // where grains touch as they lie
void count_bridges(struct dem *dem); // of each grain, from the pairs
// Forms, keeps and ruptures the bridges of groups BEGIN..END-1 and finds how they pull;
// before the pair sweep. Safe for several threads at once with disjoint groups: counts
// are changed atomically.
void update_bridges(const struct dem *dem, int begin, int end);
void publish_bridge_counts(struct dem *dem); // at the end of a cycle
struct dem_bridge bridge_of_pair(const struct dem *dem, int pair); // no volume: none
double wall_bridge_cutoff(const struct dem *dem);                  // 0 where none form
void set_wall_bridge_radius(const struct dem *dem, struct wall_pair *pair);
// Forms, keeps or ruptures the bridge of PAIR at OVERLAP and finds its pull.
void update_wall_bridge(const struct dem *dem, struct wall_pair *pair, double overlap);
struct dem_bridge bridge_of_wall_pair(const struct dem *dem,
                                      const struct wall_pair *pair);

// Adhesion [adhesion.c], in effective radii RADIUS = 2 R*, as bridges. The UNIT of gaps
// and overlaps of a contact of MODULUS E*; the gap at which it breaks; the overlap at
// which a Hertz contact is as large as this one under no load, and stiffer. Pulls
// beside the Hertz spring, over work and RADIUS.
double adhesion_unit(double work, double modulus, double radius);
double adhesion_rupture(double unit);
double adhesion_overlap(double unit);
void adhesion_pulls(int count, const double *unit, const double *gap, double *pull);

// Room for the shrinkage of grains, if SETUP has any [shrinkage.c].
void take_shrinkage(struct dem *dem, const struct dem_setup *setup);

// Scaled. O(pairs).
double elastic_energy(const struct dem *dem); // of all pairs and walls [energy.c]
// What grain I has booked as gained of the step after the other energies, as
// displacements are one step ahead.
double booked_ahead(const struct dem *dem, int i);

// Walls [walls.c].
void find_wall_pairs(struct dem *dem);
void list_walls_of_grains(struct dem *dem); // sets wall_offset
// In a cycle: before the forces of its pairs are found, and after. add_up_walls sums
// the loads in the order of pairs, so that threads do not matter.
void begin_walls(struct dem *dem);
void add_up_walls(struct dem *dem);
void move_walls(struct dem *dem);
// How far any wall has moved since pairs were found: as with grains, at most half the
// skin.
double wall_travel(const struct dem *dem);
// Sets the coefficients of wall pairs again.
void set_wall_laws(struct dem *dem);
// Finds the forces of pairs BEGIN..END-1, each of which changes itself only
// [wall_contact.c].
void touch_walls(struct dem *dem, int begin, int end);
// Elastic energy as of the last force.
double wall_pair_energy(const struct dem *dem, const struct wall_pair *pair);

// How grain I lies to wall W when both are at BACK time steps before now
// [wall_shapes.c]. The nearest point of the wall is radius - overlap from the centre
// along the normal, but for an overlap at the start that does not push; a centre that
// has passed the surface is pushed back out.
struct wall_geometry {
    struct vector normal; // unit, from the grain into the wall
    double overlap;
    double arm; // from the centre to the contact point, halfway into what they share
    struct vector lever; // from the wall's point to the contact point
};
// OVERLAP < 0 apart.
struct wall_geometry wall_geometry(const struct dem *dem, int i, int w, double back);

// The largest squared speed, or an upper bound with that of a largest grain's surface
// from rotation included. SHARES is the largest square of a speed over half_skin. VALID
// is false when a grain, or its surface, would have moved too far to be true; such a
// grain stayed where it was.
struct max_speed {
    double square, shares;
    bool valid;
};

// Driven groups [driven_groups.c]. Scales those of SETUP; before pairs are sought.
void take_groups(struct dem *dem, const struct dem_setup *setup);
// Sets levers and velocities of their grains, when the box is known.
void start_groups(struct dem *dem);
// Moves groups by a step, their grains not yet; before the pair sweep.
void advance_groups(struct dem *dem);
// Moves driven grain I to where its group is, and books the work on it.
struct max_speed move_driven_grain(struct dem *dem, int i, const struct motion *load);
struct vector group_translation(const struct driven_group *group); // rounded
// From the point of its group to grain I when the group has turned by ANGLE.
struct vector driven_lever(const struct dem *dem, int i, double angle);
// Power of a group by its grain I against LOAD.
double group_power(const struct dem *dem, int i, const struct motion *load);

// Moves the grains BEGIN..END-1 that are not shared, or entries BEGIN..END-1 of the
// list of shared ones [grains.c]. Leapfrog [K 4.1-4.6]: v += dt F/m, then u += dt v;
// rotations likewise. Clears the sums that it has used. O(END - BEGIN). Fixed grains
// have a mobility of 0 and stay; driven ones follow their group.
struct max_speed move_grains(struct dem *dem, int begin, int end);
struct max_speed move_shared_grains(struct dem *dem, int begin, int end);

// Force and moment on a grain in the last cycle, external ones too, if loads were kept.
struct motion load_on_grain(const struct dem *dem, int particle);

// The largest stable time step [stability.c]: of all pairs in the list, or if NOW only
// of those that touch, at the overlaps they have. Scaled.
double stability_limit(const struct dem *dem, bool now);
// The lesser of it and of that of two equal grains that meet, with local damping
// counted at each spring and dashpot [relaxation.c]; finite.
double sharp_stability_limit(const struct dem *dem, bool now);
// Likewise with local damping: the limit of grains like any two that meet, infinite
// where nothing resists; and that of one grain of the list, at most MOST, a little too
// low.
double limit_of_two(const struct dem *dem);
double sharp_grain_limit(const struct dem *dem, int particle, bool now, double most);
// AUTOMATIC_SHARE of it, or of that of two equal grains that meet, if that is less.
double automatic_time_step(const struct dem *dem);
// Shortens an automatic step that is too long for the pairs that have been found.
void shorten_time_step(struct dem *dem);

// Groups that a thread sweeps; the last chunk may have fewer.
static inline int groups_in_chunk(const struct dem *dem)
{
    return (dem->pairs.n_group + dem->n_chunk - 1) / dem->n_chunk;
}

// Whether threads share the pairs with walls.
static inline bool walls_are_shared(const struct dem *dem)
{
    return dem->n_chunk > 1 && dem->n_wall_pair >= MIN_PARALLEL_WALL_PAIRS;
}

// The velocity and the angular velocity of a grain, of four.
static inline double *velocity_of(const struct dem *dem, int i)
{
    return dem->velocity + dem->motion_stride * (size_t)i;
}

static inline double *spin_of(const struct dem *dem, int i)
{
    return dem->spin + dem->motion_stride * (size_t)i;
}

// Where the centre of PARTICLE is, scaled: for geometry only, as the sum rounds what
// the displacement keeps.
static inline struct vector position_now(const struct dem *dem, int particle)
{
    return add(dem->start[particle], as_vector(dem->place[particle].displacement));
}

// Driven grains feel forces and do not answer to them.
static inline bool is_driven(const struct dem *dem, int i)
{
    return dem->group_of && dem->group_of[i];
}

// How many time steps the places are ahead of the forces. Results speak of the last
// forces; geometry at BACK = places_ahead is that of these forces.
static inline double places_ahead(const struct dem *dem)
{
    return dem->cycle > 0 ? 1 : 0;
}

// Coefficients of pair PAIR, its own or those of all.
struct contact_law law_of_pair(const struct dem *dem, int pair);

// What the radius of a grain has lost by shrinkage.
static inline double shrunk_by(const struct dem *dem, int i)
{
    return dem->shrinkage ? dem->first_radius[dem->id[i]] - dem->place[i].radius : 0;
}

// An overlap at the start, as it counts: one within the rounding of coordinates is
// none.
static inline double given_overlap(const struct dem *dem, double overlap)
{
    if (dem->unstressed && overlap > 0) return 0;
    return fabs(overlap) <= dem->coordinate_error ? 0 : overlap;
}

// The bond of a pair, broken or not, or -1.
static inline int bond_of_pair(const struct dem *dem, int pair)
{
    return dem->pairs.bond ? dem->pairs.bond[pair] : -1;
}

// For a pair of the list, in plain C: not for the sweep.
static inline bool is_bonded(const struct dem *dem, int pair)
{
    return dem->pairs.bonds && dem->pairs.bonds[pair / PAIRS_IN_GROUP]
                                       .normal_strength[pair % PAIRS_IN_GROUP] >= 0;
}

// Whether a liquid bridge joins the grains of a pair, whatever it pulls with.
static inline bool is_bridged(const struct dem *dem, int pair)
{
    return dem->pairs.liquid &&
           dem->pairs.liquid[pair / PAIRS_IN_GROUP].volume[pair % PAIRS_IN_GROUP] > 0;
}

static inline bool walls_are_wet(const struct dem *dem)
{
    return dem->liquid && dem->liquid->is.wets_walls;
}

static inline bool is_wall_bridged(const struct dem *dem, const struct wall_pair *pair)
{
    return walls_are_wet(dem) && pair->bridge_volume > 0;
}

// What messages call wall number W.
struct wall_label {
    char text[200];
};
struct wall_label wall_label(const struct dem_wall *wall, int w);

// Whether the wall felt the grain at the last force.
static inline bool acts_on_wall(const struct dem *dem, const struct wall_pair *pair)
{
    return pair->depth >= 0 || is_wall_bridged(dem, pair);
}

// Geometry of pair P when its grains are at BACK time steps before now.
struct pair_geometry {
    struct vector normal;
    double stretch; // distance less the distance at the start
    double overlap;
    double shared;          // of the radii, also where an overlap does not push
    struct vector position; // the contact point
};
// In plain C and scaled; for whatever looks at pairs outside of the sweep.
struct pair_geometry pair_geometry(const struct dem *dem, int pair, double back);
