// SPDX-License-Identifier: GPL-3.0-or-later
// import-network: a pore network that others made, or that inspect exported.
//
// In this order: read the JSON graph, from a file or standard input, or the node1,
// link1 and link2 files of statoil, which have only a prefix in common and so cannot
// come through a pipe (node2 says nothing that a network keeps); note a digest of each
// file for the provenance; let the format's reader check and build the network
// (formats/jsongraph.h, formats/statoil.h); write it. Files of other programs have no
// grains and faces.
//
// A file that is wrong ends the stage with 65 and one line, with the file's name first.
#include "artifacts/artifact.h"
#include "artifacts/write_network.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "formats/jsongraph.h"
#include "formats/statoil.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum format { FORMAT_OPENPNM, FORMAT_STATOIL };

struct import_parameters {
    int format;
};

static const struct parameter table[] = {
    {"format", PARAMETER_CHOICE, "1", "\"openpnm\"",
     offsetof(struct import_parameters, format), .choices = "openpnm|statoil",
     .text = "openpnm: a JSON graph; statoil: INPUT is the prefix of INPUT_node1.dat, "
             "INPUT_link1.dat and INPUT_link2.dat"},
    {0}};

static const struct stage stage = {
    .name = "import-network",
    .version = STAGE_VERSION,
    .summary = "import-network -- a pore network from another program's files",
    .writes = "network",
    .most_inputs = 1,
    .parameters = table,
    .transcribes = true,
    .notes = "A file of `inspect --openpnm` comes back as it was; other files, and all "
             "those of statoil, give a network without grains and faces."};

// Reads a file and notes its digest. The caller frees the bytes.
static struct bytes read_input(const char *path, const char *schema, json_t *inputs)
{
    const struct bytes bytes = read_whole(path);
    char digest[65];
    sha256(bytes.data, bytes.size, digest);
    json_array_append_new(inputs,
                          json_pack("{s:s,s:s}", "schema", schema, "sha256", digest));
    return bytes;
}

// A key given twice is refused: jansson would keep the last and say nothing.
static struct network import_jsongraph(const char *path, json_t *inputs)
{
    struct bytes bytes = read_input(path, "jsongraph", inputs);
    json_error_t error;
    json_t *document = json_loadb((const char *)bytes.data, bytes.size,
                                  JSON_REJECT_DUPLICATES, &error);
    if (!document)
        die(STATUS_BAD_DATA, "%s: line %d: %s", input_name(path), error.line,
            error.text);
    struct network network;
    struct reason reason;
    const enum status status = network_from_jsongraph(document, &network, &reason);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
    json_decref(document);
    bytes_free(&bytes);
    return network;
}

// One file of statoil, as a string: it ends at a null byte, so there must be none in
// it. The caller frees it.
static char *read_text(const char *prefix, int file, json_t *inputs)
{
    char path[4096];
    snprintf(path, sizeof path, "%s%s", prefix, statoil_endings[file]);
    struct bytes bytes = read_input(path, "text", inputs);
    char *text = allocate(bytes.size + 1, 1);
    memcpy(text, bytes.data, bytes.size);
    if (strlen(text) < bytes.size)
        die(STATUS_BAD_DATA, "%s: holds null bytes: not text", path);
    bytes_free(&bytes);
    return text;
}

// The reason begins with the ending of the file it is about, and so follows PREFIX.
static struct network import_statoil(const char *prefix, json_t *inputs)
{
    char *text[STATOIL_FILES] = {NULL};
    for (int k = 0; k < STATOIL_FILES; k++)
        if (k != STATOIL_NODE2) text[k] = read_text(prefix, k, inputs);
    struct network network;
    struct reason reason;
    const enum status status =
        network_from_statoil((const char *const *)text, &network, &reason);
    if (status) die(status, "%s%s", prefix, reason.text);
    for (int k = 0; k < STATOIL_FILES; k++)
        free(text[k]);
    return network;
}

int main(int argc, char **argv)
{
    struct import_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    const char *path = invocation.n_input ? invocation.inputs[0] : "-";
    const bool statoil = parameters.format == FORMAT_STATOIL;
    if (statoil && !strcmp(path, "-"))
        die(STATUS_USAGE, "format=statoil: needs the prefix of its files");
    json_t *inputs = json_array();
    struct network network =
        statoil ? import_statoil(path, inputs) : import_jsongraph(path, inputs);

    char model[200];
    snprintf(model, sizeof model,
             "imported: %d nodes, %d throats, %d faces, %d grains\n"
             "left out: what else the files say of nodes, and throats to reservoirs\n",
             network.n_node, network.n_throat, network.n_face,
             network.packing.n_particle);
    write_network_of(&network, &invocation, inputs, model);

    network_free(&network);
    invocation_free(&invocation);
    return STATUS_OK;
}
