// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON texts are part of the program (schema_NAME). Each call parses the one asked
// for; datasets of the schemas it "extends" come first, in their order.
//
// Schemas are data, so the product, its documents and other programs read one and the
// same text. A new schema needs a file in schemas/, a line here and one where it is
// linked in.
#include "artifacts/schema.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <stdlib.h>
#include <string.h>

extern const char schema_packing[], schema_network[], schema_drying[], schema_forces[],
    schema_response[], schema_crackstats[], schema_engine[], schema_restart[],
    schema_bridge[], schema_flow[], schema_invasion[], schema_check[], schema_motion[],
    schema_shearstats[], schema_rings[];

static const struct {
    const char *name, *text;
} schemas[] = {{"packing", schema_packing},   {"network", schema_network},
               {"drying", schema_drying},     {"forces", schema_forces},
               {"response", schema_response}, {"crackstats", schema_crackstats},
               {"engine", schema_engine},     {"restart", schema_restart},
               {"bridge", schema_bridge},     {"flow", schema_flow},
               {"invasion", schema_invasion}, {"check", schema_check},
               {"motion", schema_motion},     {"shearstats", schema_shearstats},
               {"rings", schema_rings}};

// A schema that does not parse is our own error.
static json_t *load(const char *text)
{
    json_error_t error;
    json_t *document = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!document) die(STATUS_INTERNAL, "schema: line %d: %s", error.line, error.text);
    return document;
}

static int index_of(const char *name)
{
    for (int k = 0; k < (int)(sizeof schemas / sizeof *schemas); k++)
        if (!strcmp(schemas[k].name, name)) return k;
    return -1;
}

// "craquelure/packing/1" -> "packing". A bare name and a whole id are both understood.
static void strip(const char *name, char stripped[64])
{
    const char *begin = strncmp(name, "craquelure/", 11) ? name : name + 11;
    snprintf(stripped, 64, "%.*s", (int)strcspn(begin, "/"), begin);
}

// NULL for a name that is not known. Extended schemas are not extended further.
struct schema *schema_find(const char *name)
{
    char stripped[64];
    strip(name, stripped);
    const int index = index_of(stripped);
    if (index < 0) return NULL;

    json_t *document = load(schemas[index].text);
    json_t *datasets = json_array();
    size_t k;
    json_t *base;
    json_array_foreach(json_object_get(document, "extends"), k, base)
    {
        json_t *extended = load(schemas[index_of(json_string_value(base))].text);
        json_array_extend(datasets, json_object_get(extended, "datasets"));
        json_decref(extended);
    }
    json_array_extend(datasets, json_object_get(document, "datasets"));

    struct schema *schema = NEW_ARRAY(struct schema, 1);
    *schema =
        (struct schema){.name = schemas[index].name,
                        .id = json_string_value(json_object_get(document, "schema")),
                        .document = document,
                        .datasets = datasets,
                        .attributes = json_object_get(document, "attributes")};
    return schema;
}

void schema_free(struct schema *schema)
{
    if (!schema) return;
    json_decref(schema->datasets);
    json_decref(schema->document);
    free(schema);
}

static const json_t *find_entry(const json_t *list, const char *name)
{
    size_t k;
    json_t *entry;
    json_array_foreach(list, k, entry)
    {
        if (!strcmp(json_string_value(json_object_get(entry, "name")), name))
            return entry;
    }
    return NULL;
}

const json_t *schema_dataset(const struct schema *schema, const char *name)
{
    return find_entry(schema->datasets, name);
}

const json_t *schema_attribute(const struct schema *schema, const char *name)
{
    return find_entry(schema->attributes, name);
}

// A dataset has a shape, an attribute of a group has none.
bool has_entry(hid_t file, const json_t *entry)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    if (json_object_get(entry, "shape")) return H5Lexists(file, name, H5P_DEFAULT) > 0;
    char group[128];
    snprintf(group, sizeof group, "%.*s", (int)(strrchr(name, '/') - name), name);
    return H5Aexists_by_name(file, group, strrchr(name, '/') + 1, H5P_DEFAULT) > 0;
}

// Types in files are little-endian, whatever the machine; in memory they are its own.
static int type_index(const json_t *entry)
{
    static const char *const names[] = {"float64", "int32", "int64", "uint8", "int8"};
    const char *type = json_string_value(json_object_get(entry, "type"));
    for (int k = 0; type && k < 5; k++)
        if (!strcmp(names[k], type)) return k;
    die(STATUS_INTERNAL, "schema: unknown type %s", type ? type : "(none)");
}

hid_t entry_file_type(const json_t *entry)
{
    const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U8LE,
                           H5T_STD_I8LE};
    return types[type_index(entry)];
}

hid_t entry_memory_type(const json_t *entry)
{
    const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT32, H5T_NATIVE_INT64,
                           H5T_NATIVE_UINT8, H5T_NATIVE_INT8};
    return types[type_index(entry)];
}
