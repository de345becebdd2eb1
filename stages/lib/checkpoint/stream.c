// SPDX-License-Identifier: GPL-3.0-or-later
// Three lists, of numbers, integers and bytes, that grow while a state is kept and are
// walked through from the front while it is restored. A damaged state must not lead an
// engine astray: after the first value that is missing or out of bounds all others are
// read as 0, and stream_is_whole says so at the end.
#include "checkpoint/stream.h"

#include "basics/memory.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LARGEST_LONG = 0x1p53;

struct checkpoint_stream stream_to_keep(void)
{
    return (struct checkpoint_stream){.restoring = false};
}

// "drying_numbers"
struct stream_name {
    char text[32];
};
static struct stream_name stream_name(const char *prefix, const char *kind)
{
    struct stream_name name;
    snprintf(name.text, sizeof name.text, "%s_%s", prefix, kind);
    return name;
}

static struct value_list open_stream(const struct array_list *list, const char *prefix,
                                     const char *kind, enum array_type type)
{
    const struct named_array *array =
        find_array(list->array, list->count, stream_name(prefix, kind).text);
    if (!array || array->type != type) return (struct value_list){0};
    return (struct value_list){.data = array->data, .capacity = array->count};
}

struct checkpoint_stream stream_to_restore(const struct array_list *list,
                                           const char *prefix)
{
    return (struct checkpoint_stream){
        .restoring = true,
        .number = open_stream(list, prefix, "numbers", ARRAY_FLOAT64),
        .integer = open_stream(list, prefix, "integers", ARRAY_INT32),
        .byte = open_stream(list, prefix, "bytes", ARRAY_UINT8)};
}

// --- values ------------------------------------------------------------------------

static void pass(struct checkpoint_stream *stream, struct value_list *values, void *at,
                 int64_t n, size_t size)
{
    if (stream->restoring) {
        stream->failed |= n > values->capacity - values->n;
        if (stream->failed && n > 0)
            memset(at, 0, (size_t)n * size);
        else if (n > 0)
            memcpy(at, (char *)values->data + (size_t)values->n * size,
                   (size_t)n * size);
    } else {
        while (values->n + n > values->capacity) {
            values->capacity = 2 * values->capacity + n;
            values->data = reallocate(values->data, (size_t)values->capacity, size);
        }
        if (n > 0)
            memcpy((char *)values->data + (size_t)values->n * size, at,
                   (size_t)n * size);
    }
    values->n += n;
}

void stream_numbers(struct checkpoint_stream *stream, double *at, int64_t n)
{
    pass(stream, &stream->number, at, n, sizeof *at);
}

void stream_sums(struct checkpoint_stream *stream, struct compensated *at, int64_t n)
{
    for (int64_t k = 0; k < n; k++) {
        stream_numbers(stream, &at[k].value, 1);
        stream_numbers(stream, &at[k].lost, 1);
    }
}

// What is read out of bounds becomes 0, and so does all that follows.
void stream_integers(struct checkpoint_stream *stream, int32_t *at, int64_t n,
                     int32_t least, int32_t most)
{
    pass(stream, &stream->integer, at, n, sizeof *at);
    for (int64_t k = 0; stream->restoring && k < n; k++)
        stream->failed |= at[k] < least || at[k] > most;
    if (stream->failed && n > 0) memset(at, 0, (size_t)n * sizeof *at);
}

void stream_bytes(struct checkpoint_stream *stream, uint8_t *at, int64_t n,
                  uint8_t most)
{
    pass(stream, &stream->byte, at, n, 1);
    for (int64_t k = 0; stream->restoring && k < n; k++)
        stream->failed |= at[k] > most;
    if (stream->failed && n > 0) memset(at, 0, (size_t)n);
}

void stream_flags(struct checkpoint_stream *stream, bool *at, int64_t n)
{
    stream_bytes(stream, (uint8_t *)at, n, 1);
}

void stream_integer(struct checkpoint_stream *stream, int *at, int least, int most)
{
    stream_integers(stream, at, 1, least, most);
}

void stream_long(struct checkpoint_stream *stream, int64_t *at)
{
    double value = (double)*at;
    stream_numbers(stream, &value, 1);
    stream->failed |= !(value >= 0 && value <= LARGEST_LONG);
    *at = stream->failed ? 0 : (int64_t)value;
}

void stream_count(struct checkpoint_stream *stream, int64_t *n)
{
    stream_long(stream, n);
    if (!stream->restoring) return;
    // No more than there can be in a values, so that a wrong count asks for no memory.
    const int64_t most =
        stream->number.capacity + stream->integer.capacity + stream->byte.capacity;
    stream->failed |= *n > most || *n > INT_MAX;
    if (stream->failed) *n = 0;
}

void *stream_room(const struct checkpoint_stream *stream, void *array, int64_t n,
                  size_t size)
{
    return stream->restoring ? reallocate(array, (size_t)n + 1, size) : array;
}

// --- all of it ---------------------------------------------------------------------

static void add_stream(struct array_list *list, const char *prefix, const char *kind,
                       enum array_type type, const struct value_list *values)
{
    add_array(list, stream_name(prefix, kind).text, type, values->n, values->data);
}

struct array_list stream_list(const struct checkpoint_stream *stream,
                              const char *prefix)
{
    struct array_list list = {NULL, 0};
    add_stream(&list, prefix, "numbers", ARRAY_FLOAT64, &stream->number);
    add_stream(&list, prefix, "integers", ARRAY_INT32, &stream->integer);
    add_stream(&list, prefix, "bytes", ARRAY_UINT8, &stream->byte);
    return list;
}

bool stream_is_whole(const struct checkpoint_stream *stream)
{
    return !stream->failed && stream->number.n == stream->number.capacity &&
           stream->integer.n == stream->integer.capacity &&
           stream->byte.n == stream->byte.capacity;
}

void stream_free(struct checkpoint_stream *stream)
{
    if (!stream->restoring) {
        free(stream->number.data);
        free(stream->integer.data);
        free(stream->byte.data);
    }
    *stream = (struct checkpoint_stream){0};
}
