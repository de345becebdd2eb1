// SPDX-License-Identifier: GPL-3.0-or-later
// flow: viscous flow through a packing, and its drag on every grain.
//
// In this order: cells and pores (pore_cells.h), throats and their conductances,
// boundary conditions, how fast pores open (if anything moves), pressures, forces, then
// what is asked for: Stokes' drag, pore stresses, the permeability tensor, column by
// column from a pressure drop of 1 Pa along each axis. With U the mean velocity for a
// viscosity of 1, drop the pressure drop and L the box along the flow,
//     permeability = U L unit^2 / drop,   bed_permeability = permeability bed_share:
// the bed is the part of the box that grains reach over, in series with free fluid.
//
// It reads a packing: positions, radii, the box, and /particles/velocity where it has
// one. It writes flow.h5, or with write=forces the total force on every grain as a
// forces artifact, which grows from 0 over `steps`, for dem-replay.
//
// Throats come before the conditions because these do not change them: the tensor
// solves three times on the same throats. Velocities only give sources; grains stay
// where they are. From find_cells to write all but permeabilities is in units of length
// (cell_grains.h) and for a viscosity of 1, with pressures in Pa.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "conditions.h"
#include "parameters/estimate.h"
#include "pore_volume_rate.h"
#include "small_grains.h"
#include "write_flow.h"

#include <stdio.h>
#include <stdlib.h>

enum output_kind { OUTPUT_FLOW, OUTPUT_FORCES };

// What the table reads into. The int members are places of choices in the table, and
// are cast to enums of the same order (throats.h, sparse/linear_solver.h, here).
struct flow_parameters {
    struct imposed imposed;
    int sides, conductance, facet_pieces, solver, output_kind;
    double factor, viscosity, density, tolerance;
    double gravity[3], strain_rate[3];
    bool tensor, stress, stokes;
    int64_t steps;
};

#define AT(member) offsetof(struct flow_parameters, member)
#define WALL(key, kind, unit, wall, what)                                              \
    {                                                                                  \
        key, PARAMETER_NUMBER, unit, "null", AT(imposed.kind[wall]), .text = (what)    \
    }

static const struct parameter table[] = {
    {"along", PARAMETER_CHOICE, "1", "\"z\"", AT(imposed.along),
     .choices = "x|y|z|none",
     .text = "direction in which the pressure falls, from the lower to the upper wall "
             "or, in a periodic box, from box to box; none: only pressure and flux "
             "drive the flow"},
    {"pressure_drop", PARAMETER_NUMBER, "Pa", "1", AT(imposed.drop),
     .text = "pressure drop over the box"},
    WALL("pressure.x_lower", pressure, "Pa", 0,
         "piezometric pressure at the wall -x; in its middle, where along lets the "
         "pressure fall along the wall, from box to box"),
    WALL("pressure.x_upper", pressure, "Pa", 1, "at the wall +x"),
    WALL("pressure.y_lower", pressure, "Pa", 2, "at the wall -y"),
    WALL("pressure.y_upper", pressure, "Pa", 3, "at the wall +y"),
    WALL("pressure.z_lower", pressure, "Pa", 4, "at the wall -z"),
    WALL("pressure.z_upper", pressure, "Pa", 5, "at the wall +z"),
    WALL("flux.x_lower", flux, "m3 s-1", 0,
         "flux into the box through the wall -x, at a uniform pressure on it"),
    WALL("flux.x_upper", flux, "m3 s-1", 1, "through the wall +x"),
    WALL("flux.y_lower", flux, "m3 s-1", 2, "through the wall -y"),
    WALL("flux.y_upper", flux, "m3 s-1", 3, "through the wall +y"),
    WALL("flux.z_lower", flux, "m3 s-1", 4, "through the wall -z"),
    WALL("flux.z_upper", flux, "m3 s-1", 5, "through the wall +z"),
    {"sides", PARAMETER_CHOICE, "1", "\"no-slip\"", AT(sides),
     .choices = "no-slip|symmetric|symmetric-yade",
     .text = "walls resist as grains do; or are planes of symmetry [C 3.1]; or as in "
             "Yade, which also narrows the throats at symmetric walls"},
    {"conductance", PARAMETER_CHOICE, "1", "\"hydraulic\"", AT(conductance),
     .choices = "hydraulic|effective|section",
     .text = "of a throat: by hydraulic radius [C 8], effective radius [C 10], or its "
             "open section, as in tessellate: the best for random packings"},
    {"conductance_factor", PARAMETER_NUMBER, "1", "0.5", AT(factor),
     BETWEEN(1e-100, 1e100), .text = "alpha of [C 8]"},
    {"pieces", PARAMETER_CHOICE, "1", "\"signed\"", AT(facet_pieces),
     .choices = "signed|unsigned",
     .text =
         "of throats whose two pores lie on the same side of the facet: signed, their "
         "pieces add up to the void; unsigned: a part counts twice, as in Yade"},
    {"viscosity", PARAMETER_NUMBER, "Pa s", "0.001", AT(viscosity), ABOVE(0),
     .text = "of the fluid"},
    {"density", PARAMETER_NUMBER, "kg m-3", "1000", AT(density), AT_LEAST(0),
     .text = "of the fluid, for buoyancy"},
    {"gravity", PARAMETER_POINT, "m s-2", "[0,0,0]", AT(gravity),
     .text = "acceleration, for buoyancy"},
    {"strain_rate", PARAMETER_POINT, "s-1", "[0,0,0]", AT(strain_rate),
     .text = "of the box along x, y, z: its lower walls stand, the upper ones move "
             "accordingly, and grains without /particles/velocity"},
    {"permeability_tensor", PARAMETER_BOOLEAN, "1", "false", AT(tensor),
     .text = "from three more flows, along x, y and z"},
    {"stokes_drag", PARAMETER_BOOLEAN, "1", "false", AT(stokes),
     .text = "small grains that float in a pore get Stokes' drag as well; the grains "
             "around them lose that force"},
    {"pore_stress", PARAMETER_BOOLEAN, "1", "false", AT(stress),
     .text = "pressure and viscous stress, averaged over each pore and over the fluid; "
             "nothing may move"},
    {"solver", PARAMETER_CHOICE, "1", "\"auto\"", AT(solver),
     .choices = "auto|cholesky|iteration",
     .text = "of the pressures: Cholesky's factor, or conjugate gradients with an "
             "approximate factor; auto: the faster"},
    {"tolerance", PARAMETER_NUMBER, "1", "1e-12", AT(tolerance), BETWEEN(1e-14, 0.1),
     .text = "largest error of the balance of a pore, and of the sum over all pores, "
             "relative to the flux"},
    {"write", PARAMETER_CHOICE, "1", "\"flow\"", AT(output_kind),
     .choices = "flow|forces",
     .text = "all of the flow, or the total force on every grain for dem-replay"},
    {"steps", PARAMETER_INTEGER, "1", "11", AT(steps), BETWEEN(2, 1e6),
     .text = "write=forces: number of times, a second apart, over which the forces "
             "grow from 0"},
    {0}};

static const struct stage stage = {
    .name = "flow",
    .version = STAGE_VERSION,
    .summary = "flow -- viscous flow through the pores and its drag on every grain [C]",
    .reads = "packing",
    .writes = "flow",
    .most_inputs = 1,
    .parameters = table,
    .estimates = ESTIMATES_SIZES,
    .notes = "Pores are the cells of the regular triangulation of the grains, throats "
             "its facets. With write=forces the output is a forces artifact."};

// Everything a packing makes, and the flow through it. Members are filled from above
// to below, and each owns its arrays.
struct computation {
    struct packing packing;
    struct grains grains;
    struct cells cells;
    struct throats throats;
    struct conditions conditions;
    struct pressures pressures;
    struct forces forces;
    double *opening; // NULL: nothing moves
    struct vector permeability_columns[3];
    struct pore_stress stress;
};

// GIVEN (n_particle), m/s, in units of length. The place that a packing gives may lie
// boxes away from that in the box, and moves with the strain of them. Along axes that
// repeat only differences count: those from the first grain, so that grains that move
// all alike open nothing, to the last digit.
static struct vector *velocities_in_box(const struct packing *packing,
                                        const struct grains *grains,
                                        const struct vector *given, struct vector rate)
{
    struct vector *velocity = NEW_ARRAY(struct vector, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        for (int axis = 0; axis < 3; axis++) {
            double speed = component(given[i], axis);
            if (grains->repeats[axis]) {
                const double edge = component(grains->box, axis) * grains->unit;
                const double away = component(packing->position[i], axis) -
                                    component(packing->lower, axis) -
                                    component(grains->position[i], axis) * grains->unit;
                speed -= component(given[0], axis) +
                         component(rate, axis) * edge * rint(away / edge);
            }
            set_component(&velocity[i], axis, speed / grains->unit);
        }
    return velocity;
}

// NULL when neither box nor grains move. Velocities of the packing, where it has them;
// else grains move with the strain of the box, v = rate x. Scaled by the unit of
// length; (n_pore) volume a time.
static double *find_opening(const struct artifact *input,
                            const struct flow_parameters *parameters,
                            const struct computation *flow)
{
    const struct vector rate = as_vector(parameters->strain_rate);
    const struct grains *grains = &flow->grains;
    struct vector *velocity;
    if (artifact_has_dataset(input, "/particles/velocity")) {
        struct vector *given = artifact_get(input, "/particles/velocity", NULL);
        velocity = velocities_in_box(&flow->packing, grains, given, rate);
        free(given);
    } else {
        if (!(norm(rate) > 0)) return NULL;
        velocity = NEW_ARRAY(struct vector, grains->n_base);
        for (int i = 0; i < grains->n_base; i++) {
            const struct vector at = grains->position[i];
            velocity[i] = (struct vector){rate.x * at.x, rate.y * at.y, rate.z * at.z};
        }
    }
    double *opening =
        opening_rates(grains, &flow->cells, &flow->throats, velocity, rate);
    free(velocity);
    return opening;
}

// A pore that opens draws fluid in. Scaled by the viscosity, because pressures are
// solved for a viscosity of 1.
static double *sources_of(const struct computation *flow, double viscosity)
{
    if (!flow->opening) return NULL;
    double *source = NEW_ARRAY(double, flow->cells.n_pore);
    for (int i = 0; i < flow->cells.n_pore; i++)
        source[i] = -viscosity * flow->opening[i];
    return source;
}

// Column j of the tensor is the mean velocity under a drop of 1 Pa along j. Nothing
// moves in these flows, whatever moves in the first one.
static enum status find_columns(struct computation *flow, const struct solving *solving,
                                struct reason *reason)
{
    const double unit = flow->grains.unit;
    for (int axis = 0; axis < 3; axis++) {
        const struct conditions along = fall_along(&flow->grains, axis, 1);
        struct pressures pressures;
        enum status status =
            solve_pressures(&flow->grains, &flow->cells, &flow->throats, &along, NULL,
                            solving, &pressures, reason);
        if (!status) {
            struct forces forces =
                find_forces(&flow->grains, &flow->cells, &flow->throats, &pressures);
            flow->permeability_columns[axis] =
                scale(unit * unit * component(flow->grains.box, axis), forces.velocity);
            forces_free(&forces);
        }
        pressures_free(&pressures);
        if (status) return status;
    }
    return STATUS_OK;
}

// The whole flow, part by part. Pore stresses are averages of a Stokes flow between
// resting grains: they are refused where something moves, before anything is solved.
static enum status compute(const struct artifact *input,
                           const struct flow_parameters *parameters,
                           struct computation *flow, struct reason *reason)
{
    const struct throat_rule rule = {
        .sides = (enum sides)parameters->sides,
        .conductance = (enum conductance)parameters->conductance,
        .facet_pieces = (enum facet_pieces)parameters->facet_pieces,
        .factor = parameters->factor};
    const struct solving solving = {(enum solver)parameters->solver,
                                    parameters->tolerance};
    enum status status =
        find_cells(&flow->packing, &flow->grains, &flow->cells, reason);
    if (status) return status;
    flow->throats = find_throats(&flow->grains, &flow->cells, &rule);
    status = find_conditions(&flow->grains, &parameters->imposed, parameters->viscosity,
                             &flow->conditions, reason);
    if (status) return status;
    flow->opening = find_opening(input, parameters, flow);
    if (flow->opening && parameters->stress)
        return refuse(reason, STATUS_BAD_DATA,
                      "flow.pore_stress: must be false where grains or walls move");
    double *source = sources_of(flow, parameters->viscosity);
    status =
        solve_pressures(&flow->grains, &flow->cells, &flow->throats, &flow->conditions,
                        source, &solving, &flow->pressures, reason);
    free(source);
    if (status) return status;
    flow->forces =
        find_forces(&flow->grains, &flow->cells, &flow->throats, &flow->pressures);
    if (parameters->stokes)
        add_stokes_drag(&flow->grains, &flow->cells, &flow->throats, &flow->pressures,
                        &flow->forces);
    if (parameters->stress)
        flow->stress = find_pore_stress(&flow->grains, &flow->cells, &flow->throats,
                                        &flow->conditions, &flow->pressures);
    return parameters->tensor ? find_columns(flow, &solving, reason) : STATUS_OK;
}

// Whether fluid is let, or sent, through a wall beside the drop.
static bool is_open_beside(const struct imposed *imposed)
{
    bool open = false;
    for (int wall = 0; wall < WALL_COUNT; wall++)
        open = open || (wall / 2 != imposed->along &&
                        (!isnan(imposed->pressure[wall]) ||
                         (!isnan(imposed->flux[wall]) && imposed->flux[wall] != 0)));
    return open;
}

// mu U / (drop over the length) along the drop, m2. NAN where no drop along an axis was
// imposed, or where grains that move or walls beside it drive flow as well.
static double permeability_of(const struct computation *flow,
                              const struct imposed *imposed)
{
    const int axis = imposed->along;
    if (axis == ALONG_NONE || !(fabs(imposed->drop) > 0) || flow->opening ||
        is_open_beside(imposed))
        return NAN;
    return component(flow->forces.velocity, axis) * flow->grains.unit *
           flow->grains.unit * component(flow->grains.box, axis) / imposed->drop;
}

// Share of the box along AXIS that the grains reach over. All of a box that repeats,
// which has no free end. Parts of grains beyond a wall do not count.
static double bed_share(const struct packing *packing, int axis)
{
    const double lower = component(packing->lower, axis);
    const double upper = component(packing->upper, axis);
    double from = upper, to = lower;
    for (int i = 0; i < packing->n_particle; i++) {
        const double x = component(packing->position[i], axis);
        from = fmax(lower, fmin(from, x - packing->radius[i]));
        to = fmin(upper, fmax(to, x + packing->radius[i]));
    }
    if (packing->periodic[axis] || packing->n_particle == 0) return 1;
    return (to - from) / (upper - lower);
}

// Fluid passes easily where there are no grains, as above a bed that has settled.
static void warn_of_empty_space(const struct packing *packing,
                                const struct imposed *imposed)
{
    static const double much = 0.95;
    for (int axis = 0; axis < 3 && imposed->along != ALONG_NONE; axis++) {
        const double share = bed_share(packing, axis);
        if (share >= much) continue;
        report("grains reach over %.2g of the box along %c: %s", share, "xyz"[axis],
               axis == imposed->along
                   ? "permeability is that of the whole box, bed_permeability that of "
                     "the bed"
                   : "fluid passes beside them, and permeability is not that of the "
                     "bed (end the box where the grains end: pack.lower, pack.upper)");
    }
}

static void write(const struct computation *computation,
                  const struct flow_parameters *parameters,
                  const struct invocation *invocation, const struct artifact *input)
{
    static const char *const rule[] = {"hydraulic radius", "effective radius",
                                       "open section"};
    static const char *const sides[] = {
        "no slip", "planes of symmetry",
        "planes of symmetry, throats narrower, as Yade"};
    const struct flow flow = {
        .packing = &computation->packing,
        .grains = &computation->grains,
        .cells = &computation->cells,
        .throats = &computation->throats,
        .pressures = &computation->pressures,
        .forces = &computation->forces,
        .opening = computation->opening,
        .viscosity = parameters->viscosity,
        .weight = scale(parameters->density, as_vector(parameters->gravity)),
        .permeability = permeability_of(computation, &parameters->imposed),
        .bed_share = parameters->imposed.along == ALONG_NONE
                         ? 1
                         : bed_share(&computation->packing, parameters->imposed.along),
        .permeability_columns =
            parameters->tensor ? computation->permeability_columns : NULL,
        .stress = parameters->stress ? &computation->stress : NULL};
    char model[700];
    snprintf(
        model, sizeof model,
        "Stokes flow on the regular triangulation [C], throats by %s\n"
        "walls: exact planes, %s\n"
        "pressures by %s, %d unknown, imbalance below %g of the flux\n"
        "%d grains hidden in others, %d flat cells, %d throats closed, %d pockets\n"
        "left out: inertia, viscous stress in the facets [C 17]%s\n",
        rule[parameters->conductance], sides[parameters->sides],
        flow.pressures->direct ? "Cholesky's factor"
                               : "conjugate gradients with a sampled factor",
        flow.pressures->n_unknown, parameters->tolerance, flow.cells->n_hidden,
        flow.cells->n_flat, flow.throats->n_closed, flow.pressures->n_pocket,
        flow.opening ? "" : ", motion of the grains");
    const bool all = parameters->output_kind == OUTPUT_FLOW;
    struct artifact *artifact =
        artifact_create(all ? "flow" : "forces", invocation->output);
    if (all)
        put_flow(artifact, &flow);
    else
        put_forces(artifact, &flow, (int)parameters->steps);
    artifact_finish(artifact, invocation, one_input(input), model);
}

static int estimate(struct invocation *invocation,
                    const struct flow_parameters *parameters)
{
    const struct body_size body = input_size(invocation, 0);
    const struct cost cost = cost_of_flow(body.grains, parameters->tensor ? 4 : 1);
    return end_with_estimate(invocation, &cost, &body);
}

int main(int argc, char **argv)
{
    struct flow_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    if (invocation.estimates) return estimate(&invocation, &parameters);
    struct artifact *input = artifact_open(invocation.inputs[0], "packing");
    struct computation flow = {.packing = artifact_get_solid_packing(input, "flow")};

    struct reason reason;
    const enum status status = compute(input, &parameters, &flow, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);
    if (!invocation.quiet) warn_of_empty_space(&flow.packing, &parameters.imposed);
    write(&flow, &parameters, &invocation, input);

    pore_stress_free(&flow.stress);
    forces_free(&flow.forces);
    pressures_free(&flow.pressures);
    throats_free(&flow.throats);
    cells_free(&flow.cells);
    grains_free(&flow.grains);
    free(flow.opening);
    packing_free(&flow.packing);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
