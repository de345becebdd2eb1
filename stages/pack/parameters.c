// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of pack as one table: names, units, defaults, ranges and texts. Rules
// that relate parameters to each other are checked where they are used (make_domain.c,
// methods.c, sizes.c, check_moved.c), with the key in the reason.
//
// Rows in this order: the method and how many grains; their sizes; the box and the
// domain in it; the end that moving grains are to reach, and their contacts; what some
// methods or all of them do afterwards (trials, voids, slab, extra layer); how INPUT is
// read; the check and the bonds.
//
// null becomes NAN, of `count` 0. What stands in for it depends on the method: the edge
// of a box follows from a count, or a count from a box, and the stiffness from the
// overlap wanted. So no number could stand here.
//
// Traps: a choice is stored as its place in .choices and cast to an enum of the same
// order: method, sizes.distribution and .by, domain.shape and .cut.shape, target,
// check, bonds, and extra_side, which becomes a number of a wall. Methods up to
// honeycomb are lattices. `target_value` has the unit of its target, share, contacts or
// Pa, though the table can say only 1. Threads and the keeper of checkpoints are
// members of `dynamics` too, but come from the command line.
#include "parameters.h"

#define AT(member) offsetof(struct pack_parameters, member)

const struct parameter pack_table[] = {
    {"method", PARAMETER_CHOICE, "1", "\"cubic\"", AT(method),
     .choices = "square|cubic|bcc|fcc|hexagonal|honeycomb|poisson|random_sequential|"
                "inward_spiral|deposition|radius_expansion|domain_contraction|"
                "explosive_repulsion|import|soft_spheres",
     .text = "lattice of touching grains (square: one layer in x and z; hexagonal: "
             "close packing, or the triangular layer where dimensions=2; honeycomb: "
             "layers of hexagonal rings in x and z, one on the other, whose network "
             "has 8 throats a node [K Fig. 2.3]); poisson: random points, grains may "
             "overlap; random_sequential: random points, rejected where grains would "
             "overlap; inward_spiral: a layer of grains from the walls inwards, each "
             "touching two others [K 3.1.2]; by moving grains [K 3.1.1]: deposition by "
             "gravity, radius_expansion and domain_contraction from loose points, "
             "explosive_repulsion of overlapping ones, all of grains drawn or those of "
             "INPUT, which keep their sizes; import: grains of INPUT as they are; "
             "soft_spheres: random points, relaxed until they overlap no more or are "
             "jammed, in a box that may repeat"},
    {"dimensions", PARAMETER_INTEGER, "1", "3", AT(dimensions), BETWEEN(2, 3),
     .text = "2: all centres in one plane y, in a box one largest diameter thick "
             "(square and inward_spiral always; import: the extra layer is one row)"},
    {"counts", PARAMETER_COUNTS, "1", "[5,5,10]", AT(counts), BETWEEN(1, 1e6),
     .text = "unit cells along x, y and z of a lattice (square, cubic: grains); not "
             "used where upper or domain.shape says what to fill"},
    {"count", PARAMETER_INTEGER, "1", "null", AT(count), BETWEEN(1, 1e8),
     .text = "how many grains; null: until no more fit (random_sequential: in the "
             "order drawn), or, where grains move, as many as fit the box at the "
             "porosity expected"},
    {"radius", PARAMETER_NUMBER, "m", "250e-9", AT(sizes.radius), ABOVE(0),
     .text = "grain radius; mean of normal and lognormal sizes before their ends are "
             "cut off; first of two_mode"},
    {"sizes.distribution", PARAMETER_CHOICE, "1", "\"one\"", AT(sizes.distribution),
     .choices = "one|uniform|normal|lognormal|power|two_mode|sieve",
     .text = "of the radii; a lattice has one"},
    {"sizes.by", PARAMETER_CHOICE, "1", "\"number\"", AT(sizes.by),
     .choices = "number|mass",
     .text = "whether the distribution is of the numbers of grains or of their mass"},
    {"sizes.smallest", PARAMETER_NUMBER, "m", "null", AT(sizes.smallest), ABOVE(0),
     .text = "smallest radius, for uniform and power; normal, lognormal: nothing "
             "below; null: a tenth of radius, or five standard deviations of ln r"},
    {"sizes.largest", PARAMETER_NUMBER, "m", "null", AT(sizes.largest), ABOVE(0),
     .text = "largest radius, for uniform and power; normal, lognormal: nothing above; "
             "null: five standard deviations (of ln r)"},
    {"sizes.spread", PARAMETER_NUMBER, "1", "0.1", AT(sizes.spread), BETWEEN(1e-6, 10),
     .text = "standard deviation of normal and lognormal sizes, over their mean"},
    {"sizes.exponent", PARAMETER_NUMBER, "1", "2", AT(sizes.exponent), BETWEEN(-20, 20),
     .text = "power: density falls as r to minus this"},
    {"sizes.second_radius", PARAMETER_NUMBER, "m", "null", AT(sizes.second_radius),
     ABOVE(0), .text = "other radius of two_mode"},
    {"sizes.second_share", PARAMETER_NUMBER, "1", "0.5", AT(sizes.second_share),
     BETWEEN(0, 1), .text = "share of the grains of second_radius"},
    {"sizes.sieve.radii", PARAMETER_LIST, "m", "[]", AT(sizes.sieve_radii), ABOVE(0),
     .text = "radii of a sieve curve (half the openings), rising"},
    {"sizes.sieve.passing", PARAMETER_LIST, "1", "[]", AT(sizes.sieve_passing),
     BETWEEN(0, 1),
     .text =
         "share finer than each radius, rising from 0 to 1; linear in r between them"},
    {"seed", PARAMETER_INTEGER, "1", "1", AT(seed), BETWEEN(1, 4294967295),
     .text = "of the random numbers (mt19937): sizes and positions"},
    {"periodic", PARAMETER_FLAGS, "1", "[false,false,false]", AT(domain.periodic),
     .text = "whether the box repeats along x, y and z (imported packing.h5 or LAMMPS "
             "dump: as it says)"},
    {"lower", PARAMETER_POINT, "m", "null", AT(domain.lower),
     .text = "lower corner of the box; null: the origin (import: around the grains, or "
             "as INPUT says)"},
    {"upper", PARAMETER_POINT, "m", "null", AT(domain.upper),
     .text =
         "upper corner of the box; null: as counts say, for a lattice; where grains "
         "move, a cube for the count at the porosity expected (import: as for lower)"},
    {"domain.shape", PARAMETER_CHOICE, "1", "\"box\"", AT(domain.shape),
     .choices = "box|cylinder|ring|sphere",
     .text =
         "region in which the grains lie wholly; cylinder and ring stand along z; "
         "dimensions=2: box or sphere (a disc); box, with an INPUT that has another: "
         "that"},
    {"domain.centre", PARAMETER_POINT, "m", "null", AT(domain.centre),
     .text =
         "of a cylinder, ring or sphere; null: so that its box begins at the origin, "
         "or, of grains of INPUT, in the middle of their box"},
    {"domain.radius", PARAMETER_NUMBER, "m", "null", AT(domain.radius), ABOVE(0),
     .text = "of a cylinder, ring (outer) or sphere"},
    {"domain.inner_radius", PARAMETER_NUMBER, "m", "null", AT(domain.inner_radius),
     ABOVE(0), .text = "of a ring"},
    {"domain.height", PARAMETER_NUMBER, "m", "null", AT(domain.height), ABOVE(0),
     .text = "of a cylinder or ring"},
    {"domain.cut.shape", PARAMETER_CHOICE, "1", "\"none\"", AT(domain.cut),
     .choices = "none|box|cylinder|sphere",
     .text = "what is cut out of it; must lie wholly inside"},
    {"domain.cut.centre", PARAMETER_POINT, "m", "null", AT(domain.cut_centre),
     .text = "of a cylinder or sphere cut out; null: that of the domain"},
    {"domain.cut.radius", PARAMETER_NUMBER, "m", "null", AT(domain.cut_radius),
     ABOVE(0), .text = "of a cylinder or sphere cut out"},
    {"domain.cut.lower", PARAMETER_POINT, "m", "null", AT(domain.cut_lower),
     .text = "lower corner of a box cut out; of a cylinder only z counts, its lower "
             "end; null: through the whole domain"},
    {"domain.cut.upper", PARAMETER_POINT, "m", "null", AT(domain.cut_upper),
     .text = "upper corner of a box cut out; of a cylinder its upper end; null: as for "
             "lower"},
    {"target", PARAMETER_CHOICE, "1", "\"settled\"", AT(dynamics.target),
     .choices = "settled|porosity|coordination|pressure",
     .text = "when moving grains stop, at rest: settled (compressed: jammed, at "
             "dynamics.overlap), or with target_value of porosity, of contacts a grain "
             "(rattlers left out) or of mean stress in Pa; deposition and "
             "explosive_repulsion always settle"},
    {"target_value", PARAMETER_NUMBER, "1", "null", AT(dynamics.value), ABOVE(0),
     .text = "of the target; null: none, for settled"},
    {"dynamics.density", PARAMETER_NUMBER, "kg/m3", "2500", AT(dynamics.density),
     ABOVE(0), .text = "of the grains"},
    {"dynamics.friction", PARAMETER_NUMBER, "1", "0.5", AT(dynamics.friction),
     BETWEEN(0, 100), .text = "between grains; explosive_repulsion: always none"},
    {"dynamics.wall_friction", PARAMETER_NUMBER, "1", "null",
     AT(dynamics.wall_friction), BETWEEN(0, 100),
     .text = "at walls; null: as between grains"},
    {"dynamics.stiffness", PARAMETER_NUMBER, "N/m", "null", AT(dynamics.stiffness),
     ABOVE(0),
     .text = "normal, of a grain [K 4.22]; null: the one that gives dynamics.overlap"},
    {"dynamics.overlap", PARAMETER_NUMBER, "1", "1e-3", AT(dynamics.overlap),
     BETWEEN(1e-9, 0.05),
     .text = "typical overlap of contacts at the end: on the floor, over the radius "
             "(deposition); stress over stiffness and diameter (compressed, jammed)"},
    {"dynamics.shear_ratio", PARAMETER_NUMBER, "1", "0.2857142857142857",
     AT(dynamics.shear_ratio), BETWEEN(0, 1), .text = "shear over normal stiffness"},
    {"dynamics.damping", PARAMETER_NUMBER, "1", "0.2", AT(dynamics.damping),
     BETWEEN(0, 2), .text = "ratio of the contacts' dashpots [K 4.28]"},
    {"dynamics.local_damping", PARAMETER_NUMBER, "1", "0.3", AT(dynamics.local_damping),
     BETWEEN(0, 0.9),
     .text =
         "share of the net force on a grain: subtracted while the grain moves along "
         "the force, added while it moves against it, so that it comes to rest"},
    {"dynamics.gravity", PARAMETER_NUMBER, "m/s2", "9.81", AT(dynamics.gravity),
     ABOVE(0), .text = "downwards along z, in deposition"},
    {"dynamics.time_step_safety", PARAMETER_NUMBER, "1", "null", AT(dynamics.safety),
     BETWEEN(1e-6, 1),
     .text =
         "time step over the critical one of two grains [K 4.47], fixed; null: near "
         "the stability limit of the contacts as they form, and no grain has less "
         "inertia than the mean one (0.1 in explosive_repulsion, and if the mean grain "
         "weighs more than 30 times the smallest)"},
    {"dynamics.tolerance", PARAMETER_NUMBER, "1", "1e-4", AT(dynamics.tolerance),
     BETWEEN(1e-12, 1), .text = "unbalanced ratio at rest [K 4.20]"},
    {"dynamics.most_cycles", PARAMETER_INTEGER, "1", "3000000",
     AT(dynamics.most_cycles), BETWEEN(1, 1e12),
     .text = "gives up after this many time steps"},
    {"most_trials", PARAMETER_INTEGER, "1", "100000", AT(most_trials), BETWEEN(1, 1e12),
     .text =
         "random_sequential gives up after this many failed attempts for one grain"},
    {"densify", PARAMETER_BOOLEAN, "1", "false", AT(densify),
     .text = "inward_spiral: fill voids with grains that touch three others, down to "
             "sizes.smallest"},
    {"slab.lower", PARAMETER_NUMBER_OR_NULL, "m", "null", AT(slab_lower),
     .text =
         "keep only a slab of the packing, of grains with their centres above this "
         "height: as walls order grains, a rough floor is cut from a thicker "
         "packing; the box then ends on the slab and does not repeat along z (a side "
         "that is not cut keeps its wall)"},
    {"slab.upper", PARAMETER_NUMBER_OR_NULL, "m", "null", AT(slab_upper),
     .text = "and below this"},
    {"extra_layer", PARAMETER_BOOLEAN, "1", "false", AT(extra_layer),
     .text = "lay a regular layer of grains of the mean radius on the outermost grain "
             "of extra_side, across the box, for the boundary layer [K 3.3.5]; they "
             "come last, without bonds, and the box ends on them"},
    {"extra_side", PARAMETER_CHOICE, "1", "\"+z\"", AT(extra_side),
     .choices = "-x|+x|-y|+y|-z|+z",
     .text = "flat side of the box where the extra layer lies"},
    {"frame", PARAMETER_INTEGER, "1", "-1", AT(frame), BETWEEN(-1, 1e12),
     .text = "of an imported LAMMPS dump, from 0; -1: the last"},
    {"import.scale", PARAMETER_NUMBER, "m", "1", AT(import_scale), ABOVE(0),
     .text = "length of a unit of INPUT: 1e-3 where it is in millimetres, 1e-6 in "
             "micrometres"},
    {"import.diameters", PARAMETER_BOOLEAN, "1", "false", AT(import_diameters),
     .text = "INPUT has diameters in place of radii (the column diameter of a dump "
             "needs nothing)"},
    {"check", PARAMETER_CHOICE, "1", "\"refuse\"", AT(check),
     .choices = "refuse|warn|none",
     .text = "refuse: grains in one place or wholly outside the box, or with more "
             "volume than it, end with status 65, and likely mistakes are reported "
             "(not for poisson); warn: both are reported; none: no check"},
    {"bonds", PARAMETER_CHOICE, "1", "\"touching\"", AT(bonds),
     .choices = "none|touching|keep",
     .text = "which grains are bonded; keep: as an imported packing.h5 says"},
    {"touching_gap", PARAMETER_NUMBER, "1", "1e-6", AT(touching_gap), BETWEEN(0, 1),
     .text = "largest gap between touching surfaces, over the sum of the two radii"},
    {0}};
