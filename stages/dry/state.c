// SPDX-License-Identifier: GPL-3.0-or-later
#include "state.h"

#include "basics/memory.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const double largest_long = 0x1p53;

struct state state_to_keep(void)
{
    return (struct state){.restoring = false};
}

static struct state_stream open_stream(const struct array_list *list, const char *name,
                                       enum dem_array_type type)
{
    const struct dem_array *array = dem_find_array(list->array, list->count, name);
    if (!array || array->type != type) return (struct state_stream){0};
    return (struct state_stream){.data = array->data, .capacity = array->count};
}

struct state state_to_restore(const struct array_list *list)
{
    return (struct state){.restoring = true,
                          .number = open_stream(list, "drying_numbers", DEM_FLOAT64),
                          .integer = open_stream(list, "drying_integers", DEM_INT32),
                          .byte = open_stream(list, "drying_bytes", DEM_UINT8)};
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

struct array_list state_list(const struct state *state)
{
    struct array_list list = {NULL, 0};
    add_array(&list, "drying_numbers", DEM_FLOAT64, state->number.n,
              state->number.data);
    add_array(&list, "drying_integers", DEM_INT32, state->integer.n,
              state->integer.data);
    add_array(&list, "drying_bytes", DEM_UINT8, state->byte.n, state->byte.data);
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
