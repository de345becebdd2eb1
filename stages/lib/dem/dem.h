// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete elements [K 4]: spherical grains, in space or in a plane, with linear [K
// 4.22], timed [G 2] or Hertz-Mindlin [K 4.23] contacts, Coulomb slip [K 4.25-4.26],
// contact dashpots [K 4.27-4.30], breakable contact and parallel bonds [K 4.31-4.44]
// and walls that may move, integrated by leapfrog [K 4.1-4.6].
//
// SI outside. Inside, lengths are in mean radii, masses in mean grain masses and
// stiffnesses in the largest pair stiffness, and every grain is followed by its
// displacement from where it began. So scenes of equal dimensionless numbers give equal
// digits, and an overlap of 1e-9 radii keeps all of its own. The results are the same
// bytes for any number of threads, with AVX2 and with AVX-512.
//
// Only what the scene needs is computed: without friction and bonds grains do not
// rotate and keep no shear history, and with one radius and one material all pairs
// share their coefficients (pair_kernel.h). How to use it: fill a dem_setup (zeros are
// sensible where a member says so), dem_create, set forces or velocities, dem_run as
// often as needed, look at the state between runs, dem_free. Every function that looks
// takes O(n_particle) or O(pairs) and changes nothing. Arrays of grains are in the
// order of the packing, whatever order the engine keeps inside.
//
// One engine belongs to one thread of the caller; it uses setup.threads itself. There
// are no globals, so several engines may run side by side.
//
// The least that a program needs:
//     struct dem_wall bottom = {.shape = DEM_PLANE, .normal = {0, 0, 1}};
//     struct dem_setup setup = {.packing = &packing,
//                               .n_wall = 1,
//                               .wall = &bottom,
//                               .law = DEM_LINEAR,
//                               .material = {.density = 2500,
//                                            .normal_stiffness = 1e5,
//                                            .shear_stiffness = 1e5,
//                                            .friction = 0.5,
//                                            .damping_ratio = 0.2},
//                               .gravity = {0, 0, -9.81},
//                               .time_step_safety = NAN,
//                               .threads = 1};
//     struct dem *dem;
//     struct reason reason;
//     enum status status = dem_create(&dem, &setup, &reason);
//     if (!status) status = dem_run_until(dem, 1e-4, 1000000, &reason);
//     if (!status) dem_positions(dem, position);
//     dem_free(dem);
#pragma once

#include "basics/status.h"
#include "bridges/bridges.h"
#include "checkpoint/named_arrays.h"
#include "geometry/packing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// How the force between two grains follows from overlap and velocity. One law for all
// pairs.
enum dem_law {
    DEM_LINEAR, // stiffness and damping ratio [K 4.22, 4.27-4.30]
    DEM_TIMED,  // linear, by contact time and restitution [G 2], for any two grains
    DEM_HERTZ   // Hertz-Mindlin [K 4.23], damped to a restitution for any speed
};

// Material of grains or walls. Which members count depends on the law.
struct dem_material {
    double density; // kg/m3, > 0
    // Linear: N/m of a grain, >= 0; two in series make a contact [K 4.22].
    double normal_stiffness;
    double shear_stiffness;
    double friction;      // >= 0; the smaller of two counts [K 4.25]
    double damping_ratio; // linear: zeta of [K 4.28], >= 0
    // Local damping: each component of the net force and moment on a grain is made
    // smaller by this share of itself while the grain moves with it, and larger while
    // it moves against it. So whatever oscillates comes to rest, rolling included,
    // which dashpots do not see. Not physical: for statics. In [0,1). That of the first
    // material counts for all.
    double local_damping;
    double contact_time;  // timed: s, > 0; that of the first material counts for all
    double restitution;   // timed, Hertz: in (0,1]; the smaller of two counts
    double young_modulus; // Hertz: Pa, > 0
    double poisson_ratio; // Hertz: in [0,0.5]
    // Rolling resistance of type C (Ai et al. 2011) [rolling.c], not with bonds.
    // Rolling friction: >= 0, the largest moment over effective radius and normal
    // force; the smaller of two counts. Damping: share of the critical one, >= 0; the
    // mean of two.
    double rolling_friction, rolling_damping;
};

enum dem_bond_kind {
    DEM_PARALLEL_BOND, // a cylinder of glue: carries moments [K 4.31-4.44]
    DEM_CONTACT_BOND   // a point of glue: the contact's own springs also in tension, no
                       // slip, until one strength is reached [K 4.2]; linear laws only
};

// A contact bond uses normal_strength and shear_strength only.
struct dem_bond_material {
    double normal_stiffness; // parallel: N/m3, >= 0
    double shear_stiffness;  // parallel: N/m3, >= 0
    double normal_strength;  // parallel: Pa, contact: N; >= 0; INFINITY never breaks
    double shear_strength;   // the same
    double radius_fraction;  // parallel: bond radius over the smaller grain's, in (0,1]
    // Parallel: stresses count bending and twist times beta = 1 - this (the moment-
    // contribution factor of later versions of PFC); 0: whole, as [K 4.41, 4.42].
    double moments_left_out;
    enum dem_bond_kind kind;
};

// Liquid bridges between grains [G 2]: one forms where two grains touch and lasts until
// it ruptures, with any model at the distance of [G 2]. So do those to walls, if the
// liquid wets them, at the same contact angle [liquid.c has how round walls count].
struct dem_liquid {
    enum bridge_model model; // not BRIDGE_EXACT; BRIDGE_TABLE is as good and takes
                             // seconds to make [bridges/ratios.h]
    double surface_tension;  // N/m, > 0
    double contact_angle;    // rad, in [0,pi)
    double volume;           // m3, > 0: of each bridge [G 4.1], or on each grain
    bool shared;           // each grain divides its own volume evenly among its bridges
    bool pulls_in_contact; // false: only apart [G 4]; true: also in overlap, as at 0
    bool wets_walls;       // bridges to walls too; round ones must be wider than grains
};

enum dem_wall_shape {
    DEM_PLANE,    // a half space: grains stay on the side NORMAL points to
    DEM_CYLINDER, // endless, about the axis through POINT along NORMAL
    DEM_SPHERE,   // about POINT
    DEM_RING,     // a thin flat ring about POINT, normal to NORMAL; without an inner
                  // radius a disc
    DEM_BLOCK     // a solid box about POINT with edges along x, y and z
};

// A rigid wall. A grain touches it with its own stiffness (in series with an infinite
// one) and the friction of the grains, unless the wall says otherwise. Walls push
// grains and are not pushed, but for servos. Grains may overlap several; each counts by
// itself.
struct dem_wall {
    const char *name;     // for messages, static or of who calls; NULL: its number
    struct vector point;  // m
    struct vector normal; // any length but zero; not for spheres and blocks
    enum dem_wall_shape shape;
    bool outside; // cylinder, sphere: grains are outside of it, otherwise inside
    double radius;
    double inner_radius;     // ring
    struct vector half_edge; // block
    double friction;         // used if has_friction
    bool has_friction;       // of its own
    bool elastic;            // of MATERIAL; otherwise rigid
    int material;
    struct vector velocity;     // m/s
    struct vector spin;         // rad/s about POINT; what would not leave the shape
                                // where it is does not count
    double servo_force;         // N; > 0: moves along its normal until the grains push
                                // it with this much; planes only
    double servo_largest_speed; // m/s, > 0 with a servo
};

// A group of grains that moves as a rigid body whatever forces act on it: at a given
// velocity, turning about an axis through a point that moves along. Its contacts, bonds
// and bridges with other grains and walls act on those; contacts and bridges between
// two driven grains are left out, and gravity and external forces on driven grains
// count for nothing.
struct dem_group {
    struct vector point;    // m
    struct vector axis;     // any length; 0: it does not turn
    struct vector velocity; // m/s
    double spin;            // rad/s, counter-clockwise seen against the axis
};

// Setup of dem_create. It is copied: the caller may free it afterwards. Members that
// are not set are 0 or NULL, which is the usual choice of most; time_step_safety must
// be NAN or above 0, unless time_step is given.
struct dem_setup {
    const struct packing *packing; // with the bonds listed in it
    enum dem_law law;
    struct dem_material material; // number 0
    int n_other;                  // materials 1 to n_other
    const struct dem_material *other;
    const uint8_t *material_of; // (n_particle) NULL: 0
    // (n_other+1)^2, symmetric, for pairs of materials; NULL: the smaller of the two
    const double *pair_friction, *pair_restitution, *pair_rolling_friction;
    struct dem_bond_material bond;
    // (n_bond) NULL: those of `bond`
    const double *normal_strength, *shear_strength;
    const struct dem_liquid *liquid; // NULL: dry
    // J/m2, of dry Hertz contacts, also with walls [adhesion.c]; 0: none. Friction is
    // limited by the Hertz spring, so by what presses and what adhesion adds to it.
    double adhesion;
    const uint8_t *fixed; // (n_particle) 1: neither moves nor turns; NULL: none
    int n_group;          // at most 255
    const struct dem_group *group; // (n_group)
    const uint8_t *group_of;       // (n_particle) 1 + its group, 0: of none; NULL: none
    int n_wall;
    const struct dem_wall *wall; // (n_wall)
    struct vector gravity;       // m/s2
    // For statics: every grain gets the inertia of the mean one, so that small grains
    // do not shorten the time step. Weights stay what they are.
    bool density_scaling;
    // Time step over the critical one of [K 4.47], > 0; NAN: half the stability limit
    // (stability.c), of the pairs at the start and of all found later. The stiffness of
    // Hertz contacts is taken at an overlap of LARGEST_OVERLAP mean radii.
    double time_step_safety;
    double automatic_share; // with NAN: this share, in (0,1), in place of half; 0: half
    double time_step;       // s; > 0: this and not the safety decides
    // What the program calls time_step_safety, static, for messages; NULL: it has none,
    // but time_step
    const char *safety_key;
    double largest_overlap; // Hertz: expected, over the mean radius; 0: 0.01
    bool force_time_step;   // run even past the stability limit
    // Grains that overlap at the start, or a plane, cylinder or sphere, do so at rest:
    // only what they come closer pushes (the reference gap of PFC).
    bool unstressed;
    // Friction is limited by the whole normal force while that pushes, dashpot
    // included, as in LIGGGHTS; otherwise by that of the spring [K 4.25].
    bool friction_feels_dashpot;
    // Dashpots never pull: the normal force of a contact that no bond holds is never
    // below 0 [G 3]. Grains then rebound faster.
    bool no_tensile_damping;
    bool balance_energy; // keep the ledger that dem_energy reports
    bool shrinks;        // dem_set_shrinkage will be called
    int threads;         // >= 1; used where there is enough to share
};

// Which strength of a bond was reached first: tension and bending, or shear and twist
// [K 4.41, 4.42].
enum dem_crack_mode { DEM_CRACK_NORMAL = 0, DEM_CRACK_SHEAR = 1 };

// A bond that broke. Its grains may touch later, as others do; it does not heal.
struct dem_crack {
    int32_t bond;           // as numbered in the packing
    uint8_t mode;           // enum dem_crack_mode
    int64_t cycle;          // cycles completed when it broke
    double time;            // s, in those cycles; of explicit time steps only
    struct vector position; // m, the contact point
};

// A pair that touches, is bonded or has a liquid bridge, as it was in the last cycle.
struct dem_contact {
    int32_t particle[2]; // lower first; the second is -1-w for wall w
    int32_t bond;        // the intact bond between them, or -1
    double overlap;      // m, < 0 apart
    struct vector force; // N, F_ij of [K 4.10] with bond, dashpots and bridge: the
                         // second grain feels it, the first its opposite; along n_ij in
                         // compression
    struct vector position; // m, the contact point [K 4.9]
    double bridge_volume;   // m3, 0: no bridge between them
    double bridge_force;    // N, > 0 when it pulls; part of FORCE; or of adhesion
};

// Energies, J. Balance: kinetic + elastic + lost = initial + gained.
struct dem_energy {
    double kinetic; // J, translation and rotation; without driven groups
    double elastic; // J, contacts and bonds
    // Since the start, J; 0 unless balance_energy.
    double gained; // work of gravity, of external forces, of walls and groups that
                   // move, and of rescaling
    double dashpots, slip, local_damping; // lost
    double broken;                        // elastic energy of bonds when they broke
    double bridges; // that liquid bridges took up, and lost when they ruptured; or
                    // adhesion
};

// Of the grains that are not driven.
struct dem_momentum {
    struct vector linear;  // kg m/s
    struct vector angular; // kg m2/s about the origin of the first positions;
                           // meaningless when the box repeats
};

struct dem;

// Starts at rest. Overlaps in the packing push from the start, unless UNSTRESSED, but
// those of the rounding of coordinates count as touching; bonds are stress free as they
// lie. On success *RESULT is the caller's to free with dem_free; otherwise it is NULL.
// STATUS_BAD_DATA: a physically impossible number, coincident bonded grains, a bond
// between grains that do not exist or listed twice, or a periodic box too narrow for
// one image of each pair. STATUS_NOT_CONVERGED: the time step is past the stability
// limit.
enum status dem_create(struct dem **result, const struct dem_setup *setup,
                       struct reason *reason);
// NULL is allowed.
void dem_free(struct dem *dem);

// External force on every grain from the next cycle on, (n_particle) N; gravity comes
// on top. FORCE is copied. Driven groups do not feel it. O(n_particle). Until the first
// call none acts.
void dem_set_force(struct dem *dem, const struct vector *force);

// Velocities (n_particle) m/s and angular velocities (n_particle) rad/s, of half a step
// before now; NULL leaves them.
void dem_set_velocity(struct dem *dem, const struct vector *velocity,
                      const struct vector *spin);

// Takes all motion from the grains that WHICH (n_particle) marks. Their shear histories
// stay: contacts keep the force that they carry. Velocities and spins become 0, forces
// act on from the next cycle.
void dem_stop(struct dem *dem, const bool *which);

// These count from the next cycle on: m/s2 of gravity, m/s and rad/s of walls and
// groups. WALL and GROUP count as in the setup.
void dem_set_gravity(struct dem *dem, struct vector gravity);
void dem_set_wall_motion(struct dem *dem, int wall, struct vector velocity,
                         struct vector spin);
void dem_set_servo(struct dem *dem, int wall, double force); // N; 0 stops it
// SPIN counts only where the group has an axis.
void dem_set_group_motion(struct dem *dem, int group, struct vector velocity,
                          double spin);
// Friction of material 0, and so of all grains when pairs share their coefficients.
// FRICTION >= 0; shear forces above the new limit slip in the next cycle. SHARE is in
// [0,1).
void dem_set_friction(struct dem *dem, double friction);
void dem_set_local_damping(struct dem *dem, double share);

// For statics [relaxation.c]: no grain has less inertia than SHARE of the mean grain's,
// from now on, also when grains grow. If they FALL, weights are in proportion to it, so
// that all fall alike, and in all are what they were; else each has its own. At 0 all
// is as it was.
void dem_set_least_mass(struct dem *dem, double share, bool falls);

// Sets the time step to SHARE, in (0,1), of the stability limit: of grains that touch
// NOW, or of all near each other; and so short that none moves far in one step, at its
// speed or at SPEED (m/s). It stays until the next call, so whoever calls it for NOW
// must do so again as contacts form. O(pairs).
void dem_adapt_time_step(struct dem *dem, double share, bool now, double speed);

// Whether it was set so.
bool dem_step_is_adapted(const struct dem *dem);

// Whether grains turn: friction, rolling resistance or bonds act on some.
bool dem_grains_turn(const struct dem *dem);

// Gives grains more inertia, from now on: of those that touch NOW, or of all near each
// other, to each as much as it takes to need no shorter step than two grains alone need
// that are as light as the lightest, over sqrt(CONTACTS) [relaxation.c]. What an
// earlier call gave is taken back. Velocities stay. O(pairs).
void dem_even_steps(struct dem *dem, double contacts, bool now);

// Inertia of every grain over its mass (n_particle): 1 but for the two above and
// density_scaling.
void dem_inertia_ratios(const struct dem *dem, double *ratio);

// Stretches the box with all centres along x, y and z about its lower corner, and
// scales all radii by GROWTH; densities stay. Velocities and shear forces stay as they
// are. Its work counts as gained, but for contacts with walls, which stay. Returns
// STATUS_OK, or STATUS_BAD_DATA and does nothing with bonds or driven groups, or where
// grains with liquid grow. O(pairs).
enum status dem_rescale(struct dem *dem, const double stretch[3], double growth);
// The same without growth, but the shear springs of contacts between grains feel how
// the strain moves the grains past each other. STATUS_BAD_DATA also where the box would
// be too narrow for one image of each pair.
enum status dem_strain(struct dem *dem, const double stretch[3], struct reason *reason);

// Drying shrinkage of every grain (n_particle): the linear strain, below 1, by which it
// is smaller than at the start; its bonds and contacts follow from the next cycle on
// [shrinkage.c]. Masses stay. Needs setup.shrinks, without which nothing is done; its
// work counts as gained. Not with liquid bridges. O(pairs).
void dem_set_shrinkage(struct dem *dem, const double *shrinkage);
void dem_shrinkage(const struct dem *dem, double *shrinkage); // (n_particle) as it is

// Finds the forces of the start before the first cycle, for those who look at it: until
// then all are 0. Later it does nothing. It changes no run. O(pairs).
void dem_find_forces(struct dem *dem);

// Runs CYCLES time steps. STATUS_NOT_CONVERGED: it diverged and stopped (a grain would
// move a tenth of the mean radius in one step, or a number is not finite); what is
// asked for later is finite but has no meaning. O(CYCLES pairs); pairs are sought again
// only after a grain has moved by half its skin. One call of n cycles and n calls of
// one give the same bytes.
enum status dem_run(struct dem *dem, int64_t cycles, struct reason *reason);

// Runs until dem_unbalanced_ratio is below TOLERANCE, which is looked at every 16
// cycles. STATUS_NOT_CONVERGED: diverged, or MAX_CYCLES were not enough. DEM has the
// state at which it stopped, in either case.
enum status dem_run_until(struct dem *dem, double tolerance, int64_t max_cycles,
                          struct reason *reason);

int64_t dem_cycle(const struct dem *dem);    // cycles completed
double dem_time(const struct dem *dem);      // s, in those cycles
double dem_time_step(const struct dem *dem); // s
// Stability limit of the step, s, for the pairs near each other at the start
// (stability.c). Grains that gather more neighbours later may need less:
// dem_time_step_limit_now looks at the pairs of the moment, in O(pairs).
double dem_time_step_limit(const struct dem *dem);
double dem_time_step_limit_now(const struct dem *dem);

// Unbalanced ratio [K 4.20]: mean |F_i| over the grains that are not fixed, over mean
// |F_ij| over the contacts; 0 when no net force acts, infinite when no contact carries
// any. O(pairs).
double dem_unbalanced_ratio(const struct dem *dem);
// J. O(pairs).
struct dem_energy dem_energy(const struct dem *dem);

// A liquid bridge as it was in the last cycle.
struct dem_bridge {
    int32_t particle[2]; // lower first; the second is -1-w for wall w
    double volume;       // m3
    double separation;   // m, < 0 in overlap
    double force;        // N, > 0 when it pulls
};
// All bridges, by first, then second grain, walls before grains; a new array of *COUNT
// that the caller frees.
struct dem_bridge *dem_bridges(const struct dem *dem, int *count);
// Velocities half a step before now. O(n_particle).
struct dem_momentum dem_momentum(const struct dem *dem);

// Contacts in the last cycle, and the stress that grains and walls put on each other.
// O(pairs).
struct dem_census {
    int contacts;                         // touching or bonded
    double mean_overlap, largest_overlap; // of grains, over the mean radius
    double wall_overlap;                  // largest of grains with walls, likewise
    int deepest_wall;                     // the wall where it is, or -1
    double stress[3][3];                  // Pa, compression > 0, over the volume of the
                                          // box; of contacts, bonds and liquid bridges
};
struct dem_census dem_census(const struct dem *dem);

// Load of the grains on a wall in the last cycle: force and moment about its POINT; and
// the displacement of its POINT, m; and its work on the grains since the start, J, 0
// unless balance_energy. SI: N, N m, m, J. The load of the wall on the grains is the
// opposite.
struct dem_wall_state {
    struct vector force, moment, displacement;
    double work;
};
struct dem_wall_state dem_wall_state(const struct dem *dem, int wall);

// Load of all that is not of the group (grains, walls, bridges) on a group in the last
// cycle: force and moment about its point; and how far it has moved, m, and turned,
// rad; and its work as that of walls. O(n_particle). GROUP counts as in the setup, from
// 0.
struct dem_group_state {
    struct vector force, moment, displacement;
    double angle, work;
};
struct dem_group_state dem_group_state(const struct dem *dem, int group);

// The grain that overlaps WALL most, as all lie now, or -1 without grains; and by how
// much, over its radius, < 0 apart. O(n_particle).
int dem_deepest_in_wall(const struct dem *dem, int wall, double *overlap);

// The state, written into arrays of n_particle vectors: m, m, m/s, rad/s. Positions are
// not brought back into a box that repeats. Displacements are from the last rescaling.
// Velocities and spins are those of half a step before the positions.
void dem_positions(const struct dem *dem, struct vector *position);
void dem_displacements(const struct dem *dem, struct vector *displacement);
void dem_velocities(const struct dem *dem, struct vector *velocity);
void dem_spins(const struct dem *dem, struct vector *spin);
// Velocities of the time of the positions, m/s, by the last forces: exact where these
// last.
void dem_velocities_at_places(const struct dem *dem, struct vector *velocity);
void dem_radii(const struct dem *dem, double *radius);                           // m
void dem_box(const struct dem *dem, struct vector *lower, struct vector *upper); // m

// Net force, N, and moment about the centre, N m, on every grain (n_particle) in the
// last cycle, from outside too but for driven grains.
void dem_loads(const struct dem *dem, struct vector *force, struct vector *moment);

// The contacts by first, then second grain, then those with walls; a new array of
// *COUNT that the caller frees. Never NULL, also for none.
struct dem_contact *dem_contacts(const struct dem *dem, int *count);

// Into an array of n_bond: 1 intact, 0 broken.
void dem_bonds_intact(const struct dem *dem, uint8_t *intact);

// Every crack so far, by cycle, then by bond. The engine's, until the next dem_run.
const struct dem_crack *dem_cracks(const struct dem *dem, int *count);

// ---- restart ------------------------------------------------------------------------
// The whole state as named arrays, so that an engine created from the same setup and
// given them goes on to the same bytes as one that never stopped [restart.c]. A new
// list of *COUNT arrays, to be freed with free_arrays. Numbers in scaled units: they
// are for dem_restore, not for reading.
struct named_array *dem_save(const struct dem *dem, int *count);
// STATUS_BAD_DATA: arrays that are not those of such an engine; the engine must then be
// freed.
enum status dem_restore(struct dem *dem, const struct named_array *array, int count,
                        struct reason *reason);
