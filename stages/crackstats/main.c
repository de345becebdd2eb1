// SPDX-License-Identifier: GPL-3.0-or-later
// crackstats: cracks counted, over one run or many.
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "count.h"
#include "summarise.h"

#include <stdlib.h>

struct crackstats_parameters {
    int64_t slices;
};

static const struct parameter table[] = {
    {"slices", PARAMETER_INTEGER, "1", "10", BOUND_BETWEEN, 1, 100000, NULL,
     "horizontal slices of equal thickness in the profile, from the bottom up",
     offsetof(struct crackstats_parameters, slices)},
    {0}};

static const struct stage stage = {
    .name = "crackstats",
    .version = STAGE_VERSION,
    .summary = "crackstats -- count the cracks of one response or of many",
    .reads = "response",
    .writes = "crackstats",
    .most_inputs = 1000000,
    .parameters = table};

// Heights of the cracked bonds where they were before anything moved: a bond between
// two layers stays on their border however the grains have shifted since.
static double *bond_heights(const struct artifact *input, const struct packing *packing)
{
    int count;
    int32_t *bond = artifact_get(input, "/cracks/bond", &count);
    double *height = NEW_ARRAY(double, count);
    for (int k = 0; k < count; k++) {
        const int32_t *pair = packing->bond[bond[k]];
        height[k] = 0.5 * (packing->position[pair[0]].z + packing->position[pair[1]].z);
    }
    free(bond);
    return height;
}

static struct cracks read_cracks(const struct artifact *input)
{
    struct packing packing = artifact_get_packing(input);
    struct cracks cracks = {.bonds = packing.n_bond,
                            .mode = artifact_get(input, "/cracks/mode", NULL),
                            .height = bond_heights(input, &packing),
                            .first_period_end = artifact_get_number(
                                input, "/summary/first_period_end_time"),
                            .bottom = packing.lower.z,
                            .top = packing.upper.z};
    cracks.time = artifact_get(input, "/cracks/time", &cracks.count);
    packing_free(&packing);
    return cracks;
}

static void free_cracks(struct cracks *cracks)
{
    free(cracks->time);
    free(cracks->mode);
    free(cracks->height);
}

// Counts one run and keeps of the artifact only what the provenance needs.
static struct counts count_run(const char *path, int n_slice, json_t *inputs,
                               int *bonds)
{
    struct artifact *input = artifact_open(path, "response");
    struct cracks cracks = read_cracks(input);
    if (*bonds >= 0 && *bonds != cracks.bonds)
        die(STATUS_BAD_DATA, "%s: has %d bonds, the runs before have %d: not one study",
            input_name(path), cracks.bonds, *bonds);
    *bonds = cracks.bonds;
    struct counts counts = count_cracks(&cracks, n_slice);
    json_array_append_new(inputs, input_digest(input));
    free_cracks(&cracks);
    artifact_close(input);
    return counts;
}

int main(int argc, char **argv)
{
    struct crackstats_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    const int n_run = invocation.n_input, n_slice = (int)parameters.slices;

    int bonds = -1;
    json_t *inputs = json_array();
    struct counts *runs = NEW_ARRAY(struct counts, n_run);
    for (int r = 0; r < n_run; r++)
        runs[r] = count_run(invocation.inputs[r], n_slice, inputs, &bonds);

    json_t *report = json_pack("{s:s,s:i,s:i}", "schema", "craquelure/crackstats/1",
                               "runs", n_run, "bonds", bonds);
    summarise(report, runs, n_run, n_slice);
    finish_json(report, &invocation, inputs,
                "counts by mode, drying period and slice\n"
                "left out: connected cracks, orientation, strain\n");

    for (int r = 0; r < n_run; r++)
        free(runs[r].slice);
    free(runs);
    invocation_free(&invocation);
    return STATUS_OK;
}
