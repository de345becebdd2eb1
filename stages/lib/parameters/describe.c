// SPDX-License-Identifier: GPL-3.0-or-later
// What the table of a stage's parameters tells its user: --help and --schema. Dots in
// keys become nested objects in the JSON Schema; bounds become minimum, maximum and
// exclusiveMinimum, choices an enum.
//
// Both come from the same rows, so that help and schema cannot contradict what
// parameters_fill accepts. docs/reference.md is made from them, too.
//
//     KEY=DEFAULT UNIT  [choices]  [rule] *     in --help; (required): no default
//             text, wrapped
#include "parameters/parameters.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// As short as it can be without losing a digit. Six digits are enough for nearly all
// defaults.
static const char *number_text(double value, char text[24])
{
    snprintf(text, 24, "%g", value);
    if (strtod(text, NULL) != value) snprintf(text, 24, "%.10g", value);
    return text;
}

bool parameter_may_be_null(const struct parameter *parameter)
{
    return parameter->type == PARAMETER_NUMBER_OR_NULL ||
           (parameter->fallback && !strcmp(parameter->fallback, "null"));
}

// In the user's words; also part of messages (parameters.c).
const char *parameter_rule(const struct parameter *parameter, char text[80])
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

enum { HELP_WIDTH = 78 }; // argp wraps at 79, without our indent

// Words of TEXT, wrapped, each line behind INDENT blanks. A word longer than a line has
// one to itself.
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

// Rows of named objects come indented under their names.
static void print_rows(const struct parameter *table, const char *prefix, FILE *stream)
{
    for (const struct parameter *p = table; p->key; p++) {
        char rule[80], inner[128];
        int column = fprintf(stream, "  %s%s=%s", prefix, p->key,
                             p->fallback ? p->fallback : "(required)");
        if (strcmp(p->unit, "1")) column += fprintf(stream, " %s", p->unit);
        if (p->choices) print_choices(stream, p->choices, column);
        if (p->bound) fprintf(stream, "  [%s]", parameter_rule(p, rule));
        if (p->shared) fprintf(stream, " *");
        fprintf(stream, "\n");
        print_wrapped(stream, p->text, 8);
        snprintf(inner, sizeof inner, "%s.NAME.", p->key);
        if (p->of) print_rows(p->of, inner, stream);
    }
}

void parameters_print(const struct parameter *table, FILE *stream)
{
    print_rows(table, "", stream);
}

// "a|b" is ["a", "b"].
static json_t *split_choices(const char *choices)
{
    json_t *names = json_array();
    for (const char *end;; choices = end + 1) {
        end = strchrnul(choices, '|');
        json_array_append_new(names, json_stringn(choices, (size_t)(end - choices)));
        if (!*end) return names;
    }
}

// A new object {"type": TYPE} with the bound of PARAMETER.
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

// Takes ITEMS over.
static json_t *three_of(json_t *items)
{
    return json_pack("{s:s,s:o,s:i,s:i}", "type", "array", "items", items, "minItems",
                     3, "maxItems", 3);
}

static json_t *table_schema(const struct parameter *table);

// Sizes of numbers are not bounded here: that is a rule of the program.
static json_t *value_schema(const struct parameter *parameter)
{
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_NUMBER_OR_NULL:
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
    case PARAMETER_NAMED:
        return json_pack("{s:s,s:{s:{}},s:o}", "type", "object", "properties",
                         "comment", "additionalProperties",
                         table_schema(parameter->of));
    }
    return NULL;
}

// No other members than those listed, but a comment everywhere.
static json_t *open_object(void)
{
    return json_pack("{s:s,s:b,s:{s:{}}}", "type", "object", "additionalProperties", 0,
                     "properties", "comment");
}

// KEY is left at its last part.
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

static json_t *table_schema(const struct parameter *table)
{
    json_t *schema = open_object();
    for (const struct parameter *p = table; p->key; p++) {
        json_t *value = value_schema(p);
        if (parameter_may_be_null(p))
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

json_t *parameters_schema(const struct parameter *table, const char *stage)
{
    json_t *schema = table_schema(table);
    json_object_set_new(schema, "$schema",
                        json_string("https://json-schema.org/draft/2020-12/schema"));
    json_object_set_new(schema, "title", json_string(stage));
    return schema;
}
