// SPDX-License-Identifier: GPL-3.0-or-later
// Lists are short: arrays are found by name one after the other. Values are compared as
// doubles, which 64-bit integers up to 2^53 are without loss.
#include "checkpoint/named_arrays.h"

#include "basics/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t number_size(enum array_type type)
{
    switch (type) {
    case ARRAY_FLOAT64:
        return sizeof(double);
    case ARRAY_INT32:
        return sizeof(int32_t);
    case ARRAY_INT64:
        return sizeof(int64_t);
    default:
        return sizeof(uint8_t);
    }
}

static double value_at(enum array_type type, const void *at)
{
    switch (type) {
    case ARRAY_FLOAT64:
        return *(const double *)at;
    case ARRAY_INT32:
        return *(const int32_t *)at;
    case ARRAY_INT64:
        return (double)*(const int64_t *)at;
    default:
        return *(const uint8_t *)at;
    }
}

struct named_array named_array_init(const char *name, enum array_type type,
                                    int64_t count)
{
    struct named_array array = {.type = type, .count = count};
    snprintf(array.name, sizeof array.name, "%s", name);
    array.data = allocate((size_t)count, number_size(type));
    return array;
}

void add_array(struct array_list *list, const char *name, enum array_type type,
               int64_t count, const void *data)
{
    struct named_array array = {.type = type, .count = count};
    snprintf(array.name, sizeof array.name, "%s", name);
    array.data = duplicate(data, (size_t)count, number_size(type));
    list->array = reallocate(list->array, (size_t)list->count + 1, sizeof *list->array);
    list->array[list->count++] = array;
}

void free_arrays(struct named_array *array, int count)
{
    for (int k = 0; array && k < count; k++)
        free(array[k].data);
    free(array);
}

const struct named_array *find_array(const struct named_array *array, int count,
                                     const char *name)
{
    for (int k = 0; k < count; k++)
        if (!strncmp(array[k].name, name, sizeof array[k].name)) return &array[k];
    return NULL;
}

int64_t array_count(const struct array_list *list, const char *name)
{
    const struct named_array *array = find_array(list->array, list->count, name);
    return array ? array->count : 0;
}

enum status check_array(const struct named_array *array, const char *name,
                        enum array_type type, int64_t count, double least, double most,
                        struct reason *reason)
{
    if (!array || array->type != type || array->count != count)
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: must be %lld numbers of its type, as this scene has them",
                      name, (long long)count);
    for (int64_t k = 0; k < count; k++) {
        const char *at = (const char *)array->data + (size_t)k * number_size(type);
        const double value = value_at(type, at);
        if (value >= least && value <= most) continue;
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: number %lld: must be from %g to %g, got %g", name,
                      (long long)k, least, most, value);
    }
    return STATUS_OK;
}

const void *read_array(struct array_reader *reader, const char *name,
                       enum array_type type, int64_t count, double least, double most)
{
    if (reader->failed) return NULL;
    const struct named_array *array =
        find_array(reader->list->array, reader->list->count, name);
    reader->failed =
        check_array(array, name, type, count, least, most, reader->reason) != STATUS_OK;
    return reader->failed ? NULL : array->data;
}
