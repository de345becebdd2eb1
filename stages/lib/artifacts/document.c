// SPDX-License-Identifier: GPL-3.0-or-later
#include "artifacts/document.h"

#include "artifacts/check.h"
#include "basics/status.h"

#include <ctype.h>
#include <string.h>

bool is_document(const struct bytes *bytes)
{
    size_t k = 0;
    while (k < bytes->size && isspace(bytes->data[k]))
        k++;
    return k < bytes->size && bytes->data[k] == '{';
}

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
