// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/keeper.h"

#include "basics/memory.h"

#include <stdio.h>
#include <stdlib.h>

void add_array(struct array_list *list, const char *name, enum dem_array_type type,
               int64_t count, const void *data)
{
    struct dem_array array = {.type = type, .count = count};
    snprintf(array.name, sizeof array.name, "%s", name);
    array.data = duplicate(data, (size_t)count, dem_number_size(type));
    list->array = reallocate(list->array, (size_t)list->count + 1, sizeof *list->array);
    list->array[list->count++] = array;
}

void free_kept_state(struct kept_state *state)
{
    dem_free_arrays(state->engine.array, state->engine.count);
    dem_free_arrays(state->stage.array, state->stage.count);
    *state = (struct kept_state){{NULL, 0}, {NULL, 0}};
}

const void *read_array(struct array_reader *reader, const char *name,
                       enum dem_array_type type, int64_t count, double least,
                       double most)
{
    if (reader->failed) return NULL;
    const struct dem_array *array =
        dem_find_array(reader->list->array, reader->list->count, name);
    reader->failed = dem_check_array(array, name, type, count, least, most,
                                     reader->reason) != STATUS_OK;
    return reader->failed ? NULL : array->data;
}

int64_t array_count(const struct array_list *list, const char *name)
{
    const struct dem_array *array = dem_find_array(list->array, list->count, name);
    return array ? array->count : 0;
}

bool is_due(const struct keeper *keeper)
{
    return keeper && keeper->due && keeper->due(keeper->context);
}

void keep_state(const struct keeper *keeper, const struct dem *dem,
                struct array_list stage)
{
    struct kept_state state = {.stage = stage};
    state.engine.array = dem_save(dem, &state.engine.count);
    keeper->keep(keeper->context, &state);
    free_kept_state(&state);
}

int64_t cycles_between_questions(int n_particle)
{
    return 1 + 1000000 / (1 + n_particle);
}
