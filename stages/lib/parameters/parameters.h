// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of a stage, declared once in a table.
//
// The table drives everything: parsing and checking of PARAMS.json and --set, the
// defaults, --help, the JSON Schema (--schema) and so the man page.
//
// A stage has a struct, a table of its members, and one line that fills it:
//     struct example_parameters {
//         double radius;
//         int64_t count;
//     };
//     #define AT(field) offsetof(struct example_parameters, field)
//     static const struct parameter table[] = {
//         {"radius", PARAMETER_NUMBER, "m", NULL, AT(radius), ABOVE(0),
//          .text = "of the grains"},
//         {"count", PARAMETER_INTEGER, "1", "1000", AT(count), AT_LEAST(1),
//          .text = "of grains"},
//         {0}};
// What relates two parameters to each other no row can say: a function of the stage
// checks it afterwards and names the key. A choice is stored as its place in .choices
// and cast to an enum, so both must have one order. Nothing here is safe for threads;
// all of it happens before a stage begins to compute.
#pragma once

#include "basics/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum parameter_type {
    PARAMETER_NUMBER, // double; NAN where the default is null and nothing is given
    PARAMETER_NUMBER_OR_NULL, // double; null, NAN, has a meaning that is not the
                              // default
    PARAMETER_INTEGER,        // int64_t
    PARAMETER_BOOLEAN,        // bool
    PARAMETER_CHOICE,         // int: place in CHOICES
    PARAMETER_CHOICES,        // unsigned: bit k set when choice k is in the list
    PARAMETER_TEXT,   // const char *, owned by the JSON; NULL where the default is null
    PARAMETER_COUNTS, // int64_t[3]
    PARAMETER_FLAGS,  // bool[3]
    PARAMETER_POINT,  // double[3]; NAN where the default is null and nothing is given
    PARAMETER_LIST,   // struct number_list
    PARAMETER_NAMED   // struct named_rows: {"NAME": {...}, ...}, each by a table of its
                      // own
};

// A list of numbers, in the order given; a longer one is refused.
enum { LIST_MOST = 1024 };
struct number_list {
    int count;
    double value[LIST_MOST];
};

// What {"floor": {...}, "lid": {...}} becomes: a struct a name, filled by the table
// `of`, in the order of the names, so that the order in which they are written does not
// count. Owner of both arrays; the names live as long as the effective parameters.
struct named_rows {
    int count;
    const char **name; // (count)
    void *row;         // (count) structs of ROW_SIZE bytes
};
// Rows that hold lists own nothing more.
void named_rows_free(struct named_rows *rows);
// The number of NAME among them, or -1.
int named_row(const struct named_rows *rows, const char *name);

// How the bounds are read.
enum parameter_bound { BOUND_NONE, BOUND_MINIMUM, BOUND_ABOVE, BOUND_BETWEEN };

// Rows are static; nothing in them is freed.
struct parameter {
    const char *key; // "boundary_layer.layers": dots walk into objects
    enum parameter_type type;
    const char *unit;           // UDUNITS spelling, "1" for a pure number
    const char *fallback;       // the default, as JSON; NULL: must be given
    size_t offset;              // where it goes in the stage's parameter struct
    enum parameter_bound bound; // x >= low; x > low; low <= x <= high
    double low, high;           // in the unit
    const char *choices;        // "inviscid|immobile"
    const char *text;           // one line for the user
    const struct parameter *of; // of each row of PARAMETER_NAMED
    size_t row_size;            // bytes of its struct
    bool shared; // the scene's section "conditions" may say it for all stages, under
                 // the last part of KEY
    const char *section; // of another stage, which may say KEY for both
};

// A row: what each parameter has, by place; then by name what it needs of the rest.
//     {"points", PARAMETER_INTEGER, "1", "101", AT(points), AT_LEAST(2),
//      .text = "separations on the curve, evenly spaced"},
#define AT_LEAST(least) .bound = BOUND_MINIMUM, .low = (least)
#define ABOVE(limit) .bound = BOUND_ABOVE, .low = (limit)
#define BETWEEN(least, most) .bound = BOUND_BETWEEN, .low = (least), .high = (most)

#define ROWS_OF(table, type) .of = (table), .row_size = sizeof(type)

// A table ends with a row whose key is NULL.

// Reads SECTION (an object; may be NULL: all defaults) by TABLE, checks every entry and
// fills the stage's struct PARAMETERS. WHERE names the file and section in messages.
// Reports every problem on stderr, one line each, then exits 65 if there was one. Keys
// named "comment" are skipped at every level. Returns all effective parameters,
// defaults filled in; the caller owns the reference and keeps it as long as the struct
// is used (it holds the texts). Every member of the struct is set, so it need not be
// cleared before. Numbers beyond 1e150 are refused whatever the bound, so that their
// squares are numbers.
json_t *parameters_fill(const struct parameter *table, const json_t *section,
                        const char *where, void *parameters);

// Puts "key.path=value" into SECTION; the value is read as JSON, or else as text. Parts
// of the key between dots may be names: walls.lid.velocity. Exits 64 when there is no
// "=" or no key, or what is not UTF-8. Whether the key is known and the value fits is
// for parameters_fill to say. It replaces what was there, and makes objects on the way.
void parameters_set(json_t *section, const char *assignment);

// Gives SECTION what it lacks at KEY from OTHER, where that is under the last part of
// KEY; null there says nothing.
void parameters_give(json_t *section, const char *key, const json_t *other);

// Gives SECTION what it lacks at the key of ROW from OTHER, which is the section of
// another stage; false where there is nothing to give. Exits 65 as parameters_fill,
// with WHERE, which names that section, in its messages. May write to PARAMETERS.
bool parameters_borrow(json_t *section, const struct parameter *row,
                       const json_t *other, const char *where, void *parameters);

// Keys that nothing uses: KEYS is "radius|servo", where "servo" stands for all of
// "servo.force", "servo.area", ...; WHY follows on "must be left out".
struct unused_keys {
    bool unused;
    const char *keys;
    const char *why; // "without a second input"
};

// STATUS_BAD_DATA where a key that RULES (COUNT) call unused has another value in
// EFFECTIVE, of parameters_fill, than its default: whoever set it took it to count. The
// reason begins with the key.
//
// For choices, inputs, and what is null if left out. A number of 0 that leaves others
// without use is the end of a series, along which nothing else should have to change.
enum status refuse_unused(const struct parameter *table, const json_t *effective,
                          const struct unused_keys *rules, size_t count,
                          struct reason *reason);

// Whether null is a value that can be given.
bool parameter_may_be_null(const struct parameter *parameter);

// What the bound asks for, "> 0 m", in TEXT; nothing where there is none.
const char *parameter_rule(const struct parameter *parameter, char text[80]);

// The JSON Schema (2020-12) of a table; the caller owns it. What it accepts is what
// parameters_fill accepts, but for what only the stage can check.
json_t *parameters_schema(const struct parameter *table, const char *stage);

// Appends the table to STREAM as --help shows it: key, default, unit, choices or range,
// an asterisk for shared ones, text.
void parameters_print(const struct parameter *table, FILE *stream);

// Sorted keys, no white space, 17 digits: equal parameters give equal bytes. The caller
// frees the text. What digests and comparisons of provenance go by.
char *json_canonical(const json_t *json);
