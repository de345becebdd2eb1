// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct equilibrium, for the files that make it up only. All in its
// units: lengths in mean radii, stiffnesses in the largest of a joint.
#ifndef CRAQUELURE_QUASI_STATIC_INTERNAL_H
#define CRAQUELURE_QUASI_STATIC_INTERNAL_H

#include "contact_solver.h"
#include "quasi_static.h"
#include "geometry/fragments.h"
#include "geometry/net_load.h"
#include "make_contact_pairs.h"
#include "quasi_static/large/large_state.h"
#include "stiffness.h"

#include <math.h>

// How a joint was when the stiffness was factored.
struct factored {
    enum touch touch;
    bool is_bonded;
};

// Mean radii, and as much of a turn: further is not small.
static const double furthest = 0.1;

// A bond is at its strength from here on: what rounding and the tolerance leave open.
static const double strong = 1 - 1e-9;

// Forces on many grains add up: where it comes easily, less is left than may be.
static const double well_below = 1e-3;

struct equilibrium;

// What depends on how far grains may move.
struct equilibrium_kind {
    // Joints at the trial: strains, and resistance, which is taken off what is left.
    void (*resist)(struct equilibrium *);
    bool (*factor)(struct equilibrium *); // the tangents, if there is such a factor
    void (*take)(struct equilibrium *);   // a step that is found; NULL: as it is
    void (*keep_history)(struct equilibrium *); // besides; or NULL
    bool (*approach)(struct equilibrium *); // the next one, or step in time towards it
    enum status (*balance)(struct equilibrium *, struct reason *); // all of the load
};
extern const struct equilibrium_kind small_displacements, large_displacements;

struct equilibrium {
    const struct equilibrium_kind *kind;
    const struct packing *packing;
    struct equilibrium_setup setup;
    double length, stiffness; // units
    int n, n_joint;
    struct joint *joint;
    double (*strain)[STRAINS];     // (n_joint) of the trial
    double (*more)[STRAINS];       // (n_joint) that a step would add
    double (*grown)[STRAINS];      // (n_joint) by the last load or step in time
    struct resistance *resistance; // (n_joint) of the trial
    struct displacement *trial;    // (n) and once found, the equilibrium
    const struct vector *force;    // (n) N, from outside, while one is looked for
    struct displacement *load;     // (n) of it what counts
    struct net_load taken_off;     // of the load, where nothing holds the grains
    double damping;                // of dashpots, over the stiffness and a time step
    struct displacement *dashpots; // (n) what they pull at that damping of 1
    struct displacement *left;     // (n) what is not balanced at the trial
    struct displacement *rest;     // (n) of that, what the factor has to balance
    struct displacement *step;     // (n)
    struct displacement *before;   // (n) the last equilibrium
    struct fragments fragments;
    bool *is_gone;  // (n) grains
    bool may_leave; // grains that nothing holds, where a step would take them far
    int n_gone, first_gone;
    struct stiffness *matrix;
    double (*tangent)[STRAINS]; // (n_joint) in the factor
    struct factored *factored;  // (n_joint)
    struct corrections *corrections;
    struct correction *unlike; // (n_joint) that have to be
    double soft[2];            // against shifts and turns
    double largest_load;       // so far: what is left is measured by it
    double enough;             // what may be left
    int iterations;
    int factors, n_load; // since all that speeds things up was forgotten
    bool is_restless;    // no walk in time came to rest under this load: there is none
                         // again as its bonds break
    int n_restless;      // loads under which not all came to rest
    int restless;        // grain that had most left to balance under the last of them
    int n_snap, snapped; // ends of equilibrium gone through in time; the grain that
                         // moved most at the last
    int n_crack, crack_capacity;
    struct dem_crack *crack;
    struct large *large; // NULL: displacements are small
};

struct joint_setup joints_of(const struct equilibrium *equilibrium);

// What there is for each joint, and the matrix, for as many joints as there are now.
void make_room_for_joints(struct equilibrium *equilibrium);
void free_room_for_joints(struct equilibrium *equilibrium);

// The force from outside becomes the load, as far as grains are there and free.
void load_grains(struct equilibrium *equilibrium);
// The largest of it so far, where the grains are at the trial.
void measure_load(struct equilibrium *equilibrium);

// Which grains intact bonds join, and which of these are held.
void find_fragments(struct equilibrium *equilibrium);

// The most overloaded bond breaks, if one is at its strength. Whether one was.
bool break_one(struct equilibrium *equilibrium);

// The strains of joints, as they lie, when grains have MOVED (n).
void strain_joints(const struct equilibrium *equilibrium,
                   const struct displacement *moved, double (*strain)[STRAINS]);

// Steps on the way [balance.c]: strains at the trial, and what is left there; a factor
// as all is there, if there is one; a better trial; the trial becomes the last
// equilibrium, and the reverse.
void strain_trial(struct equilibrium *equilibrium);
void resist(struct equilibrium *equilibrium);
double largest_left(const struct equilibrium *equilibrium);
bool factor(struct equilibrium *equilibrium);
bool improve(struct equilibrium *equilibrium, bool *is_fresh);
// Fragments that are marked leave: their load counts no more, and nothing touches them.
// Those that no support holds do where a grain of theirs moves by more than MOST, of
// MOVES (n), displacements or what is left. Whether any did.
void let_go(struct equilibrium *equilibrium, const bool *leaves);
bool let_go_beyond(struct equilibrium *equilibrium, const struct displacement *moves,
                   double most);
void keep_history(struct equilibrium *equilibrium);
void go_back(struct equilibrium *equilibrium);
// The next equilibrium, from the trial at once or else in steps of time, as the last
// one. Whether there was rest.
bool come_to_rest(struct equilibrium *equilibrium);
int least_balanced(const struct equilibrium *equilibrium); // the first grain of those

// A body that nothing holds [rigid_motion.c]. Displacements at the trial, (n) m, a new
// array; what would move it as one is taken off what is left; and what does is taken
// off STEP (n).
struct vector *displaced(const struct equilibrium *equilibrium);
void take_off_as_one(struct equilibrium *equilibrium);
void stand_still(const struct equilibrium *equilibrium, struct displacement *step);
// The same of small displacements MOVED (n), all of them.
void stand_at_start(const struct equilibrium *equilibrium, struct displacement *moved);
// A MODE (n) without momentum, as what grows by itself is.
void keep_momentum(const struct equilibrium *equilibrium, struct displacement *mode);
#endif
