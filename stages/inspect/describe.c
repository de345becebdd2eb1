// SPDX-License-Identifier: GPL-3.0-or-later
// An artifact as JSON. The schema says which datasets and attributes there can be, with
// units and text; shape, extremes and digest are computed from the file.
//
// Whole numbers by their schema are printed without a point. The digest is of the
// values in the type of the file, so it does not depend on compression or on where
// datasets lie.
#include "describe.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <stdlib.h>
#include <string.h>

// By the type of the schema, not by the value: 3.0 stays 3.0.
static json_t *number(double value, const json_t *entry)
{
    return strcmp(json_string_value(json_object_get(entry, "type")), "float64")
               ? json_integer((json_int_t)value)
               : json_real(value);
}

// ---- one dataset --------------------------------------------------------------------

// In file types: the same values have the same digest on any machine.
static void put_digest(json_t *description, const struct artifact *artifact,
                       const json_t *entry)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    const hid_t dataset = H5Dopen2(artifact->file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    const size_t size = (size_t)H5Sget_simple_extent_npoints(space) *
                        H5Tget_size(entry_file_type(entry));
    void *data = allocate(size, 1);
    char digest[65];
    if (H5Dread(dataset, entry_file_type(entry), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) <
        0)
        die(STATUS_BAD_DATA, "%s: cannot be read", name);
    sha256(data, size, digest);
    json_object_set_new(description, "sha256", json_string(digest));
    free(data);
    H5Sclose(space);
    H5Dclose(dataset);
}

static void put_extremes(json_t *description, const struct dataset_values *values,
                         const json_t *entry)
{
    if (!values->count) return;
    double least = values->value[0], most = values->value[0];
    for (size_t k = 1; k < values->count; k++) {
        least = values->value[k] < least ? values->value[k] : least;
        most = values->value[k] > most ? values->value[k] : most;
    }
    json_object_set_new(description, "minimum", number(least, entry));
    json_object_set_new(description, "maximum", number(most, entry));
}

static json_t *describe_dataset(const struct artifact *artifact, const json_t *entry)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    struct dataset_values values = artifact_get_values(artifact, name);
    json_t *shape = json_array();
    for (int axis = 0; axis < values.rank; axis++)
        json_array_append_new(shape, json_integer((json_int_t)values.extent[axis]));
    json_t *description = json_pack("{s:s,s:O,s:o,s:O,s:O}", "name", name, "type",
                                    json_object_get(entry, "type"), "shape", shape,
                                    "units", json_object_get(entry, "units"), "text",
                                    json_object_get(entry, "text"));
    put_extremes(description, &values, entry);
    put_digest(description, artifact, entry);
    free(values.value);
    return description;
}

// ---- the artifact -------------------------------------------------------------------

// Cuts TEXT in place.
static json_t *lines_of(char *text)
{
    json_t *lines = json_array();
    for (char *line; text && (line = strsep(&text, "\n"));)
        if (*line) json_array_append_new(lines, json_string(line));
    return lines;
}

// JSON where it is JSON (parameters, inputs), else text; null where it is missing.
static void put_provenance(json_t *description, const struct artifact *artifact)
{
    for (const char *const *name = provenance_names; *name; name++) {
        char *text = artifact_get_text(artifact, *name);
        json_t *value = NULL;
        if (text && !strcmp(*name, "model"))
            value = lines_of(text);
        else if (text)
            value = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
        if (text && !value) value = json_string(text);
        json_object_set_new(description, *name, value ? value : json_null());
        free(text);
    }
}

// Puts each attribute into the object of its group: "summary", "liquid", ...
static void put_attributes(json_t *description, const struct artifact *artifact)
{
    json_object_set_new(description, "summary", json_object());
    size_t k;
    json_t *entry;
    json_array_foreach(artifact->schema->attributes, k, entry)
    {
        if (!has_entry(artifact->file, entry)) continue;
        const char *name = json_string_value(json_object_get(entry, "name"));
        const char *last = strrchr(name, '/');
        char group[64];
        snprintf(group, sizeof group, "%.*s", (int)(last - name - 1), name + 1);
        if (!json_object_get(description, group))
            json_object_set_new(description, group, json_object());
        json_object_set_new(json_object_get(description, group), last + 1,
                            number(artifact_get_number(artifact, name), entry));
    }
}

json_t *describe_artifact(const struct artifact *artifact)
{
    json_t *description =
        json_pack("{s:s,s:s,s:I}", "schema", artifact->schema->id, "sha256",
                  artifact->sha256, "bytes", (json_int_t)artifact->image.size);
    put_provenance(description, artifact);
    put_attributes(description, artifact);
    json_t *datasets = json_array();
    size_t k;
    json_t *entry;
    json_array_foreach(artifact->schema->datasets, k, entry)
    {
        if (!has_entry(artifact->file, entry)) continue;
        json_array_append_new(datasets, describe_dataset(artifact, entry));
    }
    json_object_set_new(description, "datasets", datasets);
    return description;
}

// Lists in lists, by the rank of the dataset; row-major.
static json_t *nested(const struct dataset_values *values, int axis, size_t *at,
                      const json_t *entry)
{
    if (axis == values->rank) return number(values->value[(*at)++], entry);
    json_t *list = json_array();
    for (hsize_t k = 0; k < values->extent[axis]; k++)
        json_array_append_new(list, nested(values, axis + 1, at, entry));
    return list;
}

json_t *dataset_json(const struct artifact *artifact, const char *name)
{
    char absolute[256]; // with or without the first slash, as h5py
    snprintf(absolute, sizeof absolute, "%s%s", *name == '/' ? "" : "/", name);
    const json_t *entry = schema_dataset(artifact->schema, absolute);
    if (!entry)
        die(STATUS_BAD_DATA,
            "%s: has no dataset %s (a %s has none; without --data inspect lists those "
            "it has)",
            input_name(artifact->path), name, artifact->schema->name);
    if (!has_entry(artifact->file, entry))
        die(STATUS_BAD_DATA, "%s: has no dataset %s: it was left out",
            input_name(artifact->path), name);
    struct dataset_values values = artifact_get_values(artifact, absolute);
    size_t at = 0;
    json_t *list = nested(&values, 0, &at, entry);
    free(values.value);
    return list;
}
