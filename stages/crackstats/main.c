// SPDX-License-Identifier: GPL-3.0-or-later
// crackstats: cracks counted, over one run or many. It reads the inputs one after the
// other: a response is a run, and a drying right after it is that run's. Runs must have
// as many snapshots and (same_bonds) bonds as the first. Each is added to the ensemble
// and freed, so memory holds one run at a time. In the end the report is written:
// tables first, then statistics and tests.
#include "basics/status.h"
#include "read.h"
#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct crackstats_parameters {
    int64_t slices, intervals, first_group;
    double confidence;
    bool same_bonds, paired, polygons;
};

#define AT(member) offsetof(struct crackstats_parameters, member)

static const struct parameter table[] = {
    {"slices", PARAMETER_INTEGER, "1", "10", AT(slices), BETWEEN(1, 100000),
     .text = "horizontal slices of equal thickness in the profile, from the bottom up; "
             "a bond on the border of two counts half in each"},
    {"intervals", PARAMETER_INTEGER, "1", "10", AT(intervals), BETWEEN(1, 10000),
     .text = "number of equal intervals of the saturation, and of the drying time, in "
             "which cracks are counted"},
    {"confidence", PARAMETER_NUMBER, "1", "0.95", AT(confidence),
     BETWEEN(0.5, 0.999999),
     .text = "of the intervals around the means of several runs"},
    {"first_group", PARAMETER_INTEGER, "1", "0", AT(first_group), BETWEEN(0, 1000000),
     .text = "number of runs, from the first, that are tested against the others; 0: "
             "no test"},
    {"paired", PARAMETER_BOOLEAN, "1", "false", AT(paired),
     .text = "the two groups are paired, the first of one with the first of the other "
             "and so on, as for aggregates that each dry in two ways: their "
             "differences are tested too"},
    {"same_bonds", PARAMETER_BOOLEAN, "1", "true", AT(same_bonds),
     .text = "all runs must have as many bonds as the first; false: they may have "
             "other packings"},
    {"polygons", PARAMETER_BOOLEAN, "1", "false", AT(polygons),
     .text =
         "cracks of a layer as objects, seen from above: damage of upright columns, "
         "cracks that go through, polygons, islands, junctions; none where there is "
         "no pattern"},
    {0}};

static const struct stage stage = {
    .name = "crackstats",
    .version = STAGE_VERSION,
    .summary = "crackstats -- count the cracks of one response or of many",
    .reads = "response",
    .writes = "crackstats",
    .most_inputs = 1000000,
    .parameters = table,
    .notes =
        "A drying among the inputs belongs to the response before it: then cracks are "
        "compared with the liquid of their slices. Confidence intervals are those of "
        "the mean over the runs; one run has none: repeat it with other seeds."};

// The inputs, and which is next.
struct reading {
    const struct invocation *invocation;
    int next;
    struct artifact *ahead; // opened already: not the drying of the last run
    json_t *digests;
    json_t *seen; // by digest: the path it was first read from
};

// Every input's digest goes into the provenance, in the order in which they were named.
static struct artifact *open_next(struct reading *reading, const char *name)
{
    struct artifact *artifact =
        artifact_open(reading->invocation->inputs[reading->next++], name);
    json_array_append_new(reading->digests, input_digest(artifact));
    return artifact;
}

// Equal runs are one run counted twice: they make means look surer than they are.
static void note_repeated(struct reading *reading, const struct artifact *input)
{
    const json_t *first = json_object_get(reading->seen, input->sha256);
    if (first)
        report("%s: is the same run as %s; both count", input_name(input->path),
               json_string_value(first));
    else
        json_object_set_new(reading->seen, input->sha256,
                            json_string(input_name(input->path)));
}

// The next run; false when there are no more. A drying where a response is due belongs
// to no run: that is refused.
static bool next_run(struct reading *reading, struct run *run, const char **path)
{
    if (!reading->ahead && reading->next == reading->invocation->n_input) return false;
    struct artifact *input = reading->ahead;
    reading->ahead = NULL;
    if (!input) input = open_next(reading, "response");
    if (strcmp(input->schema->name, "response"))
        die(STATUS_BAD_DATA, "%s: must be a response, is a %s", input_name(input->path),
            input->schema->name);
    note_repeated(reading, input);
    *run = read_run(input);
    *path = input_name(input->path);
    artifact_close(input);
    return true;
}

// Two numbers that a response takes over from its drying: too little for a proof,
// enough to catch files that were mixed up.
static void must_belong(const struct liquid *liquid, const struct run *run,
                        const char *path)
{
    if (liquid->network.packing.n_particle != run->packing.n_particle)
        die(STATUS_BAD_DATA,
            "%s: is not the drying of the response before it: has %d grains, not %d",
            path, liquid->network.packing.n_particle, run->packing.n_particle);
    if (liquid->first_period_end != run->first_period_end)
        die(STATUS_BAD_DATA,
            "%s: is not the drying of the response before it: "
            "/summary/first_period_end_time is %.17g s, not %.17g",
            path, liquid->first_period_end, run->first_period_end);
}

// Its drying; false when none was given. An input that is no drying is kept for
// next_run.
static bool next_liquid(struct reading *reading, const struct run *run,
                        struct liquid *liquid)
{
    if (reading->next == reading->invocation->n_input) return false;
    struct artifact *input = open_next(reading, NULL);
    if (strcmp(input->schema->name, "drying")) {
        reading->ahead = input;
        return false;
    }
    *liquid = read_liquid(input);
    must_belong(liquid, run, input_name(input->path));
    artifact_close(input);
    return true;
}

// Tables of runs are added class by class, so snapshots must be as many; bonds need
// not, if the user says so.
static void must_fit(const struct ensemble *ensemble, const struct run *run,
                     const char *path, bool same_bonds)
{
    if (ensemble->n_run == 0) return;
    const double bonds = ensemble->bonds / ensemble->n_run;
    if (same_bonds && bonds != run->packing.n_bond)
        die(STATUS_BAD_DATA,
            "%s: has %d bonds, the runs before have %g: not one study "
            "(same_bonds=false takes runs of other packings)",
            path, run->packing.n_bond, bonds);
    if (ensemble->n_snapshot != run->n_snapshot)
        die(STATUS_BAD_DATA,
            "%s: has %d snapshots, the runs before have %d: not one study", path,
            run->n_snapshot, ensemble->n_snapshot);
}

// A table of slices at each interval is written.
static void check_classes(const struct crackstats_parameters *parameters)
{
    static const int64_t most = 1000000;
    if (parameters->slices * parameters->intervals > most)
        die(STATUS_BAD_DATA,
            "crackstats.slices: times intervals must be at most %d, got %d times %d",
            (int)most, (int)parameters->slices, (int)parameters->intervals);
}

// The number of runs is known only at the end, so groups are checked here.
static struct ensemble read_study(const struct invocation *invocation, json_t *digests,
                                  const struct crackstats_parameters *parameters)
{
    struct ensemble ensemble = ensemble_init(
        invocation->n_input,
        (struct classes){(int)parameters->slices, (int)parameters->intervals},
        parameters->polygons);
    struct reading reading = {
        .invocation = invocation, .digests = digests, .seen = json_object()};
    struct run run;
    const char *path;
    while (next_run(&reading, &run, &path)) {
        must_fit(&ensemble, &run, path, parameters->same_bonds);
        struct liquid liquid;
        const bool known = next_liquid(&reading, &run, &liquid);
        ensemble_add(&ensemble, &run, known ? &liquid : NULL);
        if (known) liquid_free(&liquid);
        run_free(&run);
    }
    json_decref(reading.seen);
    if (parameters->first_group && parameters->first_group >= ensemble.n_run)
        die(STATUS_BAD_DATA,
            "crackstats.first_group: must leave runs to test against, got %d of %d",
            (int)parameters->first_group, ensemble.n_run);
    if (parameters->paired && 2 * parameters->first_group != ensemble.n_run)
        die(STATUS_BAD_DATA,
            "crackstats.paired: takes two groups of as many runs, got first_group = %d "
            "of %d",
            (int)parameters->first_group, ensemble.n_run);
    return ensemble;
}

int main(int argc, char **argv)
{
    struct crackstats_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    check_classes(&parameters);
    json_t *inputs = json_array();
    struct ensemble ensemble = read_study(&invocation, inputs, &parameters);
    json_t *counted =
        json_pack("{s:s,s:i,s:o}", "schema", "craquelure/crackstats/1", "runs",
                  ensemble.n_run, "bonds", json_value(ensemble.bonds / ensemble.n_run));
    report_tables(counted, &ensemble, parameters.confidence);
    report_statistics(counted, &ensemble, parameters.confidence,
                      (struct groups){(int)parameters.first_group, parameters.paired});
    report_patterns(counted, &ensemble);
    char model[250];
    snprintf(model, sizeof model,
             "counts by mode, drying period, slice, saturation and time; connected "
             "cracks, fragments, orientation, strain\n"
             "%s\n",
             ensemble.n_liquid == ensemble.n_run
                 ? "cracks against the liquid of their slices"
                 : "left out: the liquid, whose drying was not given");
    finish_json(counted, &invocation, inputs, model);
    ensemble_free(&ensemble);
    invocation_free(&invocation);
    return STATUS_OK;
}
