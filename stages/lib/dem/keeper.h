// SPDX-License-Identifier: GPL-3.0-or-later
// How a long run lets its state be kept on the way, and goes on from one that was.
#ifndef CRAQUELURE_DEM_KEEPER_H
#define CRAQUELURE_DEM_KEEPER_H

#include "dem/dem.h"

struct array_list {
    struct dem_array *array;
    int count;
};

// Of the engine, and what the stage that runs it has to remember.
struct kept_state {
    struct array_list engine, stage;
};

struct keeper {
    // Asked often; whether it is time to keep the state. NULL: it never is.
    bool (*due)(void *context);
    // Need not return: the run may end here.
    void (*keep)(void *context, const struct kept_state *state);
    void *context;
    const struct kept_state *begin; // to go on from; NULL: begin at the beginning
};

// Adds a copy of the COUNT numbers of DATA to LIST.
void add_array(struct array_list *list, const char *name, enum dem_array_type type,
               int64_t count, const void *data);
void free_kept_state(struct kept_state *state);

// Reads LIST; after the first array that is not as it should be, nothing any more.
struct array_reader {
    const struct array_list *list;
    struct reason *reason; // of that
    bool failed;
};

// The numbers called NAME if they are COUNT, each from LEAST to MOST; otherwise NULL.
const void *read_array(struct array_reader *reader, const char *name,
                       enum dem_array_type type, int64_t count, double least,
                       double most);

// How many numbers are called NAME, 0 when there are none.
int64_t array_count(const struct array_list *list, const char *name);

// Asks KEEPER and, if it is time, gives it the state of DEM and STAGE, which it frees
// in any case.
bool is_due(const struct keeper *keeper);
void keep_state(const struct keeper *keeper, const struct dem *dem,
                struct array_list stage);

// Cycles that may pass between two questions: some tenths of a second's work. Where a
// run is cut makes no difference to it.
int64_t cycles_between_questions(int n_particle);

#endif
