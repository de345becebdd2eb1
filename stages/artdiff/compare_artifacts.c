// SPDX-License-Identifier: GPL-3.0-or-later
// Compares all datasets and attributes that the schema lists. The tolerance is relative
// to the largest value of a dataset, not to each value, so that rounding noise in small
// values does not count.
//
//     dataset:   differs if max |a - b| > tolerance max(|a|, |b|), over all values,
//     attribute: differs if |a - b| > tolerance max(least, |a|, |b|),
// with least = 1 for a number without unit, else 0; whole numbers must be equal.
// What only one of the two has is a difference. Artifacts of different schemas are not
// compared further.
#include "compare.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void differs(struct comparison *comparison, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(comparison->lines, format, arguments);
    va_end(arguments);
    fputc('\n', comparison->lines);
    comparison->n_different++;
}

bool are_near(const struct comparison *comparison, double least, double one,
              double other)
{
    return fabs(one - other) <=
           comparison->tolerance * fmax(least, fmax(fabs(one), fabs(other)));
}

static bool is_whole(const json_t *entry)
{
    return strcmp(json_string_value(json_object_get(entry, "type")), "float64") != 0;
}

// --- a dataset ---------------------------------------------------------------------

static bool have_one_shape(const struct dataset_values *one,
                           const struct dataset_values *other)
{
    return one->rank == other->rank &&
           memcmp(one->extent, other->extent,
                  (size_t)one->rank * sizeof *one->extent) == 0;
}

struct extremes {
    double largest; // value
    double difference;
    size_t at;    // where that is
    size_t count; // of those that differ at all
};

// All of it before anything is judged, as the tolerance is of the largest value.
static struct extremes find_extremes(const struct dataset_values *one,
                                     const struct dataset_values *other)
{
    struct extremes extremes = {0};
    for (size_t k = 0; k < one->count; k++) {
        const double a = one->value[k], b = other->value[k];
        extremes.largest = fmax(extremes.largest, fmax(fabs(a), fabs(b)));
        extremes.count += a != b;
        if (fabs(a - b) <= extremes.difference) continue;
        extremes.difference = fabs(a - b);
        extremes.at = k;
    }
    return extremes;
}

static void compare_values(struct comparison *comparison, const char *name, bool whole,
                           const struct dataset_values *one,
                           const struct dataset_values *other)
{
    if (!have_one_shape(one, other)) {
        if (one->extent[0] == other->extent[0])
            differs(comparison, "%s: rows of another shape", name);
        else
            differs(comparison, "%s: %llu and %llu rows", name,
                    (unsigned long long)one->extent[0],
                    (unsigned long long)other->extent[0]);
        return;
    }
    const struct extremes extremes = find_extremes(one, other);
    const double tolerance = whole ? 0 : comparison->tolerance;
    if (extremes.difference <= tolerance * extremes.largest) return;
    differs(comparison,
            "%s: by up to %.2e of the largest value, at row %zu: %.17g and %.17g; "
            "%zu of %zu differ",
            name, extremes.difference / extremes.largest,
            extremes.at / (one->count / (size_t)one->extent[0]),
            one->value[extremes.at], other->value[extremes.at], extremes.count,
            one->count);
}

static void compare_datasets(struct comparison *comparison, const json_t *entry,
                             const struct artifact *one, const struct artifact *other)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    struct dataset_values a = artifact_get_values(one, name);
    struct dataset_values b = artifact_get_values(other, name);
    compare_values(comparison, name, is_whole(entry), &a, &b);
    free(a.value);
    free(b.value);
}

// --- an attribute ------------------------------------------------------------------

static void compare_numbers(struct comparison *comparison, const json_t *entry,
                            const struct artifact *one, const struct artifact *other)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    const double a = artifact_get_number(one, name);
    const double b = artifact_get_number(other, name);
    const bool has_unit =
        strcmp(json_string_value(json_object_get(entry, "units")), "1");
    if (is_whole(entry) ? a != b : !are_near(comparison, has_unit ? 0 : 1, a, b))
        differs(comparison, "%s: %.17g and %.17g", name, a, b);
}

// --- all of them -------------------------------------------------------------------

typedef void compare_entry(struct comparison *comparison, const json_t *entry,
                           const struct artifact *one, const struct artifact *other);

static void compare_entries(struct comparison *comparison, const json_t *entries,
                            compare_entry *compare, const struct artifact *one,
                            const struct artifact *other)
{
    size_t k;
    json_t *entry;
    json_array_foreach(entries, k, entry)
    {
        const bool in_one = has_entry(one->file, entry);
        const bool in_other = has_entry(other->file, entry);
        if (in_one && in_other)
            compare(comparison, entry, one, other);
        else if (in_one || in_other)
            differs(comparison, "%s: only in %s",
                    json_string_value(json_object_get(entry, "name")),
                    comparison->names[in_one ? 0 : 1]);
    }
}

void compare_artifacts(struct comparison *comparison, const struct artifact *one,
                       const struct artifact *other)
{
    if (strcmp(one->schema->id, other->schema->id)) {
        differs(comparison, "schema: %s and %s", one->schema->id, other->schema->id);
        return;
    }
    compare_entries(comparison, one->schema->attributes, compare_numbers, one, other);
    compare_entries(comparison, one->schema->datasets, compare_datasets, one, other);
}
