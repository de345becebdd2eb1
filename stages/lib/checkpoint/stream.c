// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint/stream.h"

#include "basics/memory.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double largest_long = 0x1p53;

struct state state_to_keep(void)
{
    return (struct state){.restoring = false};
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

static struct state_stream open_stream(const struct array_list *list,
                                       const char *prefix, const char *kind,
                                       enum array_type type)
{
    const struct named_array *array =
        find_array(list->array, list->count, stream_name(prefix, kind).text);
    if (!array || array->type != type) return (struct state_stream){0};
    return (struct state_stream){.data = array->data, .capacity = array->count};
}

struct state state_to_restore(const struct array_list *list, const char *prefix)
{
    return (struct state){.restoring = true,
                          .number = open_stream(list, prefix, "numbers", ARRAY_FLOAT64),
                          .integer = open_stream(list, prefix, "integers", ARRAY_INT32),
                          .byte = open_stream(list, prefix, "bytes", ARRAY_UINT8)};
}

// --- values ------------------------------------------------------------------------

static void pass(struct state *state, struct state_stream *stream, void *at, int64_t n,
                 size_t size)
{
    if (state->restoring) {
        state->failed |= n > stream->capacity - stream->n;
        if (state->failed && n > 0)
            memset(at, 0, (size_t)n * size);
        else if (n > 0)
            memcpy(at, (char *)stream->data + (size_t)stream->n * size,
                   (size_t)n * size);
    } else {
        while (stream->n + n > stream->capacity) {
            stream->capacity = 2 * stream->capacity + n;
            stream->data = reallocate(stream->data, (size_t)stream->capacity, size);
        }
        if (n > 0)
            memcpy((char *)stream->data + (size_t)stream->n * size, at,
                   (size_t)n * size);
    }
    stream->n += n;
}

void state_numbers(struct state *state, double *at, int64_t n)
{
    pass(state, &state->number, at, n, sizeof *at);
}

void state_sums(struct state *state, struct compensated *at, int64_t n)
{
    for (int64_t k = 0; k < n; k++) {
        state_numbers(state, &at[k].value, 1);
        state_numbers(state, &at[k].lost, 1);
    }
}

// What is read out of bounds becomes 0, and so does all that follows.
void state_integers(struct state *state, int32_t *at, int64_t n, int32_t least,
                    int32_t most)
{
    pass(state, &state->integer, at, n, sizeof *at);
    for (int64_t k = 0; state->restoring && k < n; k++)
        state->failed |= at[k] < least || at[k] > most;
    if (state->failed && n > 0) memset(at, 0, (size_t)n * sizeof *at);
}

void state_bytes(struct state *state, uint8_t *at, int64_t n, uint8_t most)
{
    pass(state, &state->byte, at, n, 1);
    for (int64_t k = 0; state->restoring && k < n; k++)
        state->failed |= at[k] > most;
    if (state->failed && n > 0) memset(at, 0, (size_t)n);
}

void state_flags(struct state *state, bool *at, int64_t n)
{
    state_bytes(state, (uint8_t *)at, n, 1);
}

void state_integer(struct state *state, int *at, int least, int most)
{
    state_integers(state, at, 1, least, most);
}

void state_long(struct state *state, int64_t *at)
{
    double value = (double)*at;
    state_numbers(state, &value, 1);
    state->failed |= !(value >= 0 && value <= largest_long);
    *at = state->failed ? 0 : (int64_t)value;
}

void *state_room(struct state *state, void *array, int64_t *n, size_t size)
{
    state_long(state, n);
    if (!state->restoring) return array;
    // No more than there can be in a stream, so that a wrong count asks for no memory.
    const int64_t most =
        state->number.capacity + state->integer.capacity + state->byte.capacity;
    state->failed |= *n > most || *n > INT_MAX;
    if (state->failed) *n = 0;
    return reallocate(array, (size_t)*n + 1, size);
}

// --- all of it ---------------------------------------------------------------------

static void add_stream(struct array_list *list, const char *prefix, const char *kind,
                       enum array_type type, const struct state_stream *stream)
{
    add_array(list, stream_name(prefix, kind).text, type, stream->n, stream->data);
}

struct array_list state_list(const struct state *state, const char *prefix)
{
    struct array_list list = {NULL, 0};
    add_stream(&list, prefix, "numbers", ARRAY_FLOAT64, &state->number);
    add_stream(&list, prefix, "integers", ARRAY_INT32, &state->integer);
    add_stream(&list, prefix, "bytes", ARRAY_UINT8, &state->byte);
    return list;
}

bool state_is_whole(const struct state *state)
{
    return !state->failed && state->number.n == state->number.capacity &&
           state->integer.n == state->integer.capacity &&
           state->byte.n == state->byte.capacity;
}

void state_free(struct state *state)
{
    if (!state->restoring) {
        free(state->number.data);
        free(state->integer.data);
        free(state->byte.data);
    }
    *state = (struct state){0};
}
