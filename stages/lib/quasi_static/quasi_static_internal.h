// SPDX-License-Identifier: GPL-3.0-or-later
// Inside struct quasi_static, for the files of this library only. All in its units:
// lengths in mean radii, stiffnesses in the largest of a pair.
#pragma once

#include "contact_solver.h"
#include "geometry/fragments.h"
#include "geometry/net_load.h"
#include "make_contact_pairs.h"
#include "quasi_static.h"
#include "stiffness.h"

#include <math.h>

// How a pair was when the stiffness was factored.
struct factored {
    enum contact_state state;
    bool is_bonded;
};

// Mean radii, and radians: displacements beyond are not small.
static const double SMALL_LIMIT = 0.1;

// A bond breaks from this share of its strength on: rounding and the tolerance leave as
// much open.
static const double FAILURE_THRESHOLD = 1 - 1e-9;

// Rows of the dense systems of contacts that changed. Small displacements with friction
// have another method where there would be more [splitting/splitting.h].
enum { MOST_ROWS = 4000, MOST_ROWS_WITH_FRICTION = 2000 };

// Residuals of many grains add up: where iterations still gain much, they go on to this
// fraction of the tolerance.
static const double TARGET_FRACTION = 1e-3;

struct quasi_static;
struct large_state;

// What depends on whether displacements are small. The two tables differ in these
// functions only: bonds, fragments, loads and the order of events are common.
struct kinematics {
    // Deformation and response of the pairs; subtracts their loads from the residual.
    void (*subtract_internal_loads)(struct quasi_static *);
    bool (*factor)(struct quasi_static *); // false: the tangent has no factor
    // Changes a step that was found, before it is taken; or NULL.
    void (*adjust_step)(struct quasi_static *);
    void (*commit)(struct quasi_static *); // commits what else there is; or NULL
    // Newton's method under the present load and damping. False: not found.
    bool (*solve)(struct quasi_static *);
    // Balances the whole load.
    enum status (*balance)(struct quasi_static *, struct reason *);
};
extern const struct kinematics small_displacements, large_displacements;

// (n): of each grain; (n_pair): of each contact pair. It owns its arrays but those of
// the packing and the forces from outside. `u` is the iterate, `previous` what a step
// begins from; whatever is not committed can be rolled back.
struct quasi_static {
    const struct kinematics *kinematics;
    const struct packing *packing;
    struct quasi_static_setup setup;
    double length, stiffness; // units
    int n, n_pair;
    struct contact_pair *pair;
    // The iterate u, and what belongs to it.
    struct displacement *displacement; // (n) u
    double (*deformation)[COMPONENTS]; // (n_pair) B u
    struct pair_response *response;    // (n_pair)
    struct displacement *residual;     // (n) load - dashpots - B^T response
    struct displacement *previous;     // (n) u of the last equilibrium or step in time
    double (*last_increment)[COMPONENTS]; // (n_pair) of the deformation, up to there
    double *shrinkage; // (n) strain since the start; NULL: nothing shrinks
    // Loads.
    const struct vector *force;         // (n) N, from outside
    struct displacement *load;          // (n) of it what counts
    struct net_load taken_off;          // of the load, where nothing holds the grains
    double largest_load;                // so far: scale of the residual
    double damping;                     // of dashpots, over stiffness times time step
    struct displacement *dashpot_force; // (n) of those at pairs, at a damping of 1
    double grain_dashpot; // of one on each grain, at a damping of 1; 0: none
    // A step of Newton's method.
    struct displacement *step;       // (n)
    double (*increment)[COMPONENTS]; // (n_pair) of the deformation, by the step
    struct displacement *rhs; // (n) residual less what changed contacts carry: K step
    double tolerance_now;     // on the residual
    // The factored stiffness K, and pairs that have changed since.
    struct stiffness *matrix;
    double (*tangent)[COMPONENTS]; // (n_pair) in K
    struct factored *factored;     // (n_pair)
    struct contact_solver *contacts;
    struct pair_rows *changed; // (n_pair) room for a list
    double regularisation[2];  // on the diagonal of K: of translations, of rotations
    double factored_dashpot;   // the same of the grains' dashpots
    // Fragments, and grains that have left.
    struct fragments fragments;
    bool *is_detached; // (n)
    bool may_detach;   // in a step that would take what nothing holds far
    int n_detached, first_detached;
    int iterations;
    int factors, n_load;  // since the cache was dropped
    bool is_breaking;     // a bond has broken under this load
    bool is_unconverged;  // viscous relaxation found no rest under this load: it is not
                          // tried again as bonds break
    int n_unconverged;    // loads under which not all came to rest
    int last_unconverged; // grain with the largest residual under the last of them
    int n_instability;    // how often dynamics led from a limit point to rest
    int last_unstable;    // grain that moved most at the last
    int n_crack, crack_capacity;
    struct dem_crack *crack;
    struct large_state *large;   // NULL: displacements are small
    struct splitting *splitting; // of small displacements; NULL: not needed so far
};

// ---- contact pairs ------------------------------------------------------------------

// From the setup, in the units of the engine.
struct contact_pair_setup pair_setup_of(const struct quasi_static *qs);

// All arrays (n_pair), the matrix and the contact solver, anew and empty.
void allocate_pair_arrays(struct quasi_static *qs);
void free_pair_arrays(struct quasi_static *qs);

// PAIR, made of grains as they were at the start, becomes one of grains that shrank.
void shrink_new_pair(const struct quasi_static *qs, struct contact_pair *pair);

// ---- loads --------------------------------------------------------------------------

// The load becomes the force from outside, on grains that are neither fixed nor
// detached. Where nothing holds the grains their net load is taken off (`taken_off`).
void apply_external_load(struct quasi_static *qs);
// The largest of it so far, where the grains are now.
void update_load_scale(struct quasi_static *qs);

// ---- the iterate --------------------------------------------------------------------

// DEFORMATION (n_pair) when grains have MOVED (n), in the axes the pairs have now.
void deform_pairs(const struct quasi_static *qs, const struct displacement *moved,
                  double (*deformation)[COMPONENTS]);
void update_deformation(struct quasi_static *qs); // of the iterate
// What is added to the diagonal of K: (1 + damping) times it is damping grain_dashpot.
static inline double dashpot_in_stiffness(const struct quasi_static *qs)
{
    return qs->grain_dashpot * qs->damping / (1 + qs->damping);
}
void update_residual(struct quasi_static *qs); // and the deformation
double largest_residual(const struct quasi_static *qs);
double largest_dashpot_load(const struct quasi_static *qs);
int grain_of_largest_residual(const struct quasi_static *qs); // the first such

// The tangent as all pairs are now. False: it has no factor.
bool factor_tangent(struct quasi_static *qs);

// How pair J would be in K if it were factored now; what comes to touch sticks.
static inline struct factored pair_as_factored(const struct quasi_static *qs, int j)
{
    const enum contact_state state = qs->response[j].contact.state;
    return (struct factored){state == CONTACT_NEW ? CONTACT_STICKING : state,
                             qs->pair[j].is_bonded && !qs->pair[j].is_detached};
}

// A step of Newton's method, or, where none is found, a new factor, unless IS FRESH
// says that it is new. False: neither helps.
bool newton_step(struct quasi_static *qs, bool *is_fresh);

// Small displacements and no friction: contacts are open or closed, without history.
static inline bool is_frictionless(const struct quasi_static *qs)
{
    return !qs->setup.large_displacements && !(qs->setup.material.friction > 0);
}

// A step of it without friction, where many contacts change, with the tangent as pairs
// are before it. False: it leads nowhere, or there is friction or damping.
bool frictionless_step(struct quasi_static *qs);

// The iterate becomes the last equilibrium, with the history of its contacts; and back.
// Committing also moves the anchors of contacts that slipped.
void commit_state(struct quasi_static *qs);
void roll_back_state(struct quasi_static *qs);

// Commits an equilibrium, unless small displacements are not small in it: then it only
// shows which bond breaks or what leaves, and the next begins where this one began.
void commit_equilibrium(struct quasi_static *qs);

// Whether the splitting is there for contacts that slip [splitting/splitting.h].
static inline bool has_splitting(const struct quasi_static *qs)
{
    return !qs->setup.large_displacements && qs->setup.material.friction > 0;
}

// The next equilibrium: by Newton's method, else by viscous relaxation from the last
// one. False: it did not come to rest.
bool relax_to_equilibrium(struct quasi_static *qs);

// The same by viscous relaxation alone, with as many rows as there may be: where the
// splitting finds no step either. On false the iterate is the last step that was found,
// so that grains have gone at least some of the way.
bool relax_with_most_rows(struct quasi_static *qs);

// ---- bonds and fragments ------------------------------------------------------------

// Breaks the most overloaded bond, the first of equals. False: none is at its strength.
// One at a time, because each break shifts its load to others. The crack is recorded.
bool break_most_overloaded(struct quasi_static *qs);

// Which grains intact bonds join, and which of these fragments are held.
void update_fragments(struct quasi_static *qs);

// Fragments that LEAVE (n, by their first grain) have no load any more, and nothing
// touches them.
void detach_fragments(struct quasi_static *qs, const bool *leave);
// Those that nothing holds, where one of their MOVES (n), displacements or residuals,
// is larger than LIMIT. False: there is none.
bool detach_beyond(struct quasi_static *qs, const struct displacement *moves,
                   double limit);
// Takes the step off grains that have left: nothing but the regularisation holds these,
// so that rounding would take them any distance.
void leave_detached_grains(struct quasi_static *qs);

// ---- a body that nothing holds [rigid_motion.c] -------------------------------------

// Displacements of the iterate, (n) m, a new array.
struct vector *displacements_in_metres(const struct quasi_static *qs);
// Takes net force and moment off the residual.
void project_rigid_load(struct quasi_static *qs);
// Takes rigid motion off STEP (n) from the iterate on; off small displacements MOVED
// (n) from the start on; and what momentum a MODE (n) has off that.
void remove_rigid_motion(const struct quasi_static *qs, struct displacement *step);
void remove_small_rigid_motion(const struct quasi_static *qs,
                               struct displacement *moved);
void remove_momentum(const struct quasi_static *qs, struct displacement *mode);
