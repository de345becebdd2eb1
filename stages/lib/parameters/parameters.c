// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters/parameters.h"

#include "basics/memory.h"
#include "basics/status.h"
#include "parameters/spelling.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Squares of what is larger would overflow.
static const double largest_number = 1e150;

// What a pass over a section knows: where it is, and how many problems it has met.
struct filling {
    const struct parameter *table;
    const char *where;
    int problems;
};

static const char *const type_names[] = {
    "a number",       "an integer",
    "true or false",  "one of",
    "a list of",      "a text",
    "three integers", "three of true or false",
    "three numbers",  "a list of at most 1024 numbers"};

char *json_canonical(const json_t *json)
{
    return json_dumps(json, JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(17) |
                                JSON_ENCODE_ANY);
}

// As the user wrote it: numbers with no more digits than they need.
static char *as_written(const json_t *value)
{
    for (int digits = 6; digits < 17; digits++) {
        char *text =
            json_dumps(value, JSON_SORT_KEYS | JSON_COMPACT |
                                  JSON_REAL_PRECISION(digits) | JSON_ENCODE_ANY);
        json_t *back = json_loads(text, JSON_DECODE_ANY, NULL);
        const bool same = json_equal(back, value);
        json_decref(back);
        if (same) return text;
        free(text);
    }
    return json_canonical(value);
}

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

// As short as it can be without losing a digit.
static const char *number_text(double value, char text[24])
{
    snprintf(text, 24, "%g", value);
    if (strtod(text, NULL) != value) snprintf(text, 24, "%.10g", value);
    return text;
}

static const char *bound_text(const struct parameter *parameter, char text[80])
{
    char low[24], high[24];
    number_text(parameter->low, low);
    number_text(parameter->high, high);
    const char *unit = strcmp(parameter->unit, "1") ? parameter->unit : "";
    const char *space = *unit ? " " : "";
    text[0] = 0;
    if (parameter->bound == BOUND_MINIMUM)
        snprintf(text, 80, ">= %s%s%s", low, space, unit);
    if (parameter->bound == BOUND_ABOVE)
        snprintf(text, 80, "> %s%s%s", low, space, unit);
    if (parameter->bound == BOUND_BETWEEN)
        snprintf(text, 80, "from %s to %s%s%s", low, high, space, unit);
    return text;
}

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

static bool has_type(const struct parameter *parameter, const json_t *value)
{
    switch (parameter->type) {
    case PARAMETER_NUMBER:
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
            complain(filling, parameter->key, bound_text(parameter, text), value);
        else if (fabs(number) > largest_number)
            complain(filling, parameter->key, "at most 1e150 in size", value);
    }
}

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

static void store(struct filling *filling, const struct parameter *parameter,
                  const json_t *value, void *parameters)
{
    void *target = (char *)parameters + parameter->offset;
    size_t k;
    json_t *entry;
    switch (parameter->type) {
    case PARAMETER_NUMBER:
        *(double *)target =
            json_is_null(value) ? (double)NAN : json_number_value(value);
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
        json_array_foreach((json_t *)(uintptr_t)value, k, entry) * (unsigned *)target |=
            1u << checked_choice(filling, parameter, entry);
        break;
    case PARAMETER_TEXT:
        *(const char **)target = json_string_value(value);
        break;
    case PARAMETER_COUNTS:
        for (k = 0; k < 3; k++)
            ((int64_t *)target)[k] = json_integer_value(json_array_get(value, k));
        break;
    case PARAMETER_FLAGS:
        for (k = 0; k < 3; k++)
            ((bool *)target)[k] = json_is_true(json_array_get(value, k));
        break;
    case PARAMETER_LIST:
        ((struct number_list *)target)->count = (int)json_array_size(value);
        json_array_foreach((json_t *)(uintptr_t)value, k,
                           entry)((struct number_list *)target)
            ->value[k] = json_number_value(entry);
        break;
    case PARAMETER_POINT:
        for (k = 0; k < 3; k++)
            ((double *)target)[k] = json_is_null(value)
                                        ? (double)NAN
                                        : json_number_value(json_array_get(value, k));
        break;
    }
}

// ---- the whole section --------------------------------------------------------------

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

static bool is_prefix(const struct parameter *table, const char *path)
{
    const size_t length = strlen(path);
    for (const struct parameter *p = table; p->key; p++)
        if (!strncmp(p->key, path, length) && p->key[length] == '.') return true;
    return false;
}

static bool is_key(const struct parameter *table, const char *path)
{
    for (const struct parameter *p = table; p->key; p++)
        if (!strcmp(p->key, path)) return true;
    return false;
}

static void report_unknown(struct filling *filling, const char *path)
{
    const char *nearest = NULL;
    int least = 1 << 20;
    for (const struct parameter *p = filling->table; p->key; p++) {
        const int edits = edit_distance(path, p->key);
        if (edits < least) {
            least = edits;
            nearest = p->key;
        }
    }
    if (nearest)
        report("%s.%s: unknown key; the nearest known one is %s", filling->where, path,
               nearest);
    else
        report("%s.%s: unknown key; this stage has no parameters", filling->where,
               path);
    filling->problems++;
}

static void check_keys(struct filling *filling, json_t *object, const char *prefix)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        if (!strcmp(key, "comment")) continue;
        char path[256];
        snprintf(path, sizeof path, "%s%s%s", prefix, *prefix ? "." : "", key);
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
    if (parameter->type == PARAMETER_NUMBER && json_is_integer(value))
        return json_real(number);
    if (parameter->type == PARAMETER_INTEGER && json_is_real(value) &&
        fabs(number) <= 0x1p53 && number == rint(number))
        return json_integer((json_int_t)number);
    return json_incref(value);
}

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
    json_t *typed = as_typed(parameter, value);
    const bool left_out = json_is_null(value) && parameter->fallback &&
                          !strcmp(parameter->fallback, "null");
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

json_t *parameters_fill(const struct parameter *table, const json_t *section,
                        const char *where, void *parameters)
{
    struct filling filling = {.table = table, .where = where};
    json_t *effective = json_object();
    json_t *own = section ? json_incref((json_t *)(uintptr_t)section) : json_object();
    check_keys(&filling, own, "");
    for (const struct parameter *p = table; p->key; p++)
        take(&filling, p, own, effective, parameters);
    json_decref(own);
    if (filling.problems) exit(STATUS_BAD_DATA);
    return effective;
}

void parameters_set(json_t *section, const char *assignment)
{
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment)
        die(STATUS_USAGE, "--set %s: must be KEY=VALUE", assignment);
    char *key = strndup(assignment, (size_t)(equals - assignment));
    json_t *value =
        json_loads(equals + 1, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL);
    if (!value) value = json_string(equals + 1);
    json_t *name = json_string(key); // NULL where it is not UTF-8
    if (!value || !name) die(STATUS_USAGE, "--set %s: is not UTF-8", assignment);
    json_decref(name);
    put(section, key, value);
    json_decref(value);
    free(key);
}

// ---- what the table tells the user --------------------------------------------------

enum { HELP_WIDTH = 78 }; // argp wraps at 79, without our indent

// Words of TEXT, wrapped, each line behind INDENT blanks.
static void print_wrapped(FILE *stream, const char *text, int indent)
{
    int column = fprintf(stream, "%*s", indent, "");
    while (*text) {
        const int length = (int)strcspn(text, " ");
        if (column > indent && column + 1 + length > HELP_WIDTH)
            column = fprintf(stream, "\n%*s", indent, "") - 1;
        if (column > indent) column += fprintf(stream, " ");
        column += fprintf(stream, "%.*s", length, text);
        text += length;
        text += strspn(text, " ");
    }
    fprintf(stream, "\n");
}

// [one|another], on the line that COLUMN characters stand on, or on lines of its own.
static void print_choices(FILE *stream, const char *choices, int column)
{
    const bool fits = column + (int)strlen(choices) + 4 <= HELP_WIDTH;
    column = fprintf(stream, fits ? "  [" : "\n        [");
    for (const char *end; *choices; choices = end + (*end == '|')) {
        end = strchrnul(choices, '|');
        const int length = (int)(end - choices) + 1; // with the bar or bracket behind
        if (!fits && column + length > HELP_WIDTH)
            column = fprintf(stream, "\n%9s", "");
        column += fprintf(stream, "%.*s%c", length - 1, choices, *end ? '|' : ']');
    }
}

void parameters_print(const struct parameter *table, FILE *stream)
{
    for (const struct parameter *p = table; p->key; p++) {
        char bound[80];
        int column = fprintf(stream, "  %s=%s", p->key,
                             p->fallback ? p->fallback : "(required)");
        if (strcmp(p->unit, "1")) column += fprintf(stream, " %s", p->unit);
        if (p->choices) print_choices(stream, p->choices, column);
        if (p->bound) fprintf(stream, "  [%s]", bound_text(p, bound));
        fprintf(stream, "\n");
        print_wrapped(stream, p->text, 8);
    }
}

static json_t *split_choices(const char *choices)
{
    json_t *names = json_array();
    for (const char *end;; choices = end + 1) {
        end = strchrnul(choices, '|');
        json_array_append_new(names, json_stringn(choices, (size_t)(end - choices)));
        if (!*end) return names;
    }
}

static json_t *bounded(const struct parameter *parameter, const char *type)
{
    json_t *schema = json_pack("{s:s}", "type", type);
    if (parameter->bound == BOUND_ABOVE)
        json_object_set_new(schema, "exclusiveMinimum", json_real(parameter->low));
    if (parameter->bound == BOUND_MINIMUM || parameter->bound == BOUND_BETWEEN)
        json_object_set_new(schema, "minimum", json_real(parameter->low));
    if (parameter->bound == BOUND_BETWEEN)
        json_object_set_new(schema, "maximum", json_real(parameter->high));
    return schema;
}

static json_t *three_of(json_t *items)
{
    return json_pack("{s:s,s:o,s:i,s:i}", "type", "array", "items", items, "minItems",
                     3, "maxItems", 3);
}

static json_t *value_schema(const struct parameter *parameter)
{
    switch (parameter->type) {
    case PARAMETER_NUMBER:
        return bounded(parameter, "number");
    case PARAMETER_INTEGER:
        return bounded(parameter, "integer");
    case PARAMETER_BOOLEAN:
        return json_pack("{s:s}", "type", "boolean");
    case PARAMETER_TEXT:
        return json_pack("{s:s}", "type", "string");
    case PARAMETER_CHOICE:
        return json_pack("{s:o}", "enum", split_choices(parameter->choices));
    case PARAMETER_CHOICES:
        return json_pack("{s:s,s:{s:o}}", "type", "array", "items", "enum",
                         split_choices(parameter->choices));
    case PARAMETER_LIST:
        return json_pack("{s:s,s:o,s:i}", "type", "array", "items",
                         bounded(parameter, "number"), "maxItems", LIST_MOST);
    case PARAMETER_COUNTS:
        return three_of(bounded(parameter, "integer"));
    case PARAMETER_FLAGS:
        return three_of(json_pack("{s:s}", "type", "boolean"));
    case PARAMETER_POINT:
        return three_of(bounded(parameter, "number"));
    }
    return NULL;
}

static json_t *open_object(void)
{
    return json_pack("{s:s,s:b,s:{s:{}}}", "type", "object", "additionalProperties", 0,
                     "properties", "comment");
}

static json_t *nested_properties(json_t *schema, const char **key)
{
    char part[128];
    for (const char *end; *(end = strchrnul(*key, '.')); *key = end + 1) {
        snprintf(part, sizeof part, "%.*s", (int)(end - *key), *key);
        json_t *properties = json_object_get(schema, "properties");
        if (!json_object_get(properties, part))
            json_object_set_new(properties, part, open_object());
        schema = json_object_get(properties, part);
    }
    return json_object_get(schema, "properties");
}

json_t *parameters_schema(const struct parameter *table, const char *stage)
{
    json_t *schema = open_object();
    json_object_set_new(schema, "$schema",
                        json_string("https://json-schema.org/draft/2020-12/schema"));
    json_object_set_new(schema, "title", json_string(stage));
    for (const struct parameter *p = table; p->key; p++) {
        json_t *value = value_schema(p);
        if (p->fallback && !strcmp(p->fallback, "null"))
            value = json_pack("{s:[o,{s:s}]}", "anyOf", value, "type", "null");
        json_object_set_new(value, "description", json_string(p->text));
        if (strcmp(p->unit, "1"))
            json_object_set_new(value, "units", json_string(p->unit));
        if (p->fallback)
            json_object_set_new(value, "default",
                                json_loads(p->fallback, JSON_DECODE_ANY, NULL));
        const char *key = p->key;
        json_t *properties = nested_properties(schema, &key);
        json_object_set_new(properties, key, value);
    }
    return schema;
}
