// SPDX-License-Identifier: GPL-3.0-or-later
// JSON artifacts: told apart from HDF5 by their first bytes, checked against a schema,
// written whole or not at all.
//
// Only the first level of members is checked, by name and type; what is deeper is for
// whoever reads it.
#include "artifacts/document.h"

#include "artifacts/artifact.h"
#include "basics/memory.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An HDF5 file begins with a byte above 127, so "{" decides.
bool is_document(const struct bytes *bytes)
{
    size_t k = 0;
    while (k < bytes->size && isspace(bytes->data[k]))
        k++;
    return k < bytes->size && bytes->data[k] == '{';
}

// Also true while there are blanks only: then more is read.
bool may_be_either(const struct bytes *beginning)
{
    size_t k = 0;
    while (k < beginning->size && isspace(beginning->data[k]))
        k++;
    return k == beginning->size || beginning->data[k] == '{' || is_hdf5(beginning);
}

static bool has_json_type(const json_t *value, const char *type)
{
    if (json_is_null(value)) return strchr(type, '?') != NULL; // "object?" may be null
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return !strncmp(type, "object", 6);
    case JSON_ARRAY:
        return !strncmp(type, "array", 5);
    case JSON_INTEGER:
        return !strncmp(type, "integer", 7) || !strncmp(type, "number", 6);
    case JSON_STRING:
        return !strncmp(type, "string", 6);
    case JSON_REAL:
        return !strncmp(type, "number", 6);
    default:
        return false;
    }
}

enum status check_document(const json_t *document, const struct schema *schema,
                           struct reason *reason)
{
    const json_t *members = json_object_get(schema->document, "members");
    if (!members)
        return refuse(reason, STATUS_BAD_DATA, "a %s is an HDF5 file, not JSON",
                      schema->name);
    size_t k;
    json_t *entry;
    json_array_foreach(members, k, entry)
    {
        const char *name = json_string_value(json_object_get(entry, "name"));
        const char *type = json_string_value(json_object_get(entry, "type"));
        const json_t *value = json_object_get(document, name + 1);
        if (!value && json_is_true(json_object_get(entry, "optional"))) continue;
        if (!value) return refuse(reason, STATUS_BAD_DATA, "%s: is missing", name);
        if (!has_json_type(value, type))
            return refuse(reason, STATUS_BAD_DATA, "%s: must be of type %s", name,
                          type);
    }
    return STATUS_OK;
}

// A new reference; the schema of the document is found by its own id.
json_t *document_of(const char *path, const struct bytes *bytes)
{
    json_error_t error;
    json_t *document = json_loadb((const char *)bytes->data, bytes->size,
                                  JSON_REJECT_DUPLICATES, &error);
    if (!document)
        die(STATUS_BAD_DATA, "%s: line %d: %s", input_name(path), error.line,
            error.text);
    const char *id = json_string_value(json_object_get(document, "schema"));
    if (!id)
        die(STATUS_BAD_DATA, "%s: is not an artifact: it has no schema",
            input_name(path));
    struct schema *schema = schema_find(id);
    if (!schema || strcmp(schema->id, id))
        die(STATUS_BAD_DATA, "%s: schema %s is unknown", input_name(path), id);
    struct reason reason;
    if (check_document(document, schema, &reason))
        die(STATUS_BAD_DATA, "%s: %s", input_name(path), reason.text);
    schema_free(schema);
    return document;
}

// 17 digits give each double back exactly. Takes DOCUMENT over.
void write_json(const char *path, json_t *document)
{
    char *text = json_dumps(document, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    char *line = allocate(strlen(text) + 2, 1);
    sprintf(line, "%s\n", text);
    write_whole(path, line, strlen(line));
    free(line);
    free(text);
    json_decref(document);
}
