// SPDX-License-Identifier: GPL-3.0-or-later
// Every artifact carries the program, the effective parameters and a description of the
// model that made it. These texts are the only source here: what the page says of
// models and left-out effects is what the stages said when they ran.
//
// Lines of a model that begin with "left out: " are what it left out, all others what
// it modelled. Words are in the order of the chain: packing, tessellation, network,
// drying, forces, response, then crackstats (or the flow or motion).
#include "provenance.h"

#include "basics/memory.h"
#include "html.h"

#include <stdlib.h>
#include <string.h>

// One artifact's own words; each NULL where it has none.
struct words {
    char *program, *parameters, *model;
};
enum { SOURCES = KINDS + 2 };

// An object (parameters) as JSON, a string as it is.
static char *member_text(const json_t *document, const char *name)
{
    const json_t *value = json_object_get(document, name);
    if (json_is_object(value)) return json_dumps(value, 0);
    const char *text = json_string_value(value);
    return text ? duplicate(text, strlen(text) + 1, 1) : NULL;
}

static struct words words_of_document(const json_t *document)
{
    return (struct words){member_text(document, "program"),
                          member_text(document, "parameters"),
                          member_text(document, "model")};
}

static struct words words_of_artifact(const struct artifact *artifact)
{
    if (!artifact) return (struct words){0};
    return (struct words){artifact_get_text(artifact, "program"),
                          artifact_get_text(artifact, "parameters"),
                          artifact_get_text(artifact, "model")};
}

// In the order of the chain.
static void all_words(const struct run *run, struct words words[SOURCES])
{
    words[0] = words_of_artifact(run->of[PACKING]);
    words[1] = words_of_artifact(run->tessellation);
    for (int kind = NETWORK; kind < KINDS; kind++)
        words[kind + 1] = words_of_artifact(run->of[kind]);
    words[SOURCES - 1] = run->flow     ? words_of_artifact(run->flow)
                         : run->motion ? words_of_artifact(run->motion)
                                       : words_of_document(run->counted);
}

static void words_free(struct words words[SOURCES])
{
    for (int k = 0; k < SOURCES; k++) {
        free(words[k].program);
        free(words[k].parameters);
        free(words[k].model);
    }
}

// "dry 32" is the stage dry.
static void stage_of(const struct words *words, char stage[64])
{
    const char *program = words->program ? words->program : "?";
    snprintf(stage, 64, "%.*s", (int)strcspn(program, " "), program);
}

// ---- what was modelled --------------------------------------------------------------

static const char left_out[] = "left out: ";

// A line that tells what STAGE left out or modelled.
static void put_line_of(FILE *page, const char *stage, const char *line)
{
    fputs("<li><b>", page);
    put_text(page, stage);
    fputs("</b>: ", page);
    put_text(page, line);
    fputs("</li>\n", page);
}

// The drying has the boundary layer that the network stages leave to it.
static bool is_made_up_for(const struct run *run, int k, const char *item)
{
    return k < DRYING + 1 && run->of[DRYING] && !strcmp(item, "boundary layer");
}

// strsep cuts the text into lines in place; it is freed as a whole afterwards.
static void put_lines(FILE *page, const struct run *run, bool of_left_out)
{
    struct words words[SOURCES];
    all_words(run, words);
    for (int k = 0; k < SOURCES; k++) {
        char stage[64];
        stage_of(&words[k], stage);
        char *rest = words[k].model;
        for (char *line; rest && (line = strsep(&rest, "\n"));) {
            const bool is_out = !strncmp(line, left_out, sizeof left_out - 1);
            if (!*line || is_out != of_left_out) continue;
            if (is_out) line += sizeof left_out - 1;
            if (!is_out || !is_made_up_for(run, k, line))
                put_line_of(page, stage, line);
        }
    }
    words_free(words);
}

void put_left_out(FILE *page, const struct run *run)
{
    put_lines(page, run, true);
}

void put_modelled(FILE *page, const struct run *run)
{
    put_lines(page, run, false);
}

// ---- how to make it again -----------------------------------------------------------

// One object a stage, by its name: the same form as `-p scene.json` takes.
json_t *scene_of(const struct run *run)
{
    struct words words[SOURCES];
    all_words(run, words);
    json_t *scene = json_object();
    for (int k = 0; k < SOURCES; k++) {
        char stage[64];
        stage_of(&words[k], stage);
        json_t *parameters =
            words[k].parameters ? json_loads(words[k].parameters, 0, NULL) : NULL;
        if (!parameters) continue;
        if (json_object_set_new_nocheck(scene, stage, parameters))
            json_decref(parameters);
    }
    words_free(words);
    return scene;
}

void put_scene(FILE *page, const struct run *run)
{
    json_t *scene = scene_of(run);
    char *text = json_dumps(scene, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    if (text) put_text(page, text);
    free(text);
    json_decref(scene);
}

// With the names of `make run`; only steps whose artifact is there.
void put_commands(FILE *page, const struct run *run)
{
    const struct {
        bool there;
        const char *line;
    } steps[] = {
        {run->of[PACKING], "pack -p scene.json -o packing.h5"},
        {run->tessellation, "tessellate -p scene.json packing.h5 -o tessellation.h5"},
        {run->of[NETWORK], "merge-nodes -p scene.json tessellation.h5 -o network.h5"},
        {run->of[DRYING], "dry -p scene.json network.h5 -o drying.h5"},
        {run->of[FORCES], "force-protocol -p scene.json drying.h5 -o forces.h5"},
        {run->of[RESPONSE], "dem-replay -p scene.json forces.h5 -o response.h5"},
        {run->counted,
         "crackstats -p scene.json response.h5 drying.h5 -o crackstats.json"},
        {run->flow, "flow -p scene.json packing.h5 -o flow.h5"},
        {run->motion, "simulate -p scene.json packing.h5 -o motion.h5"}};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        if (steps[k].there) put_line(page, "craquelure %s\n", steps[k].line);
    const char *alone = run->flow ? "flow.h5" : run->motion ? "motion.h5" : ".";
    put_line(page, "craquelure report %s -o report.html\n", alone);
}

// By the name under which run.c noted the source.
static const char *program_of(const struct run *run, const char *name, char text[64])
{
    const struct artifact *artifact = !strcmp(name, "tessellation.h5")
                                          ? run->tessellation
                                      : !strcmp(name, "flow.h5")   ? run->flow
                                      : !strcmp(name, "motion.h5") ? run->motion
                                                                   : NULL;
    static const char *const file[KINDS] = {"packing.h5", "network.h5", "drying.h5",
                                            "forces.h5", "response.h5"};
    for (int kind = 0; kind < KINDS; kind++)
        if (!strcmp(name, file[kind])) artifact = run->of[kind];
    const json_t *document = !strcmp(name, "seeds.json")   ? run->repeated
                             : !strcmp(name, "check.json") ? run->checked
                                                           : run->counted;
    char *program = artifact ? artifact_get_text(artifact, "program")
                             : member_text(document, "program");
    snprintf(text, 64, "%s", program ? program : "");
    free(program);
    return text;
}

void put_sources(FILE *page, const struct run *run)
{
    size_t k;
    json_t *source;
    json_array_foreach(run->sources, k, source)
    {
        const char *name = json_string_value(json_object_get(source, "name"));
        char program[64];
        fputs("<tr><td>", page);
        put_text(page, name);
        fputs("</td><td>", page);
        put_text(page, program_of(run, name, program));
        fputs("</td><td><code>", page);
        put_text(page, json_string_value(json_object_get(source, "sha256")));
        fputs("</code></td></tr>\n", page);
    }
}
