// SPDX-License-Identifier: GPL-3.0-or-later
// Packings by moving grains [K 3.1.1]: what the methods share.
#pragma once

#include "basics/progress.h"
#include "checkpoint/keeper.h"
#include "dem/dem.h"
#include "domain.h"
#include "geometry/packing.h"
#include "sizes.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>
#include <stdint.h>

// The state at which a method ends.
enum target {
    TARGET_SETTLED,      // at rest
    TARGET_POROSITY,     // of the domain
    TARGET_COORDINATION, // mean number of contacts of a grain that is no rattler
    TARGET_PRESSURE      // mean stress, Pa
};

// The user's parameters of grains and target; NAN where not given.
struct dynamics_parameters {
    double density;       // kg/m3
    double friction;      // between grains
    double wall_friction; // null: the same
    double stiffness;     // N/m of a grain; null: so that `overlap` comes out
    double overlap;       // typical overlap at the end, over the radius
    double shear_ratio;   // shear over normal stiffness
    double damping;       // of the dashpots: damping ratio [K 4.28]
    double local_damping; // share of the net force and moment (dem/dem.h)
    double gravity;       // m/s2, downwards
    double safety;        // of the time step [K 4.47]; null: adapted [dynamics.c]
    int target;           // enum target
    double value;         // of it
    double tolerance;     // on the unbalanced ratio [K 4.20] at rest
    int64_t most_cycles;  // after which it has failed: STATUS_NOT_CONVERGED
    int threads;
    const struct keeper *keeper; // of deposition and densification; may be NULL
};

// The state at the end. Written by note_end; zero where nothing moved.
struct reached {
    bool dynamic;            // whether any dynamics was run
    double value;            // of the target
    double unbalanced_ratio; // [K 4.20]
    int64_t cycles;
    double time;          // simulated, s
    double largest_speed; // at the end, m/s
    double pressure;      // mean stress of the grains on each other, Pa
    double growth;        // final radii over those drawn
    double time_step;     // s
    double stiffness;     // that was used, N/m
};

// What a method works on; it owns none of it.
struct making {
    const char *given; // name of the input whose grains are moved; NULL: none
    const struct dynamics_parameters *how;
    const struct sizes *sizes;
    gsl_rng *random;
    struct progress *progress;
    struct domain *domain; // becomes that of the grains at the end
    struct packing *packing;
    struct reached *reached;
};

// The methods. Each makes packing, domain and reached. DOMAIN is given as the user
// wants it; the box may become smaller, or its top that of the highest grain. With
// COUNT 0 they start from the grains in PACKING, which keep their sizes.
// STATUS_NOT_CONVERGED: the target was not reached in most_cycles; the reason has what
// was. On success the caller frees *PACKING.

// COUNT grains dropped into the domain from a loose cloud above it [K Fig. 3.1], until
// they are at rest. The top of the box becomes that of the highest grain; a sphere
// keeps its size, and grains fall from random points within it. STATUS_BAD_DATA if
// given grains overlap by more than a twentieth of their size.
enum status deposit(const struct making *making, int count, struct reason *reason);

// From loose points, by growing radii (GROW) or a contracting box, to the target;
// without one until jammed at the overlap asked for. Contraction needs a box that
// repeats along all axes (in two dimensions x and z). Given grains that have grown get
// their sizes back at the end, by scaling all lengths.
enum status densify(const struct making *making, int count, bool grow,
                    struct reason *reason);

// Overlapping grains at random places that push each other away, in about a hundred
// batches, and then come to rest. STATUS_BAD_DATA if they have more volume than the
// domain.
enum status repel(const struct making *making, int count, struct reason *reason);

// ---- shared by them -----------------------------------------------------------------

enum { MAX_WALLS = 16 };

// The factor by which the grains of PACKING must shrink so that none overlaps another
// or a wall; 1 if none does. Walls of the box only; across the plane of a flat packing
// there are none.
double fitting_size(const struct packing *packing);

// The walls of a domain as the engine knows them, written to WALL; without those that
// close it at the top if OPEN. Returns how many. Where the box repeats there are none,
// nor across the plane of two dimensions. A wall has the friction of its own, if given,
// else that of the grains.
int domain_walls(const struct domain *domain, const struct dynamics_parameters *how,
                 bool open, struct dem_wall wall[MAX_WALLS]);

// Solid volume over the domain's (areas in two dimensions), overlaps counted twice.
double solid_fraction(const struct domain *domain, const struct packing *packing);

// The same of COUNT grains as they will be drawn next. Draws from a copy of the random
// stream, which stays where it is.
double drawn_fraction(const struct making *making, int count);

// An engine on the packing, between WALLS; STIFFNESS in N/m. SAFETY: of the time step
// [K 4.47]; NAN: the step is adapted (dem_step_is_adapted), and under gravity no grain
// has less inertia than the mean one, nor, until land_grains, less weight, unless radii
// are wide; the caller calls adapt_step every few hundred cycles. It frees *DEM with
// dem_free, also after a failure.
enum status start_dynamics(const struct making *making, double stiffness, double safety,
                           struct vector gravity, const struct dem_wall *wall,
                           int n_wall, struct dem **dem, struct reason *reason);

// Of the time step [K 4.47], for start_dynamics. As the user says, else fixed_safety:
// 0.1; step_safety: 0.1 where radii are very wide and NAN, an adapted step, where they
// are not.
double fixed_safety(const struct making *making);
double step_safety(const struct making *making);

// Adapts the step of DEM to the contacts of now and to grains of SPEED (m/s) or, if
// some are, faster; while grains FALL, to contacts that may form.
void adapt_step(struct dem *dem, bool fall, double speed);

// Gives grains with many contacts more inertia, so that they do not shorten the step:
// by the contacts of now or, while grains FALL, by those that may form. Before
// adapt_step.
void even_steps(struct dem *dem, bool fall);

// Gives grains that have fallen their own weight.
void land_grains(const struct making *making, struct dem *dem);

// Restores the checkpoint of a run like this one, if there is one: the engine's state
// to DEM, the array "protocol" to the COUNT doubles PROTOCOL. STATUS_BAD_DATA: it is
// not of such a run.
enum status restore_dynamics(const struct making *making, struct dem *dem,
                             double *protocol, int count, struct reason *reason);

// Keeps a checkpoint if it is due: the state of DEM and the COUNT doubles PROTOCOL.
void keep_dynamics_if_due(const struct making *making, const struct dem *dem,
                          const double *protocol, int count);

// Copies positions and radii from DEM to the packing, wrapped into a periodic box.
void take_grains(const struct making *making, const struct dem *dem);

// The largest speed of a grain, m/s.
double largest_speed(const struct making *making, const struct dem *dem);

// Mean stress, Pa, over the volume of the domain. A third of the trace (in two
// dimensions half): positive where grains push.
double mean_stress(const struct making *making, const struct dem *dem);

// Mean number of contacts of the grains with enough contacts to be stable: two with
// friction, four without (three in two dimensions). 0 if there are none. Contacts with
// walls do not count.
double backbone_coordination(const struct making *making, const struct dem *dem);

// Fills making->reached from DEM. Adds its cycles and its time to those of earlier
// engines.
void note_end(const struct making *making, const struct dem *dem);
