// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.h"

#define AT(member) offsetof(struct pack_parameters, member)

const struct parameter pack_table[] = {
    {"method", PARAMETER_CHOICE, "1", "\"cubic\"", BOUND_NONE, 0, 0,
     "square|cubic|bcc|fcc|hexagonal|honeycomb|poisson|random_sequential|inward_spiral|"
     "deposition|radius_expansion|domain_contraction|explosive_repulsion|import",
     "lattice of touching grains (square: one layer in x and z; hexagonal: close "
     "packing, or the triangular layer where dimensions=2; honeycomb: layers of "
     "hexagonal rings in x and z, one on the other, whose network has 8 throats a node "
     "[K Fig. 2.3]); poisson: random points, "
     "grains may overlap; random_sequential: random points, refused where grains would "
     "overlap; inward_spiral: a layer of grains from the walls inwards, each touching "
     "two others [K 3.1.2]; by moving grains [K 3.1.1]: deposition by gravity, "
     "radius_expansion and domain_contraction from loose points, explosive_repulsion "
     "of "
     "overlapping ones (drawn, or from INPUT); import: grains from INPUT",
     AT(method)},
    {"dimensions", PARAMETER_INTEGER, "1", "3", BOUND_BETWEEN, 2, 3, NULL,
     "2: all centres in one plane y, in a box one largest diameter thick (square and "
     "inward_spiral always; import: the extra layer is one row)",
     AT(dimensions)},
    {"counts", PARAMETER_COUNTS, "1", "[5,5,10]", BOUND_BETWEEN, 1, 1e6, NULL,
     "unit cells along x, y and z of a lattice (square, cubic: grains); not used where "
     "upper or domain.shape says what to fill",
     AT(counts)},
    {"count", PARAMETER_INTEGER, "1", "null", BOUND_BETWEEN, 1, 1e8, NULL,
     "how many grains; null: until no more fit (random_sequential: in the order "
     "drawn), "
     "or, where grains move, as many as the box takes at the porosity expected",
     AT(count)},
    {"radius", PARAMETER_NUMBER, "m", "250e-9", BOUND_ABOVE, 0, 0, NULL,
     "grain radius; mean of normal and lognormal sizes before their ends are cut off; "
     "first of two_mode",
     AT(sizes.radius)},
    {"sizes.distribution", PARAMETER_CHOICE, "1", "\"one\"", BOUND_NONE, 0, 0,
     "one|uniform|normal|lognormal|power|two_mode|sieve",
     "of the radii; a lattice has one", AT(sizes.distribution)},
    {"sizes.by", PARAMETER_CHOICE, "1", "\"number\"", BOUND_NONE, 0, 0, "number|mass",
     "what the distribution gives shares of; by mass, grains are as many as mass over "
     "r^3",
     AT(sizes.by)},
    {"sizes.smallest", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "smallest radius, for uniform and power; normal, lognormal: nothing below; null: "
     "a "
     "tenth of radius, or five standard deviations of ln r",
     AT(sizes.smallest)},
    {"sizes.largest", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "largest radius, for uniform and power; normal, lognormal: nothing above; null: "
     "five standard deviations (of ln r)",
     AT(sizes.largest)},
    {"sizes.spread", PARAMETER_NUMBER, "1", "0.1", BOUND_BETWEEN, 1e-6, 10, NULL,
     "standard deviation of normal and lognormal sizes, of their mean",
     AT(sizes.spread)},
    {"sizes.exponent", PARAMETER_NUMBER, "1", "2", BOUND_BETWEEN, -20, 20, NULL,
     "power: density falls as r to minus this", AT(sizes.exponent)},
    {"sizes.second_radius", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "other radius of two_mode", AT(sizes.second_radius)},
    {"sizes.second_share", PARAMETER_NUMBER, "1", "0.5", BOUND_BETWEEN, 0, 1, NULL,
     "share of the grains of second_radius", AT(sizes.second_share)},
    {"sizes.sieve.radii", PARAMETER_LIST, "m", "[]", BOUND_ABOVE, 0, 0, NULL,
     "radii of a sieve curve (half the openings), rising", AT(sizes.sieve_radii)},
    {"sizes.sieve.passing", PARAMETER_LIST, "1", "[]", BOUND_BETWEEN, 0, 1, NULL,
     "share of what is finer than each, from 0 to 1; linear in r in between",
     AT(sizes.sieve_passing)},
    {"seed", PARAMETER_INTEGER, "1", "1", BOUND_BETWEEN, 1, 4294967295, NULL,
     "of the random numbers (mt19937): sizes and places", AT(seed)},
    {"periodic", PARAMETER_FLAGS, "1", "[false,false,false]", BOUND_NONE, 0, 0, NULL,
     "whether the box repeats along x, y and z (imported packing.h5 or LAMMPS dump: as "
     "it says)",
     AT(domain.periodic)},
    {"lower", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "lower corner of the box; null: the origin (import: around the grains, or as "
     "INPUT "
     "says)",
     AT(domain.lower)},
    {"upper", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "upper corner of the box; null: as counts say, for a lattice; where grains move, "
     "a cube for the count at the porosity expected (import: as for lower)",
     AT(domain.upper)},
    {"domain.shape", PARAMETER_CHOICE, "1", "\"box\"", BOUND_NONE, 0, 0,
     "box|cylinder|ring|sphere",
     "what the grains lie in, wholly; cylinder and ring stand along z; dimensions=2: "
     "box "
     "or sphere (a disc)",
     AT(domain.shape)},
    {"domain.centre", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "of a cylinder, ring or sphere; null: so that its box begins at the origin",
     AT(domain.centre)},
    {"domain.radius", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "of a cylinder, ring (outer) or sphere", AT(domain.radius)},
    {"domain.inner_radius", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "of a ring", AT(domain.inner_radius)},
    {"domain.height", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "of a cylinder or ring", AT(domain.height)},
    {"domain.cut.shape", PARAMETER_CHOICE, "1", "\"none\"", BOUND_NONE, 0, 0,
     "none|box|cylinder|sphere", "what is cut out of it; must lie wholly inside",
     AT(domain.cut)},
    {"domain.cut.centre", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "of a cylinder or sphere cut out; null: that of the domain",
     AT(domain.cut_centre)},
    {"domain.cut.radius", PARAMETER_NUMBER, "m", "null", BOUND_ABOVE, 0, 0, NULL,
     "of a cylinder or sphere cut out", AT(domain.cut_radius)},
    {"domain.cut.lower", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "lower corner of a box cut out; of a cylinder, z counts; null: right through",
     AT(domain.cut_lower)},
    {"domain.cut.upper", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "upper corner, likewise", AT(domain.cut_upper)},
    {"target", PARAMETER_CHOICE, "1", "\"settled\"", BOUND_NONE, 0, 0,
     "settled|porosity|coordination|pressure",
     "where moving grains end, at rest: as they lie (compressed: jammed, at "
     "dynamics.overlap), or at target_value of porosity, of contacts a grain "
     "(rattlers left out) or of mean stress in Pa; deposition and explosive_repulsion "
     "settle",
     AT(dynamics.target)},
    {"target_value", PARAMETER_NUMBER, "1", "null", BOUND_ABOVE, 0, 0, NULL,
     "of the target; null: none, for settled", AT(dynamics.value)},
    {"dynamics.density", PARAMETER_NUMBER, "kg/m3", "2500", BOUND_ABOVE, 0, 0, NULL,
     "of the grains", AT(dynamics.density)},
    {"dynamics.friction", PARAMETER_NUMBER, "1", "0.5", BOUND_BETWEEN, 0, 100, NULL,
     "between grains", AT(dynamics.friction)},
    {"dynamics.wall_friction", PARAMETER_NUMBER, "1", "null", BOUND_BETWEEN, 0, 100,
     NULL, "at walls; null: as between grains", AT(dynamics.wall_friction)},
    {"dynamics.stiffness", PARAMETER_NUMBER, "N/m", "null", BOUND_ABOVE, 0, 0, NULL,
     "normal, of a grain [K 4.22]; null: such that dynamics.overlap comes out",
     AT(dynamics.stiffness)},
    {"dynamics.overlap", PARAMETER_NUMBER, "1", "1e-3", BOUND_BETWEEN, 1e-9, 0.05, NULL,
     "typical of contacts at the end: on the floor over the radius (deposition); "
     "stress "
     "over stiffness and diameter (compressed, jammed)",
     AT(dynamics.overlap)},
    {"dynamics.shear_ratio", PARAMETER_NUMBER, "1", "0.2857142857142857", BOUND_BETWEEN,
     0, 1, NULL, "shear over normal stiffness", AT(dynamics.shear_ratio)},
    {"dynamics.damping", PARAMETER_NUMBER, "1", "0.2", BOUND_BETWEEN, 0, 2, NULL,
     "ratio of the contacts' dashpots [K 4.28]", AT(dynamics.damping)},
    {"dynamics.local_damping", PARAMETER_NUMBER, "1", "0.3", BOUND_BETWEEN, 0, 0.9,
     NULL,
     "share by which forces weaken that push a grain the way it moves, so that all "
     "comes to rest",
     AT(dynamics.local_damping)},
    {"dynamics.gravity", PARAMETER_NUMBER, "m/s2", "9.81", BOUND_ABOVE, 0, 0, NULL,
     "downwards along z, in deposition", AT(dynamics.gravity)},
    {"dynamics.time_step_safety", PARAMETER_NUMBER, "1", "0.1", BOUND_BETWEEN, 1e-6, 1,
     NULL, "time step over the critical one [K 4.47]", AT(dynamics.safety)},
    {"dynamics.tolerance", PARAMETER_NUMBER, "1", "1e-4", BOUND_BETWEEN, 1e-12, 1, NULL,
     "unbalanced ratio at rest [K 4.20]", AT(dynamics.tolerance)},
    {"dynamics.most_cycles", PARAMETER_INTEGER, "1", "3000000", BOUND_BETWEEN, 1, 1e12,
     NULL, "gives up after as many time steps", AT(dynamics.most_cycles)},
    {"most_trials", PARAMETER_INTEGER, "1", "100000", BOUND_BETWEEN, 1, 1e12, NULL,
     "random_sequential gives up after as many places in a row for one grain",
     AT(most_trials)},
    {"densify", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "inward_spiral: fill voids with grains that touch three others, down to "
     "sizes.smallest",
     AT(densify)},
    {"extra_layer", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "lay a regular layer of grains of the mean radius on the outermost grain of "
     "extra_side, across the box, for the boundary layer [K 3.3.5]; they come last, "
     "without bonds, and the box ends on them",
     AT(extra_layer)},
    {"extra_side", PARAMETER_CHOICE, "1", "\"+z\"", BOUND_NONE, 0, 0,
     "-x|+x|-y|+y|-z|+z", "flat side of the box that the extra layer is at",
     AT(extra_side)},
    {"frame", PARAMETER_INTEGER, "1", "-1", BOUND_BETWEEN, -1, 1e12, NULL,
     "of an imported LAMMPS dump, from 0; -1: the last", AT(frame)},
    {"bonds", PARAMETER_CHOICE, "1", "\"touching\"", BOUND_NONE, 0, 0,
     "none|touching|keep",
     "which grains are bonded; keep: as an imported packing.h5 says", AT(bonds)},
    {"touching_gap", PARAMETER_NUMBER, "1", "1e-6", BOUND_BETWEEN, 0, 1, NULL,
     "surfaces this close touch, of the sum of the two radii", AT(touching_gap)},
    {0}};
