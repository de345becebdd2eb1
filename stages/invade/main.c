// SPDX-License-Identifier: GPL-3.0-or-later
// invade: which throat or node gas enters when, pressed in slowly through some walls.
//
// In this order: the walls of inlet and outlet are checked before anything is read;
// radii are drawn, if asked for; throats without clearance and those imposed empty are
// shut; entry pressures, invasion (network/invasion.h), its outcome, rings, transport;
// then the artifact. Of the summary:
//     trapped_saturation  = residual saturation without rings
//                           (volume of trapped clusters / of all),
//     breakthrough_share  = throats (or nodes) with an entry pressure up to the highest
//                           before breakthrough, over all that take part.
//
// Everything is quasi-static: gas enters the widest throat that it touches (under
// gravity the one of least entry pressure), and pressures are those of capillary
// equilibrium.
//
// It reads a network and writes it again, with what has come of it:
//     /events    (n_event) throat, node, pressure Pa, saturation after the event
//     /throats   (n_throat) event, cluster;   /nodes (n_node) event
//     /clusters  (n_cluster) throats, volume m3, trapped: the liquid that stays
//     /curve     (n_curve) pressure, saturation: pressures higher than all before
//     /rings     (n_ring) face, separation m, volume m3 in the end, if asked for
//     /transport (n) saturation and four relative properties, if asked for
//
// Traps: `rule` says what gas must enter, `liquid_in` what loses liquid when it does;
// any two go together. Conditions are completed before the network is read, so a
// liquid without surface tension is told at once.
#include "artifacts/artifact.h"
#include "artifacts/liquid.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "entry.h"
#include "network/drawn_radii.h"
#include "outcome.h"
#include "parameters/conditions.h"
#include "rings_left.h"
#include "transport.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

struct invade_parameters {
    struct conditions given; // what `entry` gets its liquid from
    struct invasion_conditions invasion;
    struct entry_conditions entry;
    struct drawn_radii radii;
    int rule, liquid_in, until, rings;
    bool transport;
    unsigned imposed_empty;
    int shut; // throats without clearance
};

enum { UNTIL_END, UNTIL_BREAKTHROUGH };

#define AT(member) offsetof(struct invade_parameters, member)
#define WALLS "-x|+x|-y|+y|-z|+z"

static const struct parameter table[] = {
    {"rule", PARAMETER_CHOICE, "1", "\"throats\"", AT(rule), .choices = "throats|nodes",
     .text = "what gas must enter: throats by their radii (drainage), or nodes, as "
             "wide as their widest throat"},
    {"liquid_in", PARAMETER_CHOICE, "1", "\"throats\"", AT(liquid_in),
     .choices = "throats|pores",
     .text = "what holds the liquid: throats, each until gas enters it; or pores, the "
             "halves of the throats at a node, until gas comes to the node (as in beds "
             "of grains, with tessellate.throat_volume=void)"},
    {"trapping", PARAMETER_BOOLEAN, "1", "true", AT(invasion.trapping),
     .text = "liquid leaves only through the outlet; liquid that gas has cut off from "
             "it stays"},
    {"until", PARAMETER_CHOICE, "1", "\"end\"", AT(until),
     .choices = "end|breakthrough",
     .text =
         "when to stop: when gas can enter nothing more, or first touches the outlet"},
    {"inlet", PARAMETER_CHOICES, "1", "[\"+z\"]", AT(invasion.inlet), .choices = WALLS,
     .text = "walls through which gas comes in"},
    {"outlet", PARAMETER_CHOICES, "1", "[\"-z\"]", AT(invasion.outlet),
     .choices = WALLS, .text = "walls through which liquid leaves"},
    {"rings", PARAMETER_CHOICE, "1", "\"none\"", AT(rings),
     .choices = "none|isolated|joined",
     .text = "liquid that stays around contacts where gas has come: none; rings that "
             "keep what they held when gas cut them off; or rings that films without "
             "resistance join to the rest, so that they drain as the pressure rises "
             "(trapping=false)"},
    {"transport", PARAMETER_BOOLEAN, "1", "false", AT(transport),
     .text = "compute how well gas and liquid flow, and diffuse, from inlet to outlet "
             "at saturations of 1, 0.9, 0.8, ... (relative permeability, effective "
             "diffusivity)"},
    {"imposed_empty", PARAMETER_CHOICES, "1", "[]", AT(imposed_empty),
     .choices = WALLS "|outer|inner",
     .text = "walls whose throats hold no liquid and let nothing through, as in dry"},
    DRAWN_RADII_ROWS(AT(radii)),
    FLUID_ROWS(AT(given)),
    SURFACE_TENSION_ROW(AT(given)),
    CONTACT_ANGLE_ROW(AT(given), 89.999),
    LIQUID_DENSITY_ROW(AT(given)),
    {"gravity", PARAMETER_NUMBER, "m s-2", "0", AT(entry.gravity), AT_LEAST(0),
     .text = "towards -z: liquid higher up gives way to gas more easily; 0: none"},
    {0}};

static const struct stage stage = {
    .name = "invade",
    .version = STAGE_VERSION,
    .summary = "invade -- invasion percolation: press gas slowly into a full network",
    .reads = "network",
    .writes = "invasion",
    .most_inputs = 1,
    .parameters = table};

// Share of the throats, or of the nodes that have a throat, with an entry pressure up
// to PRESSURE. At the percolation threshold this is the share of bonds, or sites, that
// must be open. Those are as easy that tie with it (basics/ranks.h): all of a lattice.
static double share_up_to(const struct network *network, const struct entry *entry,
                          enum invasion_rule rule, double pressure)
{
    const double with_ties = pressure + 0x1p-40 * fabs(pressure);
    int n = 0, all = 0;
    for (int i = 0; i < entry->n; i++) {
        const bool takes_part = rule == INVADE_THROATS
                                    ? network->throat_kind[i] == THROAT_NETWORK
                                    : isfinite(entry->pressure[i]); // has a throat
        all += takes_part;
        n += takes_part && entry->pressure[i] <= with_ties;
    }
    return (double)n / all;
}

// Events are counted from 0; `breakthrough` is how many there were before gas touched
// the outlet, below 0 if it never did. Without a breakthrough its numbers are left out,
// rather than given a value that looks like one. Trapped volume is a share of what
// stays, so that trapped_saturation is over the same volume as residual_saturation.
static void put_summary(struct artifact *artifact, const struct network *network,
                        const struct invasion_conditions *conditions,
                        const struct invasion *invasion, const struct outcome *outcome,
                        const struct entry *entry)
{
    const int n = invasion->breakthrough;
    double trapped = 0, left = 0, in_rings = 0;
    for (int c = 0; c < outcome->n_cluster; c++) {
        left += outcome->cluster_volume[c];
        if (outcome->cluster_trapped[c]) trapped += outcome->cluster_volume[c];
    }
    const double saturation = saturation_after(outcome, outcome->n);
    if (outcome->n && outcome->ring_saturation)
        in_rings = outcome->ring_saturation[outcome->n - 1];
    artifact_put_number(artifact, "/summary/inlet", conditions->inlet);
    artifact_put_number(artifact, "/summary/outlet", conditions->outlet);
    artifact_put_number(artifact, "/summary/residual_saturation", saturation);
    artifact_put_number(artifact, "/summary/trapped_saturation",
                        left > 0 ? (saturation - in_rings) * (trapped / left) : 0);
    if (outcome->ring_saturation)
        artifact_put_number(artifact, "/summary/ring_saturation", in_rings);
    if (n < 0) return;
    artifact_put_number(artifact, "/summary/breakthrough_event", n);
    artifact_put_number(artifact, "/summary/breakthrough_saturation",
                        saturation_after(outcome, n));
    if (n == 0) return;
    double highest = outcome->pressure[0];
    for (int k = 1; k < n; k++)
        highest = fmax(highest, outcome->pressure[k]);
    artifact_put_number(artifact, "/summary/breakthrough_pressure", highest);
    artifact_put_number(artifact, "/summary/breakthrough_share",
                        share_up_to(network, entry, conditions->rule, highest));
}

// Events of throats only by rule=throats; nodes are entered by either rule.
static void put_outcome(struct artifact *artifact, const struct network *network,
                        const struct invasion *invasion, const struct outcome *outcome)
{
    const int n = outcome->n, n_cluster = outcome->n_cluster;
    if (invasion->throat) artifact_put(artifact, "/events/throat", invasion->throat, n);
    artifact_put(artifact, "/events/node", invasion->node, n);
    artifact_put(artifact, "/events/pressure", outcome->pressure, n);
    artifact_put(artifact, "/events/saturation", outcome->saturation, n);
    artifact_put(artifact, "/throats/event", outcome->throat_event, network->n_throat);
    artifact_put(artifact, "/nodes/event", outcome->node_event, network->n_node);
    artifact_put(artifact, "/throats/cluster", outcome->throat_cluster,
                 network->n_throat);
    artifact_put(artifact, "/clusters/throats", outcome->cluster_throats, n_cluster);
    artifact_put(artifact, "/clusters/volume", outcome->cluster_volume, n_cluster);
    artifact_put(artifact, "/clusters/trapped", outcome->cluster_trapped, n_cluster);
    artifact_put(artifact, "/curve/pressure", outcome->curve_pressure,
                 outcome->n_curve);
    artifact_put(artifact, "/curve/saturation", outcome->curve_saturation,
                 outcome->n_curve);
    artifact_put_vtk(artifact, "/nodes/position", network->n_node,
                     (const char *const[]){"/nodes/kind", "/nodes/event", NULL},
                     (const int32_t(*)[2])network->throat_nodes, network->n_throat,
                     (const char *const[]){"/throats/radius", "/throats/kind",
                                           "/throats/event", "/throats/cluster", NULL});
}

// The rings that hold liquid in the end.
static void put_rings(struct artifact *artifact, const struct network *network,
                      const struct outcome *outcome, const struct rings_left *left)
{
    double *whole = NEW_ARRAY(double, network->n_face);
    for (int k = 0; k < left->rings.n_part; k++)
        whole[left->rings.parts.face[k]] += left->part[k];
    int32_t *face = NEW_ARRAY(int32_t, network->n_face);
    double *separation = NEW_ARRAY(double, network->n_face);
    int n = 0;
    for (int f = 0; f < network->n_face; f++) {
        if (!(whole[f] > 0)) continue;
        face[n] = f;
        separation[n] = left->rings.separation[f];
        whole[n++] = whole[f];
    }
    artifact_put(artifact, "/rings/face", face, n);
    artifact_put(artifact, "/rings/separation", separation, n);
    artifact_put(artifact, "/rings/volume", whole, n);
    artifact_put(artifact, "/events/ring_saturation", outcome->ring_saturation,
                 outcome->n);
    artifact_put(artifact, "/curve/ring_saturation", outcome->curve_rings,
                 outcome->n_curve);
    free(whole);
    free(face);
    free(separation);
}

// Relative to the network full of that phase; numbers of a material only where there
// are any (transport.c).
static void put_transport(struct artifact *artifact, const struct transport *transport)
{
    static const char *const name[PHASES][PROPERTIES] = {
        {"/transport/gas_permeability", "/transport/gas_diffusivity"},
        {"/transport/liquid_permeability", "/transport/liquid_diffusivity"}};
    artifact_put(artifact, "/transport/saturation", transport->saturation,
                 transport->n);
    for (int k = 0; k < PHASES * PROPERTIES; k++)
        artifact_put(artifact, name[k / PROPERTIES][k % PROPERTIES],
                     transport->relative[k / PROPERTIES][k % PROPERTIES], transport->n);
    artifact_put_number(artifact, "/summary/hydraulic_conductance",
                        transport->conductance[PERMEABILITY]);
    artifact_put_number(artifact, "/summary/diffusive_conductance",
                        transport->conductance[DIFFUSIVITY]);
    if (isnan(transport->material[PERMEABILITY])) return;
    artifact_put_number(artifact, "/summary/permeability",
                        transport->material[PERMEABILITY]);
    artifact_put_number(artifact, "/summary/diffusivity",
                        transport->material[DIFFUSIVITY]);
}

static const char *describe_rings(const struct invade_parameters *parameters,
                                  const struct rings_left *left, char *text,
                                  size_t size)
{
    *text = 0;
    if (parameters->rings != RINGS_NONE)
        snprintf(text, size,
                 "rings stay around contacts and in gaps, exact bridges %s; throats "
                 "that hold less in them than these ask for: %d\n",
                 parameters->rings == RINGS_ISOLATED
                     ? "at the suction that cut them off"
                     : "at the highest pressure so far, joined by films",
                 left->limited);
    return text;
}

static const char *describe(const struct invade_parameters *parameters,
                            const struct rings_left *left, char *text, size_t size)
{
    const unsigned shown = 1u << FLUID_SURFACE_TENSION | 1u << FLUID_DENSITY;
    char gravity[60], fluid[300], radii[RADII_TEXT], rings[200];
    snprintf(gravity, sizeof gravity, "gravity: %.17g m/s2\n",
             parameters->entry.gravity);
    snprintf(
        text, size,
        "invasion percolation (Wilkinson & Willemsen 1983): gas enters the %s it "
        "touches that takes the least pressure, of equals the shorter, then the "
        "smaller, then the higher\n"
        "liquid is held by %s\n%s"
        "%s\n%s"
        "%s, contact angle %.6g degrees\n"
        "%s"
        "throats without clearance, shut to gas and liquid: %d\n"
        "left out: viscosity, evaporation, compressibility, %ssnap-off%s",
        parameters->rule == INVADE_THROATS ? "throat" : "node",
        parameters->liquid_in == HELD_BY_PORES ? "pores, halves of throats at nodes"
                                               : "throats",
        describe_rings(parameters, left, rings, sizeof rings),
        parameters->invasion.trapping
            ? "trapping: liquid leaves only through the outlet (Masson 2016)"
            : "no trapping: liquid leaves from anywhere",
        parameters->entry.gravity > 0 ? gravity : "",
        conditions_describe(&parameters->given, shown, fluid, sizeof fluid),
        parameters->given.contact_angle, describe_cut_radii(&parameters->radii, radii),
        parameters->shut, parameters->rings == RINGS_JOINED ? "" : "films, ",
        parameters->entry.gravity > 0 ? "" : ", gravity");
    return text;
}

// The density counts only under gravity; entry pressures always need the tension.
static unsigned needed_properties(const struct invade_parameters *parameters)
{
    return 1u << FLUID_SURFACE_TENSION |
           (parameters->entry.gravity > 0 ? 1u << FLUID_DENSITY : 0);
}

static void complete_entry(struct invade_parameters *parameters)
{
    struct conditions *given = &parameters->given;
    struct entry_conditions *entry = &parameters->entry;
    conditions_require(given, needed_properties(parameters), "invade");
    entry->surface_tension = given->property[FLUID_SURFACE_TENSION];
    entry->contact_angle = given->contact_angle;
    entry->liquid_density = given->property[FLUID_DENSITY];
}

// Before anything is read. Films would let trapped liquid out.
static void check_rings(const struct invade_parameters *parameters)
{
    if (parameters->rings != RINGS_JOINED) return;
    if (parameters->invasion.trapping)
        die(STATUS_BAD_DATA,
            "invade.trapping: must be false with rings=joined: liquid that films join "
            "is not trapped");
    if (parameters->entry.gravity > 0)
        die(STATUS_BAD_DATA,
            "invade.gravity: must be 0 with rings=joined, is %g m/s2; rings=isolated "
            "goes with gravity",
            parameters->entry.gravity);
}

// Before anything is read. Trapping without an outlet would keep all liquid in.
static void check_walls(const struct invasion_conditions *conditions, bool transport)
{
    if (transport && conditions->outlet == 0)
        die(STATUS_BAD_DATA,
            "invade.outlet: must name a wall for transport, names none");
    if (conditions->inlet == 0)
        die(STATUS_BAD_DATA, "invade.inlet: must name a wall, names none");
    if (conditions->inlet & conditions->outlet)
        die(STATUS_BAD_DATA,
            "invade.outlet: must have no wall in common with the inlet");
}

static struct network network_with_sides(struct artifact *input,
                                         const struct invade_parameters *parameters,
                                         bool quiet)
{
    const struct network network = artifact_get_periodic_network(input);
    refuse_repeated(input, &network, parameters->invasion.inlet, "invade.inlet");
    refuse_repeated(input, &network, parameters->invasion.outlet, "invade.outlet");
    if (!quiet)
        report_repeated(input, &network, parameters->imposed_empty,
                        "invade.imposed_empty");
    return network;
}

static enum status leave_rings(const struct network *network,
                               const struct invade_parameters *parameters,
                               struct rings_left *left, struct outcome *outcome,
                               struct reason *reason)
{
    const struct entry_conditions *entry = &parameters->entry;
    const struct ring_liquid liquid = {.surface_tension = entry->surface_tension,
                                       .contact_angle =
                                           entry->contact_angle * (M_PI / 180)};
    const double weight =
        entry->gravity > 0 ? entry->liquid_density * entry->gravity : 0;
    const enum status status =
        rings_left_init(network, outcome, (enum ring_supply)parameters->rings, &liquid,
                        weight, left, reason);
    if (!status) outcome_add_rings(outcome, left->volume);
    return status;
}

// Exits 65 at a network with liquid, as all throats are taken for full.
static struct artifact *open_full_network(const char *path)
{
    struct artifact *input = artifact_open(path, "network");
    refuse_saturation(input,
                      "gas is pressed into a body that is full of liquid: give a "
                      "network that tessellate or merge-nodes made of it");
    return input;
}

int main(int argc, char **argv)
{
    struct invade_parameters parameters = {.given = conditions_unset()};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    struct invasion_conditions *conditions = &parameters.invasion;
    omp_set_num_threads(invocation.threads);
    conditions->rule = (enum invasion_rule)parameters.rule;
    conditions->until_breakthrough = parameters.until == UNTIL_BREAKTHROUGH;
    check_walls(conditions, parameters.transport);
    check_rings(&parameters);
    complete_entry(&parameters);
    struct artifact *input = open_full_network(invocation.inputs[0]);
    struct network network = network_with_sides(input, &parameters, invocation.quiet);

    struct reason reason;
    if (give_radii(&network, &parameters.radii, invocation.parameters, &reason))
        die(STATUS_BAD_DATA, "invade.%s", reason.text);
    if (!invocation.quiet) report_cut_radii(&parameters.radii);
    impose_empty_throats(&network, parameters.imposed_empty);
    parameters.shut = shut_closed_throats(&network);
    struct entry entry;
    struct invasion invasion = {0};
    enum status status =
        entry_init(&network, conditions->rule, &parameters.entry, &entry, &reason);
    conditions->entry_priority = entry.entry_priority;
    if (!status) status = invade(&network, conditions, &invasion, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);
    struct outcome outcome =
        outcome_init(&network, conditions, &invasion, entry.pressure,
                     (enum held_by)parameters.liquid_in);
    struct rings_left left = {0};
    if (parameters.rings != RINGS_NONE)
        status = leave_rings(&network, &parameters, &left, &outcome, &reason);
    struct transport transport = {0};
    if (!status && parameters.transport)
        status = transport_find(&network, conditions, &outcome, &transport, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);

    char model[1800];
    struct artifact *artifact = artifact_create("invasion", invocation.output);
    artifact_put_network(artifact, &network);
    put_outcome(artifact, &network, &invasion, &outcome);
    put_summary(artifact, &network, conditions, &invasion, &outcome, &entry);
    artifact_put_number(artifact, "/summary/shut_throats", parameters.shut);
    if (parameters.rings != RINGS_NONE) put_rings(artifact, &network, &outcome, &left);
    if (parameters.transport) put_transport(artifact, &transport);
    artifact_finish(artifact, &invocation, one_input(input),
                    describe(&parameters, &left, model, sizeof model));
    if (!invocation.quiet)
        conditions_note(&parameters.given, needed_properties(&parameters));

    transport_free(&transport);
    rings_left_free(&left);
    outcome_free(&outcome);
    invasion_free(&invasion);
    entry_free(&entry);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
