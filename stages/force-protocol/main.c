// SPDX-License-Identifier: GPL-3.0-or-later
// force-protocol: the capillary force on every grain over the time of drying.
//
// In this order: read the network; complete the liquid from the drying; find the law of
// suction; find the sectors around throats, and from them what each throat's load does
// to each grain, and the rings (find_action); read the drying, and find the weight of
// the liquid; choose the times (choose_times); write the packing, sum the loads at each
// time and write the forces at once (put_forces), without auxiliary grains; write what
// was found out on the way.
//
// For a liquid with surface tension gamma and contact angle theta
//
//     meniscus     = 2 gamma cos(theta)             N/m: over r it is a suction
//     uniform      = meniscus / mean throat radius  Pa: of pressure=uniform
//     contact_line = gamma sin(theta)               N/m, along the grain [K 3.14]
//     weight       = gravity times liquid density   N/m3
//
// It reads a drying: its network, /history, /changes, the nodes that gas touches from
// the beginning, with pressure=field the pressures of its snapshots, and the liquid. It
// writes the packing without auxiliary grains, /time and /saturation (n_time), /force
// (n_time, n_particle) in N, and with gravity /liquid_mass (n_time, n_particle) in kg.
//
// Why this order: what a throat does to a grain (its patches) depends on geometry alone
// and is found once; what the liquid does (its loads) changes with time. So a force is
// a short sum at each time. The drying is read when the balance of the patches, which
// takes the most memory, is over. Auxiliary grains bound cells and must be there until
// all forces are summed. The size of the result is checked before anything is written.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "artifacts/liquid.h"
#include "balance.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "geometry/auxiliary.h"
#include "liquid_weight.h"
#include "network/checks.h"
#include "parameters/estimate.h"
#include "pendular_rings.h"
#include "protocol.h"
#include "read_record.h"
#include "times.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum open_surface { OPEN_SURFACE_IDLE, OPEN_SURFACE_PULLS };

// What the table reads into; NAN: not given, and taken from the drying. The int members
// are places of choices, cast to enums of the same order.
struct force_parameters {
    double surface_tension, contact_angle, force_scale, largest_change, ring_volume,
        most_bytes, gravity;
    int open_surface, form, suction, rings;
    bool balanced;
    int64_t steps;
};
#define AT(member) offsetof(struct force_parameters, member)

static const struct parameter table[] = {
    {"surface_tension", PARAMETER_NUMBER, "N m-1", "null", AT(surface_tension),
     ABOVE(0), .shared = true,
     .text = "of the liquid against the gas; null: that of the drying"},
    {"contact_angle", PARAMETER_NUMBER, "degree", "null", AT(contact_angle),
     BETWEEN(0, 89.999), .shared = true,
     .text = "imperfect wetting: menisci are less curved, and the contact line pulls "
             "the grains towards the middle of the throat [K 3.14-3.18]; null: that "
             "of the drying"},
    {"force_scale", PARAMETER_NUMBER, "1", "1", AT(force_scale), AT_LEAST(0),
     .text = "factor on the physical force; K's own was chosen and is not given"},
    {"form", PARAMETER_CHOICE, "1", "\"solid-angle\"", AT(form),
     .choices = "solid-angle|faces|centres|arcs",
     .text =
         "how the liquid of a throat pulls a grain: by its suction on the part of the "
         "grain that faces it; by that and the pull of the menisci (faces), so that "
         "grains pull each other in pairs; by K's plain sums: towards the middles of "
         "the throats [K 5.1], or in a layer over the arcs of a circle [K 3.20]"},
    {"balanced", PARAMETER_BOOLEAN, "1", "true", AT(balanced),
     .text = "correct the pulls of the form as little as possible, so that the forces "
             "and moments of each throat on the grains around it sum to zero; on cubic "
             "lattices nothing changes"},
    {"pressure", PARAMETER_CHOICE, "1", "\"uniform\"", AT(suction),
     .choices = "uniform|clusters|field",
     .text = "suction of the liquid: uniform, that of a throat of mean radius; in each "
             "cluster that of its widest meniscus; or the field of viscous liquid, "
             "from the snapshots of the drying (dry.snapshots)"},
    {"open_surface", PARAMETER_CHOICE, "1", "\"idle\"", AT(open_surface),
     .choices = "idle|pulls",
     .text = "throats that lie in the open wall: their liquid has its menisci over the "
             "grains and does not pull them outwards (K 5.4: a full network presses "
             "its open top as well), or it pulls like any other"},
    {"gravity", PARAMETER_NUMBER_OR_NULL, "m s-2", "null", AT(gravity), AT_LEAST(0),
     .text = "towards -z: the grains around each throat carry the weight of its "
             "liquid, and with pressure=clusters the suction grows with height; null: "
             "that of the drying (dry.gravity); 0: the liquid weighs nothing"},
    {"steps", PARAMETER_INTEGER, "1", "550", AT(steps), BETWEEN(2, 1e7),
     .text =
         "uniform times from the start to the end of drying, both included [K 5.2]"},
    {"largest_change", PARAMETER_NUMBER, "1", "0", AT(largest_change), BETWEEN(0, 1),
     .text = "0: uniform times; else the fewest times between which no force on a "
             "grain changes by more than this share of the largest force"},
    {"most_bytes", PARAMETER_NUMBER, "1", "4e9", AT(most_bytes), ABOVE(0),
     .text = "most bytes of forces to write, 24 per grain and time; more are refused "
             "at once"},
    {"rings.left", PARAMETER_CHOICE, "1", "\"none\"", AT(rings),
     .choices = "none|volume|suction|drying",
     .text =
         "liquid that stays at contacts as throats empty: none, a given volume, as "
         "much as is in equilibrium with liquid in a throat of mean radius, or what "
         "the drying left there (dry.rings), which dries in the end"},
    {"rings.volume", PARAMETER_NUMBER, "1", "1e-3", AT(ring_volume), BETWEEN(1e-9, 1),
     .text = "left=volume: volume of a ring over the cube of the effective radius 2 R1 "
             "R2/(R1 + R2)"},
    {0}};

static const struct stage stage = {
    .name = "force-protocol",
    .version = STAGE_VERSION,
    .summary =
        "force-protocol -- the capillary force on every grain over time [K 3.6, 5.3]",
    .reads = "drying",
    .writes = "forces",
    .most_inputs = 1,
    .parameters = table,
    .estimates = ESTIMATES_SIZES};

// Takes from the drying each property of the liquid that was not given. DIFFERENCE says
// which given ones are not those of the drying. Only the tension has no default: an
// angle of 0 is what a drying without one means.
static void complete_liquid(struct force_parameters *parameters,
                            const struct artifact *input, char *difference, size_t size)
{
    const struct liquid_properties has = artifact_get_liquid(input);
    struct liquid_properties told = {.surface_tension = parameters->surface_tension,
                                     .contact_angle = parameters->contact_angle};
    liquid_complete(&told, &has);
    if (isnan(told.surface_tension))
        die(STATUS_BAD_DATA,
            "force-protocol.surface_tension: must be given in N/m: %s does not say it",
            input_name(input->path));
    if (isnan(told.contact_angle)) told.contact_angle = 0;
    parameters->surface_tension = told.surface_tension;
    parameters->contact_angle = told.contact_angle;
    liquid_differs(&told, &has, "the drying", difference, size);
}

// Times are shares of the end: it must not vanish when divided by the number of steps.
static void check_end(const struct drying_record *record, double steps,
                      const char *path)
{
    const double end = record->time[record->n_step - 1];
    if (!(end / steps > 0))
        die(STATUS_BAD_DATA, "%s: /history/time: must end above 0, got %g",
            input_name(path), end);
}

// Plain mean over the throats that may hold liquid, as K has it.
static double mean_throat_radius(const struct network *network, const char *path)
{
    double sum = 0;
    int count = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK) continue;
        sum += network->throat_radius[t];
        count++;
    }
    if (!(sum > 0))
        die(STATUS_BAD_DATA, "%s: /throats/radius: no open throat to hold liquid",
            input_name(path));
    return sum / count;
}

// Without a contact angle the contact line pulls along the grain only [K 3.6]. Checked
// before any force is made: an overflow there would be a force of infinity on a grain.
static struct suction_law find_law(const struct network *network,
                                   const struct force_parameters *parameters,
                                   const char *path)
{
    const double angle = parameters->contact_angle * (M_PI / 180);
    const double meniscus = 2 * parameters->surface_tension * cos(angle);
    const struct suction_law law = {
        .rule = (enum suction_rule)parameters->suction,
        .uniform = meniscus / mean_throat_radius(network, path),
        .meniscus = meniscus,
        .contact_line = parameters->surface_tension * sin(angle)};
    if (!(law.uniform * fmax(1, parameters->force_scale) <= 1e150))
        die(STATUS_BAD_DATA,
            "%s: the forces overflow at a capillary pressure of %g Pa and "
            "force_scale = %g",
            input_name(path), law.uniform, parameters->force_scale);
    return law;
}

// The parameters of the drying, of what the artifact has no number of its own for; NULL
// if it does not say. The caller gives them back with json_decref.
static json_t *parameters_of_drying(const struct artifact *input)
{
    char *text = artifact_get_text(input, "parameters");
    json_t *parameters = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    return parameters;
}

// The gravity with which the drying was computed; 0 if it does not say.
static double gravity_of_drying(const json_t *drying)
{
    const double gravity = json_number_value(json_object_get(drying, "gravity"));
    return gravity > 0 ? gravity : 0;
}

// Whether films without resistance joined all liquid in the drying.
static bool films_joined(const json_t *drying)
{
    const char *rings = json_string_value(json_object_get(drying, "rings"));
    return rings && !strcmp(rings, "joined");
}

// The density follows from the mass of liquid and the volume it filled, so that it is
// that of the drying.
static void find_weight(const struct network *network,
                        const struct liquid_record *record, double gravity,
                        const struct artifact *input, struct suction_law *law)
{
    struct reason reason;
    if (check_gravity(network, gravity, &reason))
        die(STATUS_BAD_DATA, "force-protocol.%s", reason.text);
    const double mass = artifact_get_number(input, "/summary/liquid_mass");
    law->weight = gravity * liquid_density(network, record, mass);
}

// Balancing corrects the suction's patches alone: contact lines and weights have no
// form to choose. Patches in an open wall are dropped after balancing, so that a throat
// there pulls on no grain at all.
static enum status find_action(struct sectors *sectors,
                               const struct force_parameters *parameters,
                               double suction, unsigned open_walls,
                               struct throat_loads *loads, struct pendular_rings *rings,
                               struct reason *reason)
{
    const struct ring_law law = {.rule = (enum ring_rule)parameters->rings,
                                 .volume = parameters->ring_volume,
                                 .suction = suction,
                                 .surface_tension = parameters->surface_tension,
                                 .contact_angle =
                                     parameters->contact_angle * (M_PI / 180)};
    if (parameters->form == FORM_ARCS && !sectors->layer)
        return refuse(reason, STATUS_BAD_DATA,
                      "/faces/particles: form=arcs needs the network of a layer "
                      "(tessellate.dimensions=2)");
    const bool has_rings = law.rule != RING_NONE && law.rule != RING_DRYING;
    const bool is_last =
        !(parameters->contact_angle > 0) && !(parameters->gravity > 0) && !has_rings;
    *loads = (struct throat_loads){.scale = parameters->force_scale};
    *rings = (struct pendular_rings){0};
    struct patches *of = loads->patches;
    if (parameters->balanced) {
        const enum status status =
            find_balanced_patches(sectors, (enum form)parameters->form, is_last,
                                  &of[LOAD_SUCTION], &loads->balance_change, reason);
        if (status) return status;
    } else
        of[LOAD_SUCTION] = find_patches(sectors, (enum form)parameters->form);
    if (parameters->contact_angle > 0)
        of[LOAD_CONTACT_LINE] = find_contact_lines(sectors);
    for (int l = 0; l < LOAD_EMPTINESS; l++) {
        const enum status status = check_patches(&of[l], reason);
        if (status) return status;
        if (parameters->open_surface == OPEN_SURFACE_IDLE)
            drop_patches_in_walls(sectors, open_walls, &of[l]);
    }
    if (parameters->gravity > 0) of[LOAD_WEIGHT] = find_liquid_shares(sectors);
    if (!has_rings) return STATUS_OK;
    const enum status status = find_pendular_rings(sectors, &law, rings, reason);
    of[LOAD_EMPTINESS] = rings->patches;
    return status;
}

// Before anything large is allocated.
static void refuse_size(const struct force_parameters *parameters, double times,
                        double bytes, double grains)
{
    const bool adaptive = parameters->largest_change > 0;
    die(STATUS_BAD_DATA,
        "force-protocol.%s: %g takes %.3g times, which are %.3g bytes of forces on %g "
        "grains: more than force-protocol.most_bytes = %g",
        adaptive ? "largest_change" : "steps",
        adaptive ? parameters->largest_change : times, times, times * bytes, grains,
        parameters->most_bytes);
}

// Three doubles a grain and time for the force, one more for the mass of the liquid.
// The caller frees the times.
static double *choose_times(const struct process *process,
                            const struct force_parameters *parameters, int *n_time)
{
    const double grains = process->network->packing.n_particle;
    const double bytes = parameters->gravity > 0 ? 32 : 24; // a grain and time
    const int most = (int)fmin(1e9, parameters->most_bytes / (bytes * fmax(1, grains)));
    double count = (double)parameters->steps, *times = NULL;
    if (parameters->largest_change > 0)
        times = adaptive_times(process, parameters->largest_change, most, &count);
    else if (count <= most)
        times = uniform_times(&process->record->drying, (int)count);
    if (!times) refuse_size(parameters, count, bytes * grains, grains);
    *n_time = (int)count;
    return times;
}

// What is said of the forces.
struct findings {
    struct measures measures;
    double error; // N, of interpolation
    double net_force, net_moment;
    double field_error; // NAN: there is no field, or no more than two snapshots of it
};

static struct findings find(const struct protocol *protocol)
{
    const struct measures *measures = &protocol->measures;
    const struct process *process = protocol->process;
    return (struct findings){
        .measures = *measures,
        .error = protocol->interpolation.worst,
        .net_force = net_force(measures),
        .net_moment = net_moment(measures, &process->network->packing),
        .field_error =
            process->law->rule == SUCTION_FIELD ? field_error(&protocol->liquid) : NAN};
}

// A time after the other, N_PARTICLE grains written of each.
static struct findings put_forces(struct artifact *artifact,
                                  const struct process *process, const double *time,
                                  int n_time, int n_particle, const char *path)
{
    const struct packing *packing = &process->network->packing;
    struct protocol protocol = protocol_begin(process, time, n_time);
    struct row_writer rows =
        artifact_begin_rows(artifact, "/force", n_time, n_particle);
    while (protocol_next(&protocol)) {
        if (!(protocol.measures.force <= 1e150))
            die(STATUS_BAD_DATA,
                "%s: the forces overflow at a capillary pressure of %g Pa and "
                "force_scale = %g",
                input_name(path), process->law->uniform, process->loads->scale);
        copy_without_auxiliary(packing, protocol.force, sizeof *protocol.force,
                               artifact_next_row(&rows));
    }
    artifact_end_rows(&rows);
    const struct findings found = find(&protocol);
    protocol_free(&protocol);
    return found;
}

static void put_liquid_masses(struct artifact *artifact, const struct process *process,
                              const double *time, int n_time, int n_particle,
                              double gravity)
{
    const struct packing *packing = &process->network->packing;
    double *mass = NEW_ARRAY(double, packing->n_particle);
    struct liquid_loads liquid =
        liquid_loads_begin(process->network, process->record, process->law);
    struct row_writer rows =
        artifact_begin_rows(artifact, "/liquid_mass", n_time, n_particle);
    for (int m = 0; m < n_time; m++) {
        liquid_loads_to(&liquid, time[m]);
        liquid_masses(&liquid, &process->loads->patches[LOAD_WEIGHT], gravity, mass);
        copy_without_auxiliary(packing, mass, sizeof *mass, artifact_next_row(&rows));
    }
    artifact_end_rows(&rows);
    liquid_loads_free(&liquid);
    free(mass);
}

// Changes and errors over the largest force, so that they are numbers without a unit.
static void put_summary(struct artifact *artifact, const struct process *process,
                        const struct findings *found, double gravity,
                        const struct artifact *input)
{
    const double largest = found->measures.force, unit = largest > 0 ? largest : 1;
    artifact_put_number(artifact, "/summary/capillary_pressure", process->law->uniform);
    artifact_put_number(artifact, "/summary/force_scale", process->loads->scale);
    artifact_put_number(artifact, "/summary/largest_force", largest);
    artifact_put_number(artifact, "/summary/largest_change",
                        found->measures.change / unit);
    artifact_put_number(artifact, "/summary/interpolation_error", found->error / unit);
    if (!isnan(found->field_error))
        artifact_put_number(artifact, "/summary/field_error", found->field_error);
    if (gravity > 0) artifact_put_number(artifact, "/summary/gravity", gravity);
    artifact_put_number(artifact, "/summary/balance_change",
                        process->loads->balance_change);
    artifact_put_number(artifact, "/summary/net_force", found->net_force);
    artifact_put_number(artifact, "/summary/net_moment", found->net_moment);
    artifact_put_number(artifact, "/summary/first_period_end_time",
                        artifact_get_number(input, "/summary/first_period_end_time"));
}

// The model in words. Texts are in the order of the choices in the table; a new choice
// needs a text here, or the next one's is printed.
static void describe(const struct force_parameters *parameters, const char *difference,
                     const struct pendular_rings *rings, char *text, size_t size)
{
    static const char *const forms[] = {
        "S p_c R^2 n over the patch facing each throat",
        "S p_c over the faces between grains, menisci included",
        "S p_c R^2 towards the middle of each throat [K 5.1]",
        "S p_c R^2 n over the arc facing each throat [K 3.20]"};
    static const char *const suctions[] = {
        "one capillary pressure, that of a throat of mean radius",
        "capillary pressure of each connected piece of liquid, by its widest meniscus",
        "capillary pressures of viscous liquid, from snapshots of the drying"};
    static const char *const heights[] = {"the same at all heights",
                                          "growing with height",
                                          "with height as in the drying"};
    char left[200] = "no liquid stays at contacts";
    if (parameters->rings == RING_DRYING)
        snprintf(
            left, sizeof left,
            "rings stay where the drying left them, and pull until they have dried");
    else if (parameters->rings != RING_NONE)
        snprintf(left, sizeof left,
                 "rings stay at %d contacts as throats empty, pull with at most %.6g N "
                 "and do not evaporate",
                 rings->count, rings->largest);
    char weight[200] = "left out: weight of the liquid";
    if (parameters->gravity > 0)
        snprintf(weight, sizeof weight,
                 "weight of the liquid: gravity %.17g m/s2, on the grains around each "
                 "throat; suction %s",
                 parameters->gravity, heights[parameters->suction]);
    snprintf(text, size,
             "capillary force: %s%s\n"
             "throats in the open wall: %s\n"
             "%s\n"
             "liquid: surface tension %.6g N/m, contact angle %.6g degrees%s%s\n"
             "contact line: %s\n"
             "%s\n"
             "%s\n",
             forms[parameters->form],
             parameters->balanced ? ", balanced at each throat" : "",
             parameters->open_surface == OPEN_SURFACE_IDLE ? "do not pull" : "pull",
             suctions[parameters->suction], parameters->surface_tension,
             parameters->contact_angle, *difference ? "; given: " : "", difference,
             parameters->contact_angle > 0 ? "pulls grains towards throats with menisci"
                                           : "none (perfect wetting)",
             left, weight);
}

// LIQUID is what the forces were computed with, for the stages behind.
static void write_forces(const struct process *process, const double *time, int n_time,
                         double gravity, const struct liquid_properties *liquid,
                         const char *model, const struct invocation *invocation,
                         const struct artifact *input)
{
    struct packing packing = without_auxiliary(&process->network->packing);
    double *saturation = saturations_at(&process->record->drying, time, n_time);
    struct artifact *artifact = artifact_create("forces", invocation->output);
    artifact_put_packing(artifact, &packing);
    artifact_put_liquid(artifact, liquid);
    artifact_put(artifact, "/time", time, n_time);
    artifact_put(artifact, "/saturation", saturation, n_time);
    const struct findings found =
        put_forces(artifact, process, time, n_time, packing.n_particle, input->path);
    if (gravity > 0)
        put_liquid_masses(artifact, process, time, n_time, packing.n_particle, gravity);
    put_summary(artifact, process, &found, gravity, input);
    artifact_finish(artifact, invocation, one_input(input), model);
    packing_free(&packing);
    free(saturation);
}

// Times by largest_change are found only from the drying: as many as uniform ones are
// expected.
static int estimate(struct invocation *invocation,
                    const struct force_parameters *parameters)
{
    struct body_size body = input_size(invocation, 0);
    if (!(body.changes > 0)) body.changes = recorded_changes(&body, NAN);
    body.loads = (double)parameters->steps;
    const struct cost cost = cost_of_forces(&body);
    return end_with_estimate(invocation, &cost, &body);
}

static void warn_of_rings(const struct pendular_rings *rings, double suction)
{
    if (rings->cut_off)
        report("rings.left=suction: at %.3g Pa, of a throat of mean radius, %d of %d "
               "rings would hold more than the cube of their effective radius, and are "
               "taken to hold that: rings.left=volume says how much rings hold",
               suction, rings->cut_off, rings->count);
}

int main(int argc, char **argv)
{
    struct force_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    omp_set_num_threads(invocation.threads);
    if (invocation.estimates) return estimate(&invocation, &parameters);
    struct artifact *input = artifact_open(invocation.inputs[0], "drying");
    struct network network = artifact_get_periodic_network(input);
    forget_throat_shapes(&network); // a third of it
    char difference[300], model[1400];
    complete_liquid(&parameters, input, difference, sizeof difference);
    struct suction_law law = find_law(&network, &parameters, input->path);
    json_t *drying = parameters_of_drying(input);
    law.joined = films_joined(drying);
    if (isnan(parameters.gravity)) parameters.gravity = gravity_of_drying(drying);
    json_decref(drying);
    if (*difference && !invocation.quiet) report("%s", difference);

    struct sectors sectors;
    struct throat_loads loads = {0};
    struct pendular_rings rings = {0};
    struct reason reason;
    enum status status = sectors_find(&network, &sectors, &reason);
    if (parameters.rings != RING_DRYING) sectors.spare = &network;
    if (!status)
        status =
            find_action(&sectors, &parameters, law.uniform,
                        (unsigned)artifact_get_number(input, "/summary/open_walls"),
                        &loads, &rings, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);
    sectors_free(&sectors);
    if (!invocation.quiet) warn_of_rings(&rings, law.uniform);

    struct liquid_record record =
        read_record(input, &network, parameters.suction == SUCTION_FIELD,
                    parameters.rings == RING_DRYING ||
                        (parameters.gravity > 0 && artifact_has_rings(input)));
    check_end(&record.drying, (double)parameters.steps, input->path);
    if (parameters.rings == RING_DRYING)
        status = drying_rings_init(&network, &record.rings, parameters.surface_tension,
                                   parameters.contact_angle * (M_PI / 180),
                                   &loads.rings, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);
    find_weight(&network, &record, parameters.gravity, input, &law);
    const struct process process = {&network, &record, &law, &loads};
    int n_time;
    double *time = choose_times(&process, &parameters, &n_time);
    describe(&parameters, difference, &rings, model, sizeof model);
    struct liquid_properties liquid = artifact_get_liquid(input);
    liquid.surface_tension = parameters.surface_tension;
    liquid.contact_angle = parameters.contact_angle;
    write_forces(&process, time, n_time, parameters.gravity, &liquid, model,
                 &invocation, input);

    free(time);
    throat_loads_free(&loads);
    free_record(&record);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
