// SPDX-License-Identifier: GPL-3.0-or-later
// The first 8 bytes tell an HDF5 artifact, a LAMMPS dump and plain text apart; each has
// its reader (read.c, formats/lammps.c, formats/grain_text.c).
//
// Only an HDF5 file or a dump says what the box is; of text the box is where the grains
// end. The provenance has the schema and digest of an artifact, and "text" with a
// digest of anything else: check goes by that to know what has no bonds yet.
#include "artifacts/read_grains.h"

#include "artifacts/artifact.h"
#include "basics/status.h"
#include "formats/grains.h"
#include "formats/heading.h"
#include "geometry/radius_unit.h"

#include <stdlib.h>
#include <string.h>

static struct packing read_lines(const char *path, struct bytes text, int64_t frame,
                                 double *unit, bool *diameters, json_t *inputs)
{
    struct packing packing;
    struct reason reason;
    const bool is_dump = is_lammps(&text);
    if (is_dump) *unit = lammps_unit(&text);
    const enum status status =
        is_dump ? import_lammps(&text, frame, &packing, diameters, &reason)
                : import_text(&text, &packing, unit, &reason);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
    char digest[65];
    sha256(text.data, text.size, digest);
    json_array_append_new(inputs,
                          json_pack("{s:s,s:s}", "schema", "text", "sha256", digest));
    return packing;
}

static struct packing read_artifact(const char *path, struct bytes image,
                                    const char *schema, json_t *inputs)
{
    struct artifact *artifact = artifact_open_bytes(path, image, schema);
    if (!schema_dataset(artifact->schema, "/particles/position"))
        die(STATUS_BAD_DATA, "%s: must hold grains, is a %s", input_name(path),
            artifact->schema->name);
    const struct packing packing = artifact_get_packing(artifact);
    json_array_append_new(inputs, input_digest(artifact));
    artifact_close(artifact);
    return packing;
}

// Text of grains begins with a number, a comment or the names of columns: other text
// may have no end.
static bool may_hold_grains(const struct bytes *beginning)
{
    size_t k = size_of_mark(beginning);
    while (k < beginning->size && strchr(" \t\r\n,;", beginning->data[k]))
        k++;
    const char *line = (const char *)beginning->data + k;
    const char *end = memchr(line, '\n', beginning->size - k);
    struct heading heading;
    return k == beginning->size || strchr("0123456789+-.#", *line) ||
           is_hdf5(beginning) || !memcmp(beginning->data, "ITEM", 4) ||
           read_heading(line, end ? (size_t)(end - line) : beginning->size - k,
                        &heading);
}

// An empty standard input gets a line of its own: mostly an input was forgotten. The
// bytes of an artifact become its image, those of text are freed here.
struct packing read_grains(const char *path, const char *schema, int64_t frame,
                           bool *has_box, double *unit, bool *diameters, json_t *inputs)
{
    struct bytes bytes = read_whole_of(path, may_hold_grains);
    if (!bytes.size && !strcmp(path, "-"))
        die(STATUS_BAD_DATA, "standard input: no grains: method=import takes them from "
                             "an input, make run from IMPORT=FILE");
    double of_text = 0;
    if (unit) *unit = 0;
    if (has_box) *has_box = is_hdf5(&bytes) || is_lammps(&bytes);
    if (is_hdf5(&bytes)) return read_artifact(path, bytes, schema, inputs);
    const struct packing packing =
        read_lines(path, bytes, frame, &of_text, diameters, inputs);
    if (unit) *unit = of_text;
    bytes_free(&bytes);
    return packing;
}

// Where diameters were taken for radii, a box drawn around the grains is too wide by
// what is now halved: it is drawn again.
void convert_grains(struct packing *packing, double by, bool diameters, bool has_box)
{
    for (int i = 0; i < packing->n_particle; i++) {
        packing->position[i] = scale(by, packing->position[i]);
        packing->radius[i] *= diameters ? 0.5 * by : by;
    }
    packing->lower = scale(by, packing->lower);
    packing->upper = scale(by, packing->upper);
    for (int b = 0; b < packing->n_body; b++) {
        packing->body[b].lower = scale(by, packing->body[b].lower);
        packing->body[b].upper = scale(by, packing->body[b].upper);
    }
    if (!has_box && diameters) box_around(packing);
}

void refuse_large_radii(const struct packing *packing, const char *path)
{
    const double unit = radius_unit(packing);
    if (unit < 1)
        die(STATUS_BAD_DATA,
            "%s: /particles/radius: radii in another unit than places? Times %g they "
            "would make a body; as they are, each grain overlaps with most others",
            input_name(path), unit);
}
