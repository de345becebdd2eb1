// SPDX-License-Identifier: GPL-3.0-or-later
// A section is filled in this order: unknown keys are reported with the nearest known
// one, then for each row of the table the value is found (given, or the default), its
// type and bounds are checked, and it is stored at its offset. Problems are counted and
// reported all together, so that a user corrects them in one go.
//
// Keys are paths: "walls.lid.velocity" is a member of a member, in JSON nested objects,
// on the command line dots. Effective parameters are built beside the struct, entry by
// entry; they go into the artifact, so two runs with equal effective parameters are
// equal.
//
// A value in steps: found by its path, or parsed from the default; made a number of its
// type (as_typed); null let through where it may be; type; bounds; stored. What is
// of another type is reported and not stored. Types, and how they lie in the struct,
// stand at enum parameter_type; sizes beyond 1e150 are refused whatever the bound.
#include "parameters/parameters.h"

#include "basics/memory.h"
#include "basics/sorted.h"
#include "basics/status.h"
#include "parameters/spelling.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Squares of what is larger would overflow.
static const double LARGEST_NUMBER = 1e150;

// What a pass over a section knows: where it is, and how many problems it has met.
struct filling {
    const struct parameter *table;
    const char *where;
    int problems;
};

static const char *const type_names[] = {"a number",
                                         "a number or null",
                                         "an integer",
                                         "true or false",
                                         "one of",
                                         "a list of",
                                         "a text",
                                         "three integers",
                                         "three of true or false",
                                         "three numbers",
                                         "a list of at most 1024 numbers",
                                         "an object of named objects"};

char *json_canonical(const json_t *json)
{
    return json_dumps(json, JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(17) |
                                JSON_ENCODE_ANY);
}

// As the user wrote it: numbers with no more digits than they need. The fewest digits
// from 6 on that read back as the same number; 0.1 stays 0.1. At most eleven tries, for
// messages only.
static char *as_written(const json_t *value)
{
    for (int digits = 6; digits < 17; digits++) {
        char *text = json_dumps(value, JSON_SORT_KEYS | JSON_COMPACT |
                                           JSON_REAL_PRECISION((size_t)digits) |
                                           JSON_ENCODE_ANY);
        json_t *back = json_loads(text, JSON_DECODE_ANY, NULL);
        const bool same = json_equal(back, value);
        json_decref(back);
        if (same) return text;
        free(text);
    }
    return json_canonical(value);
}

// The run ends after all complaints (parameters_fill).
static void complain(struct filling *filling, const char *key, const char *rule,
                     const json_t *got)
{
    char *value = got ? as_written(got) : NULL;
    report("%s.%s: must be %s%s%s", filling->where, key, rule, value ? ", got " : "",
           value ? value : "");
    free(value);
    filling->problems++;
}

// ---- one value ----------------------------------------------------------------------

// The place of NAME among "a|b|c", or -1. Whole words only: "in" is not "inviscid".
static int choice_index(const char *choices, const char *name)
{
    const size_t length = strlen(name);
    for (int index = 0;; index++) {
        const char *end = strchrnul(choices, '|');
        if ((size_t)(end - choices) == length && !strncmp(choices, name, length))
            return index;
        if (!*end) return -1;
        choices = end + 1;
    }
}

// False for NAN, which JSON cannot say anyway.
static bool within_bounds(const struct parameter *parameter, double value)
{
    switch (parameter->bound) {
    case BOUND_MINIMUM:
        return value >= parameter->low;
    case BOUND_ABOVE:
        return value > parameter->low;
    case BOUND_BETWEEN:
        return value >= parameter->low && value <= parameter->high;
    case BOUND_NONE:
        break;
    }
    return true;
}

static bool is_number_list(const json_t *value)
{
    if (!json_is_array(value) || json_array_size(value) > LIST_MOST) return false;
    for (size_t k = 0; k < json_array_size(value); k++)
        if (!json_is_number(json_array_get(value, k))) return false;
    return true;
}

// A list of choices is checked entry by entry as it is stored.
static bool has_type(const struct parameter *parameter, const json_t *value)
{
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_NUMBER_OR_NULL:
        return json_is_number(value);
    case PARAMETER_INTEGER:
        return json_is_integer(value);
    case PARAMETER_BOOLEAN:
        return json_is_boolean(value);
    case PARAMETER_CHOICE:
    case PARAMETER_TEXT:
        return json_is_string(value);
    case PARAMETER_CHOICES:
        return json_is_array(value);
    case PARAMETER_LIST:
        return is_number_list(value);
    case PARAMETER_NAMED:
        return json_is_object(value);
    case PARAMETER_COUNTS:
    case PARAMETER_FLAGS:
    case PARAMETER_POINT:
        break;
    }
    if (!json_is_array(value) || json_array_size(value) != 3) return false;
    for (size_t k = 0; k < 3; k++) {
        const json_t *entry = json_array_get(value, k);
        const bool fits = parameter->type == PARAMETER_COUNTS  ? json_is_integer(entry)
                          : parameter->type == PARAMETER_FLAGS ? json_is_boolean(entry)
                                                               : json_is_number(entry);
        if (!fits) return false;
    }
    return true;
}

// Every number of a list or point.
static void check_bounds(struct filling *filling, const struct parameter *parameter,
                         const json_t *value)
{
    char text[80];
    const size_t count = json_is_array(value) ? json_array_size(value) : 1;
    for (size_t k = 0; k < count; k++) {
        const json_t *entry = json_is_array(value) ? json_array_get(value, k) : value;
        if (!json_is_number(entry)) continue;
        const double number = json_number_value(entry);
        if (!within_bounds(parameter, number))
            complain(filling, parameter->key, parameter_rule(parameter, text), value);
        else if (fabs(number) > LARGEST_NUMBER)
            complain(filling, parameter->key, "at most 1e150 in size", value);
    }
}

// 0 after a complaint, so that whoever goes on has a place in the table.
static int checked_choice(struct filling *filling, const struct parameter *parameter,
                          const json_t *value)
{
    const char *name = json_string_value(value);
    const int index = name ? choice_index(parameter->choices, name) : -1;
    if (index >= 0) return index;
    char rule[400];
    snprintf(rule, sizeof rule, "one of %s", parameter->choices);
    complain(filling, parameter->key, rule, value);
    return 0;
}

static double number_or_nan(const json_t *value)
{
    return json_is_null(value) ? (double)NAN : json_number_value(value);
}

// Types are checked before, so nothing here can fail but a choice.
static void store(struct filling *filling, const struct parameter *parameter,
                  const json_t *value, void *parameters)
{
    void *target = (char *)parameters + parameter->offset;
    struct number_list *list = target;
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_NUMBER_OR_NULL:
        *(double *)target = number_or_nan(value);
        break;
    case PARAMETER_INTEGER:
        *(int64_t *)target = json_integer_value(value);
        break;
    case PARAMETER_BOOLEAN:
        *(bool *)target = json_is_true(value);
        break;
    case PARAMETER_CHOICE:
        *(int *)target = checked_choice(filling, parameter, value);
        break;
    case PARAMETER_CHOICES:
        *(unsigned *)target = 0;
        for (size_t k = 0; k < json_array_size(value); k++)
            *(unsigned *)target |=
                1u << checked_choice(filling, parameter, json_array_get(value, k));
        break;
    case PARAMETER_TEXT:
        *(const char **)target = json_string_value(value);
        break;
    case PARAMETER_COUNTS:
        for (size_t k = 0; k < 3; k++)
            ((int64_t *)target)[k] = json_integer_value(json_array_get(value, k));
        break;
    case PARAMETER_FLAGS:
        for (size_t k = 0; k < 3; k++)
            ((bool *)target)[k] = json_is_true(json_array_get(value, k));
        break;
    case PARAMETER_POINT:
        for (size_t k = 0; k < 3; k++)
            ((double *)target)[k] =
                number_or_nan(json_is_null(value) ? value : json_array_get(value, k));
        break;
    case PARAMETER_LIST:
        list->count = (int)json_array_size(value);
        for (size_t k = 0; k < json_array_size(value); k++)
            list->value[k] = json_number_value(json_array_get(value, k));
        break;
    case PARAMETER_NAMED: // take_rows
        break;
    }
}

// ---- the whole section --------------------------------------------------------------

// NULL where there is none; walks along the dots of KEY. The reference is the
// section's. A key that leads through something else than an object is not there.
static json_t *find(const json_t *section, const char *key)
{
    char part[128];
    for (;;) {
        const char *end = strchrnul(key, '.');
        snprintf(part, sizeof part, "%.*s", (int)(end - key), key);
        json_t *value = json_object_get(section, part);
        if (!value || !*end) return value;
        section = value;
        key = end + 1;
    }
}

// Objects on the way are made where they are missing; anything else there is replaced.
static void put(json_t *section, const char *key, json_t *value)
{
    char part[128];
    const char *end;
    for (; *(end = strchrnul(key, '.')); key = end + 1) {
        snprintf(part, sizeof part, "%.*s", (int)(end - key), key);
        json_t *inner = json_object_get(section, part);
        if (!json_is_object(inner)) {
            inner = json_object();
            json_object_set_new(section, part, inner);
        }
        section = inner;
    }
    json_object_set(section, key, value);
}

// Whether KEY can be put into SECTION: false where it is there, or its group is no
// object, of which parameters_fill complains.
static bool lacks(const json_t *section, const char *key)
{
    const char *last = strrchr(key, '.');
    char group[128];
    snprintf(group, sizeof group, "%.*s", last ? (int)(last - key) : 0, key);
    const json_t *inner = last ? find(section, group) : NULL;
    return !(inner && !json_is_object(inner)) && !find(section, key);
}

void parameters_give(json_t *section, const char *key, const json_t *other)
{
    const char *last = strrchr(key, '.');
    json_t *value = json_object_get(other, last ? last + 1 : key);
    if (!value || json_is_null(value) || !lacks(section, key)) return;
    put(section, key, value);
}

bool parameters_borrow(json_t *section, const struct parameter *row,
                       const json_t *other, const char *where, void *parameters)
{
    json_t *value = find(other, row->key);
    if (!value || !lacks(section, row->key)) return false;
    const struct parameter alone[] = {*row, {0}};
    json_t *checked = json_object();
    put(checked, row->key, value);
    json_decref(parameters_fill(alone, checked, where, parameters));
    json_decref(checked);
    put(section, row->key, value);
    return true;
}

// Whether PATH is a group of keys.
static bool is_prefix(const struct parameter *table, const char *path)
{
    const size_t length = strlen(path);
    for (const struct parameter *p = table; p->key; p++)
        if (!strncmp(p->key, path, length) && p->key[length] == '.') return true;
    return false;
}

// Of the table; rows of named objects have their own (take_rows).
static bool is_key(const struct parameter *table, const char *path)
{
    for (const struct parameter *p = table; p->key; p++)
        if (!strcmp(p->key, path)) return true;
    return false;
}

// Edits that turn PATH into KEY, or one more than those between their last parts, where
// PATH is in the wrong group.
static int distance(const char *path, const char *key)
{
    const char *last_of_path = strrchr(path, '.'), *last_of_key = strrchr(key, '.');
    const int whole = edit_distance(path, key);
    const int last = 1 + edit_distance(last_of_path ? last_of_path + 1 : path,
                                       last_of_key ? last_of_key + 1 : key);
    return whole < last ? whole : last;
}

// The key most like PATH; NULL where more than half of its letters differ. By edit
// distance: a typing error, or the right name in the wrong group.
static const char *nearest_key(const struct parameter *table, const char *path)
{
    const char *nearest = NULL;
    int least = (int)strlen(path) / 2 + 1;
    for (const struct parameter *p = table; p->key; p++) {
        const int edits = distance(path, p->key);
        if (edits < least) {
            least = edits;
            nearest = p->key;
        }
    }
    return nearest;
}

static void report_unknown(struct filling *filling, const char *path)
{
    const char *nearest = nearest_key(filling->table, path);
    if (nearest)
        report("%s.%s: unknown key; the nearest known one is %s", filling->where, path,
               nearest);
    else if (filling->table->key)
        report("%s.%s: unknown key; --help lists those there are", filling->where,
               path);
    else
        report("%s.%s: unknown key; this stage has no parameters", filling->where,
               path);
    filling->problems++;
}

// Dots within a key are refused: {"a.b": 1} would look like {"a": {"b": 1}} and mean
// something else.
static void check_keys(struct filling *filling, json_t *object, const char *prefix)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        if (!strcmp(key, "comment")) continue;
        char path[256];
        snprintf(path, sizeof path, "%s%s%s", prefix, *prefix ? "." : "", key);
        if (strchr(key, '.')) {
            complain(filling, path, "nested, {\"a\": {\"b\": ...}}: dots are for --set",
                     NULL);
            continue;
        }
        if (is_key(filling->table, path)) continue;
        if (!is_prefix(filling->table, path))
            report_unknown(filling, path);
        else if (json_is_object(value))
            check_keys(filling, value, path);
        else
            complain(filling, path, "an object", value);
    }
}

// 1 and 1.0 are the same number, 1e6 is an integer, and both must leave the same
// provenance. A new reference.
static json_t *as_typed(const struct parameter *parameter, json_t *value)
{
    const double number = json_number_value(value);
    const bool is_number = parameter->type == PARAMETER_NUMBER ||
                           parameter->type == PARAMETER_NUMBER_OR_NULL;
    if (is_number && json_is_integer(value)) return json_real(number);
    if (parameter->type == PARAMETER_INTEGER && json_is_real(value) &&
        fabs(number) <= 0x1p53 && number == rint(number))
        return json_integer((json_int_t)number);
    return json_incref(value);
}

static json_t *fill(struct filling *filling, json_t *section, void *parameters);

// The names in OBJECT, sorted. By strcmp: the order of a JSON object must not matter.
static struct named_rows sorted_names(json_t *object)
{
    struct named_rows rows = {.name =
                                  NEW_ARRAY(const char *, json_object_size(object))};
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) if (strcmp(key, "comment"))
        rows.name[rows.count++] = key;
    if (rows.count > 0)
        qsort(rows.name, (size_t)rows.count, sizeof *rows.name, rising_texts);
    return rows;
}

// Fills a struct for each name in OBJECT, and returns what they are in effect. Each row
// is filled like a section of its own; its problems count with those of the whole.
static json_t *take_rows(struct filling *filling, const struct parameter *parameter,
                         json_t *object, struct named_rows *target)
{
    json_t *effective = json_object();
    struct named_rows rows = sorted_names(object);
    rows.row = allocate((size_t)rows.count, parameter->row_size);
    for (int k = 0; k < rows.count; k++) {
        json_t *entry = json_object_get(object, rows.name[k]);
        char where[512], path[256];
        snprintf(path, sizeof path, "%s.%s", parameter->key, rows.name[k]);
        snprintf(where, sizeof where, "%s.%s", filling->where, path);
        if (strchr(rows.name[k], '.')) {
            complain(filling, path, "a name without dots: those are for --set", NULL);
            continue;
        }
        if (!json_is_object(entry)) {
            complain(filling, path, "an object", entry);
            continue;
        }
        struct filling inner = {.table = parameter->of, .where = where};
        json_object_set_new(
            effective, rows.name[k],
            fill(&inner, entry, (char *)rows.row + (size_t)k * parameter->row_size));
        filling->problems += inner.problems;
    }
    *target = rows;
    for (int k = 0; k < rows.count; k++) // the names of EFFECTIVE outlive the input
        rows.name[k] =
            json_object_iter_key(json_object_iter_at(effective, rows.name[k]));
    return effective;
}

void named_rows_free(struct named_rows *rows)
{
    free(rows->name);
    free(rows->row);
    *rows = (struct named_rows){0};
}

// Rows are few: a linear search.
int named_row(const struct named_rows *rows, const char *name)
{
    for (int k = 0; k < rows->count; k++)
        if (!strcmp(rows->name[k], name)) return k;
    return -1;
}

// Defaults are JSON texts, so that a default takes the same way as a value. The
// value goes into the effective ones even after a complaint: the program ends before
// anyone reads them.
static void take(struct filling *filling, const struct parameter *parameter,
                 const json_t *section, json_t *effective, void *parameters)
{
    json_t *given = find(section, parameter->key);
    if (!given && !parameter->fallback) {
        complain(filling, parameter->key, "given: it has no default", NULL);
        return;
    }
    json_t *value = given ? json_incref(given)
                          : json_loads(parameter->fallback, JSON_DECODE_ANY, NULL);
    if (!value)
        die(STATUS_INTERNAL, "%s: the default is not JSON: %s", parameter->key,
            parameter->fallback);
    if (parameter->type == PARAMETER_NAMED && json_is_object(value)) {
        json_t *rows = take_rows(filling, parameter, value,
                                 (void *)((char *)parameters + parameter->offset));
        put(effective, parameter->key, rows);
        json_decref(rows);
        json_decref(value);
        return;
    }
    json_t *typed = as_typed(parameter, value);
    const bool left_out = json_is_null(value) && parameter_may_be_null(parameter);
    if (left_out || has_type(parameter, typed)) {
        if (!left_out) check_bounds(filling, parameter, value);
        store(filling, parameter, typed, parameters);
    } else {
        char rule[400];
        snprintf(rule, sizeof rule, "%s%s%s", type_names[parameter->type],
                 parameter->choices ? " " : "",
                 parameter->choices ? parameter->choices : "");
        complain(filling, parameter->key, rule, value);
    }
    put(effective, parameter->key, typed);
    json_decref(typed);
    json_decref(value);
}

// By the table of FILLING.
static json_t *fill(struct filling *filling, json_t *section, void *parameters)
{
    json_t *effective = json_object();
    check_keys(filling, section, "");
    for (const struct parameter *p = filling->table; p->key; p++)
        take(filling, p, section, effective, parameters);
    return effective;
}

// The section is not changed.
json_t *parameters_fill(const struct parameter *table, const json_t *section,
                        const char *where, void *parameters)
{
    struct filling filling = {.table = table, .where = where};
    json_t *own = section ? json_incref((json_t *)(uintptr_t)section) : json_object();
    json_t *effective = fill(&filling, own, parameters);
    json_decref(own);
    if (filling.problems) exit(STATUS_BAD_DATA);
    return effective;
}

// ---- what nothing uses --------------------------------------------------------------

// Whether KEY, or a group that it is in, is one of "a|b|c".
static bool is_among(const char *keys, const char *key)
{
    char part[128];
    for (const char *end = key;; end++) {
        end = strchrnul(end, '.');
        snprintf(part, sizeof part, "%.*s", (int)(end - key), key);
        if (choice_index(keys, part) >= 0) return true;
        if (!*end) return false;
    }
}

// As json_equal, but 1 is 1.0, also within arrays.
static bool is_same(const json_t *a, const json_t *b)
{
    const double difference = json_number_value(a) - json_number_value(b);
    if (json_is_number(a) && json_is_number(b)) return !(fabs(difference) > 0);
    if (!json_is_array(a) || json_array_size(a) != json_array_size(b))
        return json_equal(a, b);
    for (size_t k = 0; k < json_array_size(a); k++)
        if (!is_same(json_array_get(a, k), json_array_get(b, k))) return false;
    return true;
}

static bool is_default(const struct parameter *parameter, const json_t *value)
{
    json_t *fallback = json_loads(parameter->fallback, JSON_DECODE_ANY, NULL);
    const bool same = is_same(value, fallback);
    json_decref(fallback);
    return same;
}

enum status refuse_unused(const struct parameter *table, const json_t *effective,
                          const struct unused_keys *rules, size_t count,
                          struct reason *reason)
{
    for (size_t k = 0; k < count; k++)
        for (const struct parameter *p = table; p->key && rules[k].unused; p++) {
            const json_t *value = find(effective, p->key);
            if (!is_among(rules[k].keys, p->key) || is_default(p, value)) continue;
            char *got = as_written(value);
            refuse(reason, STATUS_BAD_DATA, "%s: must be left out %s, got %s", p->key,
                   rules[k].why, got);
            free(got);
            return STATUS_BAD_DATA;
        }
    return STATUS_OK;
}

// ---- --set --------------------------------------------------------------------------

// What is not JSON is text: --set dry.liquid=viscous needs no quotes. But no text
// begins as a list or an object.
void parameters_set(json_t *section, const char *assignment)
{
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment)
        die(STATUS_USAGE, "--set %s: must be KEY=VALUE", assignment);
    char *key = strndup(assignment, (size_t)(equals - assignment));
    json_error_t error;
    json_t *value =
        json_loads(equals + 1, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, &error);
    if (!value && (equals[1] == '[' || equals[1] == '{'))
        die(STATUS_USAGE, "--set %s: is not JSON: %s", assignment, error.text);
    if (!value) value = json_string(equals + 1);
    json_t *name = json_string(key); // NULL where it is not UTF-8
    if (!value || !name) die(STATUS_USAGE, "--set %s: is not UTF-8", assignment);
    json_decref(name);
    put(section, key, value);
    json_decref(value);
    free(key);
}
