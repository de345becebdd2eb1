// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of parameters: of the scene, and of its named materials, pairs of
// materials, walls and groups of grains. Command line, help, JSON Schema and
// docs/reference.md all come from them.
//
// A number that may be left out has the default null and becomes NAN. So "not given"
// differs from every value, and each reader decides what stands in for it. Checks that
// need more than one number are check_parameters' below; what a scene leaves without
// use is in unused.c; checks that need the packing are in scene.c and groups.c.
#include "parameters.h"

#include "basics/status.h"

#include <math.h>
#include <stddef.h>

#define OF_MATERIAL(member) offsetof(struct material_parameters, member)
const struct parameter simulate_materials[] = {
    {"density", PARAMETER_NUMBER, "kg m-3", "2500", OF_MATERIAL(density), ABOVE(0),
     .text = "of the grains"},
    {"friction", PARAMETER_NUMBER, "1", "0.5", OF_MATERIAL(friction), AT_LEAST(0),
     .text = "coefficient of Coulomb friction; of two materials the smaller counts"},
    {"restitution", PARAMETER_NUMBER, "1", "0.9", OF_MATERIAL(restitution),
     BETWEEN(1e-6, 1),
     .text = "normal coefficient of restitution, from which the dashpots follow; of "
             "two materials the smaller counts"},
    {"young_modulus", PARAMETER_NUMBER, "Pa", "null", OF_MATERIAL(young_modulus),
     ABOVE(0), .text = "law=hertz: must be given"},
    {"poisson_ratio", PARAMETER_NUMBER, "1", "0.25", OF_MATERIAL(poisson_ratio),
     BETWEEN(0, 0.5), .text = "law=hertz"},
    {"normal_stiffness", PARAMETER_NUMBER, "N m-1", "null",
     OF_MATERIAL(normal_stiffness), AT_LEAST(0),
     .text = "law=linear: of a grain, must be given; a contact is two of these in "
             "series [K 4.22]"},
    {"shear_stiffness", PARAMETER_NUMBER, "N m-1", "null", OF_MATERIAL(shear_stiffness),
     AT_LEAST(0),
     .text = "law=linear: of a grain; null: 2/7 of the normal stiffness, so that both "
             "spring back in the same time"},
    {"damping_ratio", PARAMETER_NUMBER, "1", "null", OF_MATERIAL(damping_ratio),
     AT_LEAST(0),
     .text = "law=linear: of the dashpots, over critical damping [K 4.28]; null: that "
             "of the restitution"},
    {"rolling_friction", PARAMETER_NUMBER, "1", "0", OF_MATERIAL(rolling_friction),
     AT_LEAST(0),
     .text =
         "largest rolling moment over the normal force times R_i R_j / (R_i + R_j), "
         "elastic-plastic (type C of Ai et al. 2011); of two materials the smaller "
         "counts; not with bonds"},
    {"rolling_damping", PARAMETER_NUMBER, "1", "0.3", OF_MATERIAL(rolling_damping),
     AT_LEAST(0), .text = "of the rolling spring, over critical damping"},
    {0}};

#define OF_PAIR(member) offsetof(struct pair_parameters, member)
const struct parameter simulate_pairs[] = {
    {"first", PARAMETER_TEXT, "1", NULL, OF_PAIR(first), .text = "name of a material"},
    {"second", PARAMETER_TEXT, "1", NULL, OF_PAIR(second),
     .text = "name of a material, perhaps the same"},
    {"friction", PARAMETER_NUMBER, "1", "null", OF_PAIR(friction), AT_LEAST(0),
     .text = "between the two; null: the smaller of theirs"},
    {"restitution", PARAMETER_NUMBER, "1", "null", OF_PAIR(restitution),
     BETWEEN(1e-6, 1),
     .text = "between the two, law=hertz or timed; null: the smaller of theirs"},
    {"rolling_friction", PARAMETER_NUMBER, "1", "null", OF_PAIR(rolling_friction),
     AT_LEAST(0), .text = "between the two; null: the smaller of theirs"},
    {0}};

#define TIME_TABLE(at)                                                                 \
    {"motion.times",                                                                   \
     PARAMETER_LIST,                                                                   \
     "s",                                                                              \
     "[]",                                                                             \
     (at) + offsetof(struct time_table, times),                                        \
     AT_LEAST(0),                                                                      \
     .text = "times of motion.factors, rising"},                                       \
    {                                                                                  \
        "motion.factors", PARAMETER_LIST, "1", "[]",                                   \
            (at) + offsetof(struct time_table, factors),                               \
            .text =                                                                    \
                "by which velocity, spin and servo are multiplied at these times, "    \
                "linear between them and constant outside; none: 1"                    \
    }

#define OF_WALL(member) offsetof(struct wall_parameters, member)
const struct parameter simulate_walls[] = {
    {"shape", PARAMETER_CHOICE, "1", "\"plane\"", OF_WALL(shape),
     .choices = "plane|cylinder|sphere|ring|block",
     .text = "plane: grains stay on the side that normal points to; cylinder: endless, "
             "about the axis through point along normal; sphere; ring: flat and thin, "
             "a disc where inner_radius is 0; block: solid, with edges along x, y, z"},
    {"point", PARAMETER_POINT, "m", NULL, OF_WALL(point),
     .text = "on the plane or the axis, or the centre; moments are about it"},
    {"normal", PARAMETER_POINT, "1", "[0,0,1]", OF_WALL(normal),
     .text = "of planes and rings, axis of cylinders; of any length"},
    {"radius", PARAMETER_NUMBER, "m", "null", OF_WALL(radius), ABOVE(0),
     .text = "of cylinders, spheres and rings: must be given"},
    {"inner_radius", PARAMETER_NUMBER, "m", "0", OF_WALL(inner_radius), AT_LEAST(0),
     .text = "of rings"},
    {"half_edge", PARAMETER_POINT, "m", "null", OF_WALL(half_edge),
     .text = "half the edges of a block: must be given"},
    {"outside", PARAMETER_BOOLEAN, "1", "false", OF_WALL(outside),
     .text = "true: the grains lie around a cylinder or sphere; false: inside"},
    {"material", PARAMETER_TEXT, "1", "null", OF_WALL(material),
     .text = "name of a material; null: a rigid wall, which the grain alone yields to"},
    {"friction", PARAMETER_NUMBER, "1", "null", OF_WALL(friction), AT_LEAST(0),
     .text = "of grains on it; null: that of the materials, or of the grain"},
    {"velocity", PARAMETER_POINT, "m s-1", "[0,0,0]", OF_WALL(velocity),
     .text = "of its point"},
    {"spin", PARAMETER_POINT, "rad s-1", "[0,0,0]", OF_WALL(spin),
     .text = "angular velocity of its surface about point: of planes, cylinders and "
             "rings about normal, of spheres any"},
    {"servo.force", PARAMETER_NUMBER, "N", "null", OF_WALL(servo_force), ABOVE(0),
     .text = "planes: the wall moves along its normal until grains push it with this"},
    {"servo.pressure", PARAMETER_NUMBER, "Pa", "null", OF_WALL(servo_pressure),
     ABOVE(0), .text = "the same with a force of this times servo.area"},
    {"servo.area", PARAMETER_NUMBER, "m2", "null", OF_WALL(servo_area), ABOVE(0),
     .text = "null: of the rectangle between the other planes (or the box), as they "
             "move; for a plane along two axes"},
    {"servo.largest_speed", PARAMETER_NUMBER, "m s-1", "null",
     OF_WALL(servo_largest_speed), ABOVE(0),
     .text = "of a wall with a servo: must be given"},
    TIME_TABLE(OF_WALL(motion)),
    {0}};

#define OF_GROUP(member) offsetof(struct group_parameters, member)
static const struct parameter group_table[] = {
    {"lower", PARAMETER_POINT, "m", "null", OF_GROUP(lower),
     .text =
         "grains with their centres in this box are of the group: its lower corner; "
         "null: no bound"},
    {"upper", PARAMETER_POINT, "m", "null", OF_GROUP(upper),
     .text = "upper corner of this box"},
    {"ring.inner", PARAMETER_NUMBER, "m", "0", OF_GROUP(ring_inner), AT_LEAST(0),
     .text = "and no nearer than this to the axis of the ring"},
    {"ring.outer", PARAMETER_NUMBER, "m", "null", OF_GROUP(ring_outer), ABOVE(0),
     .text = "and nearer than this to it; null: no bound"},
    {"ring.centre", PARAMETER_POINT, "m", "[0,0,0]", OF_GROUP(ring_centre),
     .text = "a point on this axis"},
    {"ring.axis", PARAMETER_POINT, "1", "[0,0,1]", OF_GROUP(ring_axis),
     .text = "its direction"},
    {"grains", PARAMETER_LIST, "1", "[]", OF_GROUP(grains), AT_LEAST(0),
     .text = "these grains by number, and no others unless a box or a ring is given"},
    {"material", PARAMETER_TEXT, "1", "null", OF_GROUP(material),
     .text = "name of a material; null: that of the scene"},
    {"driven", PARAMETER_BOOLEAN, "1", "false", OF_GROUP(driven),
     .text = "true: the grains move as one rigid body with velocity and spin, whatever "
             "pushes them; false: freely"},
    {"velocity", PARAMETER_POINT, "m s-1", "[0,0,0]", OF_GROUP(velocity),
     .text = "driven: of its point"},
    {"spin", PARAMETER_POINT, "rad s-1", "[0,0,0]", OF_GROUP(spin),
     .text = "driven: angular velocity about the axis through point"},
    {"point", PARAMETER_POINT, "m", "[0,0,0]", OF_GROUP(point),
     .text = "driven: moments are about it"},
    {"initial.velocity", PARAMETER_POINT, "m s-1", "null", OF_GROUP(initial_velocity),
     .text = "of free grains; null: that of the packing, or none"},
    {"initial.spin", PARAMETER_POINT, "rad s-1", "[0,0,0]", OF_GROUP(initial_spin),
     .text = "angular velocity of free grains"},
    TIME_TABLE(OF_GROUP(motion)),
    {0}};

#define AT(member) offsetof(struct simulate_parameters, member)
const struct parameter simulate_table[] = {
    {"duration", PARAMETER_NUMBER, "s", NULL, AT(duration), AT_LEAST(0),
     .text = "to simulate"},
    {"law", PARAMETER_CHOICE, "1", "\"hertz\"", AT(law),
     .choices = "hertz|linear|timed",
     .text =
         "of contacts: hertz: Hertz-Mindlin from Young's modulus and Poisson's ratio "
         "[K 4.23]; linear: springs and dashpots [K 4.22]; timed: linear, with "
         "the same contact time for all pairs [G 2]"},
    {"contact_time", PARAMETER_NUMBER, "s", "null", AT(contact_time), ABOVE(0),
     .text = "law=timed: duration of an impact, must be given"},
    {"materials", PARAMETER_NAMED, "1", "{}", AT(materials),
     ROWS_OF(simulate_materials, struct material_parameters),
     .text = "by name: {\"glass\": {\"density\": 2500, ...}, ...}"},
    {"material", PARAMETER_TEXT, "1", "null", AT(material),
     .text = "of the grains; null: the only one"},
    {"pairs", PARAMETER_NAMED, "1", "{}", AT(pairs),
     ROWS_OF(simulate_pairs, struct pair_parameters),
     .text = "by any name: friction and restitution of two materials"},
    {"walls", PARAMETER_NAMED, "1", "{}", AT(walls),
     ROWS_OF(simulate_walls, struct wall_parameters),
     .text = "by name: {\"floor\": {\"point\": [0,0,0]}, ...}"},
    {"box.walls", PARAMETER_CHOICES, "1", "[]", AT(box_walls),
     .choices = "-x|+x|-y|+y|-z|+z",
     .text = "sides of the packing's box that are walls; they are called so"},
    {"box.material", PARAMETER_TEXT, "1", "null", AT(box_material),
     .text = "of these walls; null: rigid"},
    {"box.friction", PARAMETER_NUMBER, "1", "null", AT(box_friction), AT_LEAST(0),
     .text = "of these walls; null: that of the materials, or of the grain"},
    {"box.strain_rate", PARAMETER_POINT, "s-1", "[0,0,0]", AT(strain_rate),
     .text = "a box that repeats along x, y, z: it grows at this rate, and all grains "
             "move with it; below 0: compression"},
    {"groups", PARAMETER_NAMED, "1", "{}", AT(groups),
     ROWS_OF(group_table, struct group_parameters),
     .text = "by name: grains with a material, an initial velocity or a motion of "
             "their own"},
    {"gravity", PARAMETER_POINT, "m s-2", "[0,0,-9.81]", AT(gravity),
     .text = "acceleration"},
    {"prestress", PARAMETER_BOOLEAN, "1", "true", AT(prestress),
     .text = "overlaps of the packing push from the start; false: they do not, only "
             "further approach does"},
    {"tensile_damping", PARAMETER_BOOLEAN, "1", "true", AT(tensile_damping),
     .text = "dashpots may pull grains that separate; false: the normal force of a "
             "contact without a bond is never below 0 [G 3]"},
    {"friction_limit", PARAMETER_CHOICE, "1", "\"spring\"", AT(friction_limit),
     .choices = "spring|total",
     .text = "friction is limited by the force of the normal spring [K 4.25], or by "
             "that of spring and dashpot, as in LIGGGHTS"},
    {"local_damping", PARAMETER_NUMBER, "1", "0", AT(local_damping), BETWEEN(0, 0.99),
     .text = "share of the net force on a grain that opposes its motion; for statics, "
             "not physical"},
    {"density_scaling", PARAMETER_BOOLEAN, "1", "false", AT(density_scaling),
     .text = "every grain has the inertia of the mean one, so that small ones do not "
             "shorten the time step; for statics"},
    {"bond.kind", PARAMETER_CHOICE, "1", "\"none\"", AT(bond_kind),
     .choices = "none|parallel|contact",
     .text = "of the bonds that the packing lists: none are made; parallel: elastic "
             "cylinders [K 4.31-4.44]; contact: the springs of the contact, which also "
             "pull [K 4.2]"},
    {"bond.normal_stiffness", PARAMETER_NUMBER, "N m-3", "8e14",
     AT(bond.normal_stiffness), AT_LEAST(0), .text = "parallel: per area"},
    {"bond.shear_stiffness", PARAMETER_NUMBER, "N m-3", "8e14",
     AT(bond.shear_stiffness), AT_LEAST(0), .text = "parallel: per area"},
    {"bond.normal_strength", PARAMETER_NUMBER, "Pa", "1.6e4", AT(bond.normal_strength),
     AT_LEAST(0), .text = "parallel: tensile stress that breaks it [K 4.41]"},
    {"bond.shear_strength", PARAMETER_NUMBER, "Pa", "1.6e4", AT(bond.shear_strength),
     AT_LEAST(0), .text = "parallel: shear stress that breaks it [K 4.42]"},
    {"bond.radius_fraction", PARAMETER_NUMBER, "1", "0.5858", AT(bond.radius_fraction),
     BETWEEN(1e-6, 1), .text = "parallel: its radius over that of the smaller grain"},
    {"bond.contact_strength", PARAMETER_NUMBER, "N", "null", AT(bond_contact_strength),
     AT_LEAST(0), .text = "contact: force that breaks it; null: no force does"},
    {"bridges.volume", PARAMETER_NUMBER, "m3", "0", AT(liquid.volume), AT_LEAST(0),
     .text =
         "of the liquid bridge between two grains that touch [G 2]; with shared, of "
         "the liquid of each grain; 0: dry"},
    {"bridges.shared", PARAMETER_BOOLEAN, "1", "false", AT(liquid.shared),
     .text = "each grain divides its liquid evenly among its bridges"},
    {"bridges.walls", PARAMETER_BOOLEAN, "1", "false", AT(liquid.wets_walls),
     .text = "true: bridges form between grains and walls too"},
    {"bridges.surface_tension", PARAMETER_NUMBER, "N m-1", "null", AT(surface_tension),
     ABOVE(0), .shared = true, .text = "of the liquid; null: water at 293.15 K"},
    {"bridges.contact_angle", PARAMETER_NUMBER, "degree", "0", AT(contact_angle),
     BETWEEN(0, 170), .shared = true, .text = "of the liquid on the grains"},
    {"bridges.model", PARAMETER_CHOICE, "1", "\"table\"", AT(bridge_model),
     .choices = BRIDGE_MODEL_CHOICES,
     .text = "of their force; table: the exact solution, interpolated; the others are "
             "fits"},
    {"bridges.pull_in_contact", PARAMETER_BOOLEAN, "1", "true",
     AT(liquid.pulls_in_contact),
     .text = "bridges also pull where grains overlap; false: only across a gap [G 4]"},
    {"adhesion", PARAMETER_NUMBER, "J m-2", "0", AT(adhesion), AT_LEAST(0),
     .text =
         "work of adhesion of dry contacts, also with walls (Johnson, Kendall and "
         "Roberts), twice the surface energy of two equal materials; needs law=hertz"},
    {"forces.row", PARAMETER_INTEGER, "1", "-1", AT(forces_row), BETWEEN(-1e9, 1e9),
     .text =
         "of a second input, a forces artifact: its forces at this time, from 0; -1 "
         "the last, act all the while"},
    {"forces.factor", PARAMETER_NUMBER, "1", "1", AT(forces_factor),
     .text = "on these forces"},
    {"time_step", PARAMETER_NUMBER, "s", "null", AT(time_step), ABOVE(0),
     .text = "null: time_step_share of the stability limit"},
    {"time_step_share", PARAMETER_NUMBER, "1", "0.2", AT(time_step_share),
     BETWEEN(1e-4, 0.9),
     .text =
         "time step over the stability limit: with 0.5 the rebound of a grain is off "
         "by 1 to 2 % of its speed, with 0.2 by 0.2 to 0.6 %, with 0.1 by 0.2 to 0.3 "
         "%"},
    {"allow_unstable", PARAMETER_BOOLEAN, "1", "false", AT(allow_unstable),
     .text = "run even if time_step is past the stability limit"},
    {"expected_overlap", PARAMETER_NUMBER, "1", "0.01", AT(expected_overlap),
     BETWEEN(1e-12, 1),
     .text = "law=hertz: the stability limit is that of contacts with this overlap, in "
             "mean radii"},
    {"largest_overlap", PARAMETER_NUMBER, "1", "0.5", AT(largest_overlap), ABOVE(0),
     .text = "in mean radii: when two grains, or a grain and a wall, overlap by more, "
             "the run ends with status 3"},
    {"record.every", PARAMETER_NUMBER, "s", "null", AT(record_every), ABOVE(0),
     .text = "between the rows of /history; null: duration/200"},
    {"record.snapshots_every", PARAMETER_NUMBER, "s", "null", AT(snapshots_every),
     ABOVE(0), .text = "between snapshots of all grains; null: duration/20"},
    {"record.snapshots_from", PARAMETER_NUMBER, "s", "0", AT(snapshots_from),
     AT_LEAST(0), .text = "time of the first snapshot"},
    {"record.contacts", PARAMETER_BOOLEAN, "1", "true", AT(record_contacts),
     .text = "snapshots have all contacts"},
    {"record.energy", PARAMETER_BOOLEAN, "1", "true", AT(record_energy),
     .text = "keep the energy balance: work and dissipation"},
    {"stop.unbalanced_ratio", PARAMETER_NUMBER, "1", "null", AT(stop_ratio), ABOVE(0),
     .text =
         "the run ends when the unbalanced ratio [K 4.20] is below this; null: after "
         "its duration"},
    {"stop.after", PARAMETER_NUMBER, "s", "0", AT(stop_after), AT_LEAST(0),
     .text = "but not before this time"},
    {"write", PARAMETER_CHOICE, "1", "\"motion\"", AT(write),
     .choices = "motion|packing",
     .text =
         "motion: all that was recorded; packing: the grains as they are at the end, "
         "for any stage that takes a packing"},
    {0}};

// Equal times would be a jump, which has no slope to interpolate; a steep ramp says the
// same without doubt about the value at the jump.
static void check_time_table(const char *kind, const char *name,
                             const struct time_table *table)
{
    const int n = table->times.count;
    if (n != table->factors.count)
        die(STATUS_BAD_DATA,
            "simulate.%s.%s.motion: needs as many factors as times, got %d and %d",
            kind, name, table->factors.count, n);
    for (int k = 1; k < n; k++)
        if (!(table->times.value[k] > table->times.value[k - 1]))
            die(STATUS_BAD_DATA,
                "simulate.%s.%s.motion.times: must rise, got %g after %g", kind, name,
                table->times.value[k], table->times.value[k - 1]);
}

// The largest speed has no default: before grains touch the wall nothing else bounds
// its speed, and what is slow depends on the scene.
static void check_servo(const char *name, const struct wall_parameters *wall)
{
    const bool force = !isnan(wall->servo_force),
               pressure = !isnan(wall->servo_pressure);
    if (!force && !pressure) return;
    if (force && pressure)
        die(STATUS_BAD_DATA,
            "simulate.walls.%s.servo: give force or pressure, not both", name);
    if (wall->shape != DEM_PLANE)
        die(STATUS_BAD_DATA, "simulate.walls.%s.servo: only planes have one", name);
    if (isnan(wall->servo_largest_speed))
        die(STATUS_BAD_DATA,
            "simulate.walls.%s.servo.largest_speed: must be given: how fast the wall "
            "may "
            "close in before grains push it",
            name);
}

static void check_wall(const char *name, const struct wall_parameters *wall)
{
    const bool round = wall->shape != DEM_PLANE && wall->shape != DEM_BLOCK;
    if (round && isnan(wall->radius))
        die(STATUS_BAD_DATA, "simulate.walls.%s.radius: must be given", name);
    if (wall->shape == DEM_BLOCK && isnan(wall->half_edge[0]))
        die(STATUS_BAD_DATA, "simulate.walls.%s.half_edge: must be given", name);
    check_servo(name, wall);
    check_time_table("walls", name, &wall->motion);
}

static void check_material(const char *name, const struct material_parameters *material,
                           enum contact_law law)
{
    if (law == LAW_HERTZ && isnan(material->young_modulus))
        die(STATUS_BAD_DATA,
            "simulate.materials.%s.young_modulus: must be given with law=hertz", name);
    if (law == LAW_LINEAR && isnan(material->normal_stiffness))
        die(STATUS_BAD_DATA,
            "simulate.materials.%s.normal_stiffness: must be given with law=linear",
            name);
}

void check_parameters(const struct simulate_parameters *parameters)
{
    const struct named_rows *materials = &parameters->materials;
    const struct named_rows *walls = &parameters->walls, *groups = &parameters->groups;
    if (materials->count == 0)
        die(STATUS_BAD_DATA,
            "simulate.materials: none is given: {\"glass\": {\"density\": 2500, "
            "\"young_modulus\": 7e10}}");
    if (parameters->law == LAW_TIMED && isnan(parameters->contact_time))
        die(STATUS_BAD_DATA, "simulate.contact_time: must be given with law=timed");
    if (parameters->adhesion > 0 &&
        (parameters->law != LAW_HERTZ || parameters->liquid.volume > 0))
        die(STATUS_BAD_DATA,
            "simulate.adhesion: must be 0 with liquid bridges (bridges.volume), and "
            "without law=hertz");
    for (int k = 0; k < materials->count; k++)
        check_material(materials->name[k],
                       (const struct material_parameters *)materials->row + k,
                       (enum contact_law)parameters->law);
    for (int k = 0; k < walls->count; k++)
        check_wall(walls->name[k], (const struct wall_parameters *)walls->row + k);
    for (int k = 0; k < groups->count; k++)
        check_time_table("groups", groups->name[k],
                         &((const struct group_parameters *)groups->row + k)->motion);
}
