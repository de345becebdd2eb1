// SPDX-License-Identifier: GPL-3.0-or-later
// report: a page on which a run shows itself. Several folders make a study: a row each,
// groups of equal scenes, tests (study.c). Anything else is one run: its artifacts are
// read (run.c), its moments chosen (course.c), its shapes packed into arrays (body.c,
// motion.c or flow.c), and all of it is put into the template (page.c). The order
// matters: keys of moments need the course, and moments of a motion need the body.
#include "basics/file.h"
#include "flow.h"
#include "motion.h"
#include "page.h"

#include <stdlib.h>

struct report_parameters {
    const char *title, *study, *groups;
    int64_t rows, moments;
};

#define AT(member) offsetof(struct report_parameters, member)

static const struct parameter table[] = {
    {"title", PARAMETER_TEXT, "1", "null", AT(title), .text = "of the page"},
    {"study", PARAMETER_TEXT, "1", "null", AT(study),
     .text = "page of all runs that this one belongs to, seen from its own; a link"},
    {"groups", PARAMETER_TEXT, "1", "null", AT(groups),
     .text = "of several runs: what the group of each is called, a line for each "
             "folder; null: by what their scenes differ in"},
    {"rows", PARAMETER_INTEGER, "1", "1000", AT(rows), BETWEEN(2, 20000),
     .text = "most moments of the drying that the slider and the curves know"},
    {"moments", PARAMETER_INTEGER, "1", "16", AT(moments), BETWEEN(1, 1000),
     .text = "moments at which forces are shown, of a motion eight times as many "
             "snapshots; "
             "fewer where grains are many"},
    {0}};

static const struct stage stage = {
    .name = "report",
    .version = STAGE_VERSION,
    .summary = "report -- a page that shows a run: the body in 3D, curves, numbers",
    .reads = "the folder of a run, or its artifacts: packing, network, drying, forces, "
             "response, crackstats (of the run; of several), check; a flow; a motion; "
             "several folders of runs, or one that holds such folders",
    .writes = "report",
    .most_inputs = 100000,
    .parameters = table,
    .notes = "The page is one HTML file that needs no network and no other file. It "
             "opens in any\nrecent browser, with or without WebGL.",
    .writes_page = true};

// So many forces make a megabyte and a half. A motion is all in its moments. Three
// bytes a grain and moment, before they are packed.
static int moments_for(const struct run *run, int64_t wanted)
{
    const int64_t most = 500000 / (run->packing.n_particle + 1) + 2;
    if (run->motion) wanted *= 8;
    return (int)(wanted < most ? wanted : most);
}

static void write_page(const struct contents *contents, const char *output)
{
    size_t size;
    char *page = page_of(contents, &size);
    write_whole(output, page, size);
    free(page);
}

// The page is written last and whole: nothing is left at OUTPUT if anything before
// fails.
static void report_run(const struct invocation *invocation,
                       const struct report_parameters *parameters)
{
    struct run run = run_of_paths(invocation->inputs, invocation->n_input);
    struct course course = course_of(&run, (int)parameters->rows);
    struct arrays arrays = arrays_init();
    struct shown_body body =
        put_body(&arrays, &run, &course, moments_for(&run, parameters->moments));
    put_course(&arrays, &course, &run);
    json_t *shown = run.flow     ? put_flow(&arrays, &run)
                    : run.motion ? put_motion(&arrays, &run, &course, &body)
                                 : NULL;
    const struct contents contents = {.run = &run,
                                      .course = &course,
                                      .body = &body,
                                      .arrays = &arrays,
                                      .shown = shown,
                                      .title = parameters->title,
                                      .study_page = parameters->study};
    write_page(&contents, invocation->output);
    json_decref(shown);
    arrays_free(&arrays);
    shown_body_free(&body);
    course_free(&course);
    close_run(&run);
}

int main(int argc, char **argv)
{
    struct report_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    struct study *study = study_of(invocation.inputs, invocation.n_input,
                                   parameters.groups, invocation.output);
    if (study)
        write_page(&(struct contents){.study = study, .title = parameters.title},
                   invocation.output);
    else
        report_run(&invocation, &parameters);
    study_free(study);
    invocation_free(&invocation);
    return 0;
}
