// SPDX-License-Identifier: GPL-3.0-or-later
// merge-nodes: short throats removed from a pore network [K 3.3.7]. Reads a network,
// also one of a box that repeats, and writes it with fewer nodes and throats.
//
// In this order: read, but for a network with liquid; count what there is, for the
// report (report.h); turn cylinders into volumes, if these are to be conserved; merge
// the nodes of throats shorter than the threshold, shortest first (merge.h); count
// again and write the report; see that images are still near enough to be numbered;
// write. Counting comes before the volumes are given, which changes no number of it.
// What was merged, fused and kept is counted in `model`.
//
// `threshold` has four units, by `measure`: mean grain radii, mean throat lengths, m,
// or a share of the throats, which is the only one with an upper limit (1) and is
// checked here.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "artifacts/document.h"
#include "artifacts/liquid.h"
#include "artifacts/write_network.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "merge.h"
#include "parameters/estimate.h"
#include "report.h"

#include <stdio.h>
#include <stdlib.h>

enum volumes { VOLUMES_AS_GIVEN, VOLUMES_CONSERVED };

struct merge_parameters {
    int measure, volumes;
    double threshold;
};

static const struct parameter table[] = {
    {"measure", PARAMETER_CHOICE, "1", "\"grain_radius\"",
     offsetof(struct merge_parameters, measure),
     .choices = "grain_radius|mean_length|absolute|fraction",
     .text = "unit of the threshold: mean grain radii, mean throat lengths, metres, or "
             "the share of throats to remove; mean length and share are those before "
             "any merging"},
    {"threshold", PARAMETER_NUMBER, "1", "1e-6",
     offsetof(struct merge_parameters, threshold), AT_LEAST(0),
     .text = "throats shorter than this are removed, the shortest first; the default "
             "removes only the throats of zero length in degenerate packings"},
    {"volumes", PARAMETER_CHOICE, "1", "\"as_given\"",
     offsetof(struct merge_parameters, volumes), .choices = "as_given|conserved",
     .text = "as_given: where throats have volumes (/throats/volume) their sum stays, "
             "cylinders stay cylinders; conserved: the sum of cylinders stays as well, "
             "as volumes"},
    {0}};

static const struct stage stage = {
    .name = "merge-nodes",
    .version = STAGE_VERSION,
    .summary = "merge-nodes -- remove short throats by merging their nodes [K 3.3.7]",
    .reads = "network",
    .writes = "network",
    .most_inputs = 1,
    .parameters = table,
    .estimates = ESTIMATES_SIZES,
    .reports = "coordination, lengths and radii before and after, as JSON"};

// Cylinders become volumes, m3: then merging passes them on, and their sum stays.
static void give_volumes(struct network *network)
{
    if (network->throat_volume) return;
    double *volume = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        volume[t] = throat_volume(network, t);
    network->throat_volume = volume;
}

// With a census before and after where PATH, that of the report, is not NULL.
static void merge(struct network *network, const struct merge_parameters *parameters,
                  const char *path, struct merge_report *report)
{
    struct census before = {0};
    if (path) before = take_census(network);
    if (parameters->volumes == VOLUMES_CONSERVED) give_volumes(network);
    merge_nodes(network, (enum merge_measure)parameters->measure, parameters->threshold,
                report);
    if (!path) return;
    struct census after = take_census(network);
    write_json(path, merging_json(report, &before, &after));
    census_free(&before);
    census_free(&after);
}

// Refuses nodes that meet across more periodic images than an artifact can store: a
// merged node lies in one image of all it was made from, and in a narrow box the others
// may then be far (image.h). Exits 65.
static void check_images(const struct network *network, const char *path)
{
    bool far = false;
    for (int t = 0; network->throat_image && t < network->n_throat; t++)
        far |= is_far(network->throat_image[t]);
    for (int64_t k = 0;
         network->throat_image && k < network->face_offset[network->n_face]; k++)
        far |= is_far(network->face_node_image[k]);
    if (far)
        die(STATUS_BAD_DATA,
            "%s: /domain/upper: the box is too narrow for merging so much: nodes would "
            "meet that are more than %d boxes apart",
            input_name(path), FARTHEST_IMAGE);
}

static int estimate(struct invocation *invocation)
{
    const struct body_size body = input_size(invocation, 0);
    const struct cost cost = cost_of_merging(&body);
    return end_with_estimate(invocation, &cost, &body);
}

int main(int argc, char **argv)
{
    struct merge_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    if (parameters.measure == MERGE_FRACTION && parameters.threshold > 1)
        die(STATUS_BAD_DATA,
            "merge-nodes.threshold: must be from 0 to 1 where it is a "
            "fraction, got %g",
            parameters.threshold);
    if (invocation.estimates) return estimate(&invocation);
    struct artifact *input = artifact_open(invocation.inputs[0], "network");
    refuse_saturation(input, "merging would lose the liquid in the throats: merge the "
                             "nodes of a network that tessellate has made, or dry this "
                             "one as it is");
    struct network network = artifact_get_periodic_network(input);

    struct merge_report report;
    merge(&network, &parameters, invocation.report, &report);
    check_images(&network, input->path);

    char model[500];
    snprintf(model, sizeof model,
             "shortest first: %d throats merged away, %d fused with a parallel one, %d "
             "short ones kept\n"
             "nodes %d -> %d, throats %d -> %d\n"
             "parallel throats: the wider radius stays\n"
             "%s\n",
             report.merged, report.fused, report.kept, report.nodes_before,
             network.n_node, report.throats_before, network.n_throat,
             network.throat_volume ? "volumes: their sum stays" : "volumes: cylinders");
    write_network(&network, &invocation, input, model);

    artifact_close(input);
    network_free(&network);
    invocation_free(&invocation);
    return STATUS_OK;
}
