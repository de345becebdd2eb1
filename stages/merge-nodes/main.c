// SPDX-License-Identifier: GPL-3.0-or-later
// merge-nodes: short throats removed from a pore network [K 3.3.7].
#include "artifacts/artifact.h"
#include "artifacts/write_network.h"
#include "basics/status.h"
#include "merge.h"

#include <stdio.h>

struct merge_parameters {
    int measure;
    double threshold;
};

static const struct parameter table[] = {
    {"measure", PARAMETER_CHOICE, "1", "\"grain_radius\"", BOUND_NONE, 0, 0,
     "grain_radius|mean_length|absolute|fraction",
     "what the threshold counts: mean grain radii, mean throat lengths, metres, or the "
     "share of throats to remove",
     offsetof(struct merge_parameters, measure)},
    {"threshold", PARAMETER_NUMBER, "1", "1e-6", BOUND_MINIMUM, 0, 0, NULL,
     "throats shorter than this go, the shortest first; the default removes only those "
     "that a degenerate packing makes",
     offsetof(struct merge_parameters, threshold)},
    {0}};

static const struct stage stage = {
    .name = "merge-nodes",
    .version = STAGE_VERSION,
    .summary = "merge-nodes -- remove short throats by merging their nodes [K 3.3.7]",
    .reads = "network",
    .writes = "network",
    .most_inputs = 1,
    .parameters = table};

int main(int argc, char **argv)
{
    struct merge_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    if (parameters.measure == MERGE_FRACTION && parameters.threshold > 1)
        die(STATUS_BAD_DATA,
            "merge-nodes.threshold: must be from 0 to 1 where it is a "
            "fraction, got %g",
            parameters.threshold);
    struct artifact *input = artifact_open(invocation.inputs[0], "network");
    struct network network = artifact_get_network(input);

    struct merge_report report;
    merge_nodes(&network, (enum merge_measure)parameters.measure, parameters.threshold,
                &report);

    char model[400];
    snprintf(model, sizeof model,
             "shortest first: %d throats merged away, %d fused with a parallel one, %d "
             "short ones kept\n"
             "nodes %d -> %d, throats %d -> %d\n"
             "parallel throats: the wider radius stays\n",
             report.merged, report.fused, report.kept, report.nodes_before,
             network.n_node, report.throats_before, network.n_throat);
    write_network(&network, &invocation, input, model);

    artifact_close(input);
    network_free(&network);
    invocation_free(&invocation);
    return STATUS_OK;
}
