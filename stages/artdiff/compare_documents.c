// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two documents member by member, with the path of each as its name
// ("/mean/cracks/total"). If one of two numbers is real they are compared with the
// tolerance, relative to the larger; whole numbers, texts and null must be equal. Lists
// of different length are one difference. Provenance is taken out of both first.
//
// A member that only one has is one difference, whatever it holds; of two that differ
// in kind, both are shown, cut at 60 characters. The order of members does not count.
#include "compare.h"

#include "basics/status.h"

#include <stdlib.h>

static void compare_json(struct comparison *comparison, const char *name, json_t *one,
                         json_t *other);

static void compare_member(struct comparison *comparison, const char *name,
                           const char *key, json_t *one, json_t *other)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", name, key) < 0) die(STATUS_INTERNAL, "out of memory");
    if (one && other)
        compare_json(comparison, path, one, other);
    else
        differs(comparison, "%s: only in %s", path, comparison->names[one ? 0 : 1]);
    free(path);
}

static void compare_objects(struct comparison *comparison, const char *name,
                            json_t *one, json_t *other)
{
    const char *key;
    json_t *value;
    json_object_foreach(one, key, value)
    {
        compare_member(comparison, name, key, value, json_object_get(other, key));
    }
    json_object_foreach(other, key, value)
    {
        if (!json_object_get(one, key))
            compare_member(comparison, name, key, NULL, value);
    }
}

static void compare_lists(struct comparison *comparison, const char *name, json_t *one,
                          json_t *other)
{
    const size_t n = json_array_size(one);
    if (json_array_size(other) != n) {
        differs(comparison, "%s: %zu and %zu rows", name, n, json_array_size(other));
        return;
    }
    for (size_t k = 0; k < n; k++) {
        char index[24];
        snprintf(index, sizeof index, "%zu", k);
        compare_member(comparison, name, index, json_array_get(one, k),
                       json_array_get(other, k));
    }
}

static void compare_json(struct comparison *comparison, const char *name, json_t *one,
                         json_t *other)
{
    if (json_is_object(one) && json_is_object(other))
        compare_objects(comparison, name, one, other);
    else if (json_is_array(one) && json_is_array(other))
        compare_lists(comparison, name, one, other);
    else if ((json_is_real(one) || json_is_real(other)) && json_is_number(one) &&
             json_is_number(other)) {
        const double a = json_number_value(one), b = json_number_value(other);
        if (!are_near(comparison, 0, a, b))
            differs(comparison, "%s: %.17g and %.17g", name, a, b);
    } else if (!json_equal(one, other)) {
        char *a = json_dumps(one, JSON_ENCODE_ANY | JSON_COMPACT);
        char *b = json_dumps(other, JSON_ENCODE_ANY | JSON_COMPACT);
        differs(comparison, "%s: %.60s and %.60s", name, a, b);
        free(a);
        free(b);
    }
}

void compare_documents(struct comparison *comparison, json_t *one, json_t *other)
{
    for (const char *const *name = provenance_names; *name; name++) {
        json_object_del(one, *name);
        json_object_del(other, *name);
    }
    compare_json(comparison, "", one, other);
}
