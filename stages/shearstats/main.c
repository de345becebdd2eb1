// SPDX-License-Identifier: GPL-3.0-or-later
// shearstats: from grains and contacts to fields, and the statistics of sheared cells.
//
// It reads motions one after the other, each a realisation: averages it over its
// snapshots (add_run.c), fits what is asked for, and frees it. The first one sets the
// grid. In the end means over the realisations are written, with their errors. Only one
// motion is in memory at a time: thousands of realisations need no more than one.
#include "artifacts/artifact.h"
#include "basics/status.h"
#include "write_shearstats.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct stage stage = {
    .name = "shearstats",
    .version = STAGE_VERSION,
    .summary = "shearstats -- coarse-grained fields and shear bands of motions [G 4]",
    .reads = "motion",
    .writes = "shearstats",
    .most_inputs = 10000,
    .parameters = shearstats_table,
    .notes =
        "Several motions are realisations of one scene: means have Student's intervals "
        "over them. With cell.rate the cell is a split-bottom one, and bands are "
        "fitted."};

// Equal runs are one run counted twice: they make means look surer than they are.
static void warn_of_repeated(json_t *seen, const struct artifact *input)
{
    const json_t *first = json_object_get(seen, input->sha256);
    if (first)
        report("%s: is the same motion as %s; both count", input_name(input->path),
               json_string_value(first));
    else
        json_object_set_new(seen, input->sha256, json_string(input_name(input->path)));
}

// More than rounding: grains beyond the grid count in no field.
static void warn_of_lost(const struct study *study, const char *path)
{
    static const double little = 1e-9;
    const double lost = 1 - study->run[study->n_run - 1].mass_inside;
    if (lost > little)
        report("%s: %.3g of the mass lies outside the grid (grid.lower, grid.upper)",
               input_name(path), lost);
}

// The digest of each input goes into the provenance.
static void read_runs(struct study *study, const struct invocation *invocation,
                      const struct shearstats_parameters *parameters, json_t *digests)
{
    json_t *seen = json_object();
    struct reason reason;
    for (int k = 0; k < invocation->n_input; k++) {
        struct artifact *input = artifact_open(invocation->inputs[k], "motion");
        json_array_append_new(digests, input_digest(input));
        warn_of_repeated(seen, input);
        struct motion motion = read_motion(input, parameters->from, parameters->to);
        enum status status = STATUS_OK;
        if (k == 0)
            status =
                begin_study(study, &motion, parameters, invocation->n_input, &reason);
        if (!status)
            status = add_run(study, &motion, parameters, invocation->threads, &reason);
        if (status) die(status, "%s: %s", input_name(input->path), reason.text);
        if (!invocation->quiet) warn_of_lost(study, input->path);
        motion_free(&motion);
        artifact_close(input);
    }
    json_decref(seen);
}

static void describe(const struct study *study, char *text, size_t size)
{
    char levels[160] = "left out: shear bands, for no cell.rate is given\n";
    if (study->cell.n_level > 0)
        snprintf(
            levels, sizeof levels,
            "error functions through the angular velocity at %d heights, between 0 "
            "and %.6g rad/s [G 13]\n",
            study->cell.n_level, study->cell.rate);
    snprintf(
        text, size,
        "coarse graining with a triweight of standard deviation %.6g m along each "
        "axis, means over cells\n"
        "walls and driven grains are boundaries: branches end at the contact\n"
        "%s, compression is positive\n"
        "%s"
        "shear stress against pressure where the shear rate is above %g 1/s [G 14]\n"
        "left out: couple stresses, spins\n",
        study->smoothing,
        study->frame.cylindrical ? "components r, angle, z; means over the angle"
                                 : "components x, y, z",
        levels, study->flowing.least_rate);
}

int main(int argc, char **argv)
{
    struct shearstats_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    check_shearstats_parameters(&parameters);
    json_t *inputs = json_array();
    struct study study;
    read_runs(&study, &invocation, &parameters, inputs);

    struct artifact *artifact = artifact_create("shearstats", invocation.output);
    put_fields(artifact, &study, parameters.confidence);
    put_statistics(artifact, &study, parameters.confidence);
    char model[900];
    describe(&study, model, sizeof model);
    artifact_finish(artifact, &invocation, inputs, model);
    study_free(&study);
    invocation_free(&invocation);
    return STATUS_OK;
}
