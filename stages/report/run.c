// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts come in any order, from files or folders. Each is kept by what its schema
// says it is, not by its name; two of one kind are refused. A network of which throats
// were merged is `of[NETWORK]`, one before that is the tessellation.
//
// Whether they are of one run is checked by digests: an artifact lists the SHA-256 of
// its inputs. If it has an input of the same schema as an artifact at hand, and with
// another digest, the two do not belong together. An artifact whose input is not at
// hand is taken on trust; the number of grains must agree in any case.
#include "run.h"

#include "artifacts/cracks.h"
#include "artifacts/document.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "flow.h"
#include "folders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const kind_name[KINDS] = {"packing", "network", "drying", "forces",
                                             "response"};

// ---- which artifacts ----------------------------------------------------------------

static void note_source(struct run *run, const char *name, const char *schema,
                        const char *sha256)
{
    json_array_append_new(run->sources, json_pack("{s:s,s:s,s:s}", "name", name,
                                                  "schema", schema, "sha256", sha256));
}

// A crackstats of one run belongs to it; one of several says how results scatter.
static void keep_document(struct run *run, const char *path, const struct bytes *bytes)
{
    json_t *document = document_of(path, bytes);
    const char *schema = json_string_value(json_object_get(document, "schema"));
    json_t **place = NULL;
    const char *name = "crackstats.json";
    if (!strncmp(schema, "craquelure/crackstats/", 22)) {
        const bool one = json_integer_value(json_object_get(document, "runs")) == 1;
        place = one ? &run->counted : &run->repeated;
        name = one ? name : "seeds.json";
    } else if (!strncmp(schema, "craquelure/check/", 17)) {
        place = &run->checked;
        name = "check.json";
    }
    if (!place)
        die(STATUS_BAD_DATA, "%s: a page shows no %s", input_name(path), schema);
    if (*place)
        die(STATUS_USAGE, "%s: is a second %s: a page shows one run", input_name(path),
            schema);
    char digest[65];
    sha256(bytes->data, bytes->size, digest);
    note_source(run, name, schema, digest);
    *place = document;
}

static bool was_merged(const struct artifact *network)
{
    return artifact_has_number(network, "/summary/unmerged_throats");
}

// Where ARTIFACT is kept, and under which name; NULL where a page has no use for it.
static struct artifact **place_of(struct run *run, const struct artifact *artifact,
                                  const char **name)
{
    *name = artifact->schema->name;
    if (!strcmp(*name, "flow")) return &run->flow;
    if (!strcmp(*name, "motion")) return &run->motion;
    int kind = 0;
    while (kind < KINDS && strcmp(kind_name[kind], *name))
        kind++;
    if (kind == KINDS) return NULL;
    if (kind != NETWORK || was_merged(artifact)) return &run->of[kind];
    *name = "tessellation";
    return &run->tessellation;
}

static void keep_artifact(struct run *run, struct artifact *artifact)
{
    const char *stem;
    struct artifact **place = place_of(run, artifact, &stem);
    if (!place)
        die(STATUS_BAD_DATA, "%s: a page shows no %s; inspect does",
            input_name(artifact->path), stem);
    if (*place)
        die(STATUS_USAGE, "%s: is a second %s: a page shows one run",
            input_name(artifact->path), artifact->schema->name);
    char name[40];
    snprintf(name, sizeof name, "%s.h5", stem);
    note_source(run, name, artifact->schema->id, artifact->sha256);
    *place = artifact;
}

// The first bytes tell JSON from HDF5. The path is copied, because artifacts keep a
// pointer to it; close_kept frees it.
static void keep(struct run *run, const char *path)
{
    struct bytes bytes = read_whole_of(path, may_be_either);
    if (is_document(&bytes)) {
        keep_document(run, path, &bytes);
        bytes_free(&bytes);
        return;
    }
    char *name = duplicate(path, strlen(path) + 1, 1); // lives as long as the artifact
    keep_artifact(run, artifact_open_bytes(name, bytes, NULL));
}

// A flow or a motion has pictures of its own, which do not go with those of a drying.
static void must_be_alone(const struct run *run)
{
    const struct artifact *alone = run->flow ? run->flow : run->motion;
    if (alone && json_array_size(run->sources) > 1)
        die(STATUS_USAGE, "%s: a page shows a %s by itself, without other artifacts",
            input_name(alone->path), alone->schema->name);
}

static void keep_folder(struct run *run, const char *folder)
{
    if (!has_artifact(folder))
        die(STATUS_NO_INPUT, "%s: holds no artifact of a run", folder);
    for (int k = 0; k < USUAL_NAMES; k++) {
        char *path = find_usual(folder, k);
        if (path) keep(run, path);
        free(path);
    }
}

// ---- whether they are of one run ----------------------------------------------------

// MADE may have been made from several inputs; those of other schemas are not compared.
static void must_fit(const struct artifact *made, const struct artifact *from)
{
    if (!made || !from) return;
    char *text = artifact_get_text(made, "inputs");
    json_t *inputs = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    size_t k;
    json_t *input;
    json_array_foreach(inputs, k, input)
    {
        const char *schema = json_string_value(json_object_get(input, "schema"));
        const char *digest = json_string_value(json_object_get(input, "sha256"));
        if (!schema || !digest || strcmp(schema, from->schema->id) ||
            !strcmp(digest, from->sha256))
            continue;
        die(STATUS_BAD_DATA, "%s: was not made from %s, but from another %s",
            made->path, from->path, from->schema->name);
    }
    json_decref(inputs);
}

// Neighbours of the chain only: each knows its own inputs.
static void check_fit(const struct run *run)
{
    must_fit(run->tessellation, run->of[PACKING]);
    must_fit(run->of[NETWORK], run->tessellation);
    for (int kind = DRYING; kind < KINDS; kind++)
        must_fit(run->of[kind], run->of[kind - 1]);
    const int n = run->packing.n_particle;
    for (int kind = 0; kind < KINDS; kind++) {
        if (!run->of[kind]) continue;
        int rows;
        free(artifact_get(run->of[kind], "/particles/radius", &rows));
        if (rows != n)
            die(STATUS_BAD_DATA, "%s: has %d grains, another artifact %d: not one run",
                input_name(run->of[kind]->path), rows, n);
    }
}

// ---- what they hold -----------------------------------------------------------------

// The last artifact knows of the bonds all others do, and of what the replay made.
static void read_grains_of(struct run *run)
{
    const struct artifact *last = run->tessellation;
    for (int kind = 0; kind < KINDS; kind++)
        last = run->of[kind] ? run->of[kind] : last;
    last = run->flow ? run->flow : run->motion ? run->motion : last;
    if (!last) die(STATUS_USAGE, "no artifact with grains among the inputs");
    run->packing = artifact_get_packing(last);
}

// The drying's network first: it is the one that was dried.
static void read_liquid(struct run *run)
{
    const struct artifact *drying = run->of[DRYING];
    const struct artifact *network = drying             ? drying
                                     : run->of[NETWORK] ? run->of[NETWORK]
                                                        : run->tessellation;
    if (network) run->network = artifact_get_periodic_network(network);
    if (drying) run->record = artifact_get_drying(drying);
}

static void read_cracks(struct run *run)
{
    const struct artifact *response = run->motion ? run->motion : run->of[RESPONSE];
    if (!response) return;
    const struct cracks cracks = artifact_get_cracks(response);
    run->n_crack = cracks.n;
    run->crack_bond = cracks.bond;
    run->crack_time = cracks.time;
    run->crack_saturation = cracks.saturation;
    run->crack_mode = cracks.mode;
    run->n_before = cracks.n_before;
    run->bond_before = cracks.bond_before;
    run->mode_before = cracks.mode_before;
}

// A motion has velocities in place of forces: the arrows of the page are these.
static void read_loads(struct run *run)
{
    const struct artifact *forces = run->of[FORCES];
    if (run->motion) {
        run->load_time = artifact_get(run->motion, "/snapshots/time", &run->n_load);
        run->load = artifact_get(run->motion, "/snapshots/velocity", NULL);
    }
    if (!forces) return;
    run->load_time = artifact_get(forces, "/time", &run->n_load);
    run->load_saturation = artifact_get(forces, "/saturation", NULL);
    run->load = artifact_get(forces, "/force", NULL);
}

struct run run_of_paths(const char *const *paths, int n)
{
    struct run run = {.sources = json_array()};
    for (int k = 0; k < n; k++)
        if (is_folder(paths[k]))
            keep_folder(&run, paths[k]);
        else
            keep(&run, paths[k]);
    must_be_alone(&run);
    read_grains_of(&run);
    check_fit(&run);
    if (run.flow)
        read_flow(&run);
    else
        read_liquid(&run);
    read_cracks(&run);
    read_loads(&run);
    return run;
}

bool counts_steps(const struct run *run)
{
    if (!run->of[RESPONSE] || run->of[DRYING]) return false;
    char *text = artifact_get_text(run->of[RESPONSE], "inputs");
    json_t *inputs = text ? json_loads(text, 0, NULL) : NULL;
    const char *schema =
        json_string_value(json_object_get(json_array_get(inputs, 0), "schema"));
    const bool counts = schema && !strncmp(schema, "craquelure/packing/", 19);
    json_decref(inputs);
    free(text);
    return counts;
}

static void close_kept(struct artifact *artifact)
{
    if (!artifact) return;
    char *path = (char *)(uintptr_t)artifact->path;
    artifact_close(artifact);
    free(path);
}

void close_run(struct run *run)
{
    for (int kind = 0; kind < KINDS; kind++)
        close_kept(run->of[kind]);
    close_kept(run->tessellation);
    close_kept(run->flow);
    close_kept(run->motion);
    json_decref(run->counted);
    json_decref(run->repeated);
    json_decref(run->checked);
    json_decref(run->sources);
    packing_free(&run->packing);
    network_free(&run->network);
    drying_record_free(&run->record);
    free(run->crack_bond);
    free(run->crack_time);
    free(run->crack_saturation);
    free(run->crack_mode);
    free(run->bond_before);
    free(run->mode_before);
    free(run->load_time);
    free(run->load_saturation);
    free(run->load);
    *run = (struct run){0};
}
