// SPDX-License-Identifier: GPL-3.0-or-later
// force-protocol: the capillary force on every grain over the time of drying.
#include "artifacts/artifact.h"
#include "auxiliary.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "protocol.h"

#include <stdio.h>
#include <stdlib.h>

enum open_surface { OPEN_SURFACE_IDLE, OPEN_SURFACE_PULLS };

struct force_parameters {
    double surface_tension, force_scale;
    int open_surface;
    int64_t steps;
};

static const struct parameter table[] = {
    {"surface_tension", PARAMETER_NUMBER, "N m-1", "0.07274", BOUND_ABOVE, 0, 0, NULL,
     "of the liquid against the gas [K Table 3.1]",
     offsetof(struct force_parameters, surface_tension)},
    {"force_scale", PARAMETER_NUMBER, "1", "1", BOUND_MINIMUM, 0, 0, NULL,
     "factor on the physical force; K's own was chosen and is not given",
     offsetof(struct force_parameters, force_scale)},
    {"open_surface", PARAMETER_CHOICE, "1", "\"idle\"", BOUND_NONE, 0, 0, "idle|pulls",
     "throats that lie in the open wall: their liquid has its menisci over the grains "
     "and "
     "does not pull them outwards (K 5.4: a full network presses its open top as "
     "well), or "
     "it pulls like any other",
     offsetof(struct force_parameters, open_surface)},
    {"steps", PARAMETER_INTEGER, "1", "550", BOUND_BETWEEN, 2, 1e7, NULL,
     "uniform times from the start to the end of drying, both included [K 5.2]",
     offsetof(struct force_parameters, steps)},
    {0}};

static const struct stage stage = {
    .name = "force-protocol",
    .version = STAGE_VERSION,
    .summary =
        "force-protocol -- the capillary force on every grain over time [K 3.6, 5.3]",
    .reads = "drying",
    .writes = "forces",
    .most_inputs = 1,
    .parameters = table};

static struct drying_record read_record(const struct artifact *input, double steps)
{
    struct drying_record record;
    record.time = artifact_get(input, "/history/time", &record.n_step);
    record.saturation = artifact_get(input, "/history/saturation", NULL);
    record.offset = artifact_get(input, "/changes/offset", NULL);
    record.throat = artifact_get(input, "/changes/throat", NULL);
    record.throat_saturation = artifact_get(input, "/changes/saturation", NULL);
    if (record.n_step < 1)
        die(STATUS_BAD_DATA, "%s: /history/time: must have at least one row",
            input_name(input->path));
    if (!(record.time[record.n_step - 1] / steps > 0))
        die(STATUS_BAD_DATA, "%s: /history/time: must end above 0, got %g",
            input_name(input->path), record.time[record.n_step - 1]);
    return record;
}

static void free_record(struct drying_record *record)
{
    free(record->time);
    free(record->saturation);
    free(record->offset);
    free(record->throat);
    free(record->throat_saturation);
}

// One pressure in all the liquid, that of a throat of mean radius [K 5.3]: p_c = 2
// sigma/r.
static double capillary_pressure(const struct network *network, double surface_tension,
                                 const char *path)
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
    return 2 * surface_tension / (sum / count);
}

static double largest_force(const struct protocol *protocol, int n_particle)
{
    double largest = 0;
    for (size_t k = 0; k < (size_t)protocol->n_time * (size_t)n_particle; k++)
        largest = fmax(largest, norm(protocol->force[k]));
    return largest;
}

static void write_forces(const struct packing *packing, const struct protocol *protocol,
                         double pressure, const struct force_parameters *parameters,
                         double largest, const struct invocation *invocation,
                         const struct artifact *input)
{
    struct artifact *artifact = artifact_create("forces", invocation->output);
    artifact_put_packing(artifact, packing);
    artifact_put(artifact, "/time", protocol->time, protocol->n_time);
    artifact_put(artifact, "/saturation", protocol->saturation, protocol->n_time);
    artifact_put_table(artifact, "/force", protocol->force, protocol->n_time,
                       packing->n_particle);
    artifact_put_number(artifact, "/summary/capillary_pressure", pressure);
    artifact_put_number(artifact, "/summary/force_scale", parameters->force_scale);
    artifact_put_number(artifact, "/summary/largest_force", largest);
    artifact_put_number(artifact, "/summary/first_period_end_time",
                        artifact_get_number(input, "/summary/first_period_end_time"));
    char model[600];
    snprintf(
        model, sizeof model,
        "capillary force: S p_c R^2 n over the patch facing each throat\n"
        "throats in the open wall: %s\n"
        "one capillary pressure, that of a throat of mean radius\n"
        "forces linear in time between events: exact\n"
        "left out: contact-line term (perfect wetting), pressure differences between "
        "clusters, bridges left at contacts\n",
        parameters->open_surface == OPEN_SURFACE_IDLE ? "do not pull" : "pull");
    artifact_finish(artifact, invocation, one_input(input), model);
}

int main(int argc, char **argv)
{
    struct force_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    struct artifact *input = artifact_open(invocation.inputs[0], "drying");
    struct network network = artifact_get_periodic_network(input);
    struct drying_record record = read_record(input, (double)parameters.steps);

    struct patch *patches;
    int n_patch;
    struct reason reason;
    enum status status = find_patches(&network, &patches, &n_patch, &reason);
    if (!status) status = check_closed(patches, n_patch, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);

    if (parameters.open_surface == OPEN_SURFACE_IDLE)
        n_patch = drop_patches_in_walls(
            &network, (unsigned)artifact_get_number(input, "/summary/open_walls"),
            patches, n_patch);
    const double pressure =
        capillary_pressure(&network, parameters.surface_tension, input->path);
    struct protocol protocol =
        make_protocol(&network, &record, patches, n_patch,
                      pressure * parameters.force_scale, (int)parameters.steps);
    drop_auxiliary(&network.packing, &protocol);
    const double largest = largest_force(&protocol, network.packing.n_particle);
    if (!(fmax(largest, pressure) <= 1e150))
        die(STATUS_BAD_DATA,
            "%s: the forces overflow at a capillary pressure of %g Pa and "
            "force_scale = %g",
            input_name(input->path), pressure, parameters.force_scale);
    write_forces(&network.packing, &protocol, pressure, &parameters, largest,
                 &invocation, input);

    protocol_free(&protocol);
    free(patches);
    free_record(&record);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
