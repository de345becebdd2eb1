// SPDX-License-Identifier: GPL-3.0-or-later
// A network for other programs: as a JSON graph on one line, ASCII only, with 17
// digits, so that reading it gives the same doubles; or as the four text files of
// statoil.
//
// A network in a box that repeats is refused (artifact_get_network): neither format has
// a place for images.
#include "export.h"

#include "basics/status.h"
#include "formats/jsongraph.h"
#include "formats/statoil.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_jsongraph(const struct network *network, const char *path)
{
    json_t *document = jsongraph_from_network(network);
    char *text = json_dumps(document,
                            JSON_COMPACT | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    if (!text) die(STATUS_INTERNAL, "out of memory");
    write_whole(path, text, strlen(text));
    free(text);
    json_decref(document);
}

static void write_statoil(const struct network *network, const char *prefix)
{
    char *text[STATOIL_FILES];
    statoil_from_network(network, text);
    for (int k = 0; k < STATOIL_FILES; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s%s", prefix, statoil_endings[k]);
        write_whole(path, text[k], strlen(text[k]));
        free(text[k]);
    }
}

void export_network(const struct artifact *artifact, const char *openpnm,
                    const char *statoil)
{
    if (!schema_dataset(artifact->schema, "/throats/nodes"))
        die(STATUS_BAD_DATA, "%s: a %s has no network to export",
            input_name(artifact->path), artifact->schema->name);
    struct network network = artifact_get_network(artifact);
    if (openpnm) write_jsongraph(&network, openpnm);
    if (statoil) write_statoil(&network, statoil);
    network_free(&network);
}
