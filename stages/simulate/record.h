// SPDX-License-Identifier: GPL-3.0-or-later
// What is recorded while a scene runs: columns that grow by rows, each of which becomes
// a dataset of the motion artifact under its name.
#ifndef CRAQUELURE_SIMULATE_RECORD_H
#define CRAQUELURE_SIMULATE_RECORD_H

#include "checkpoint/named_arrays.h"
#include "checkpoint/stream.h"
#include "scene.h"

// WIDTH numbers of TYPE in each of ROWS rows; owned.
struct recorded_column {
    const char *dataset; // "/history/time"
    enum array_type type;
    int64_t width, rows, capacity;
    void *data;
};

enum { MOST_COLUMNS = 48 };
struct record {
    int n_column;
    struct recorded_column column[MOST_COLUMNS];
    double largest_overlap; // of all rows, in mean radii
};

// Empty columns for SCENE; free with record_free.
struct record make_record(const struct simulate_parameters *parameters,
                          const struct scene *scene);
void record_free(struct record *record);

// The column of DATASET, or NULL where it is not recorded.
const struct recorded_column *recorded(const struct record *record,
                                       const char *dataset);

// Adds a row to /history, as of TIME, s.
void record_sums(struct record *record, const struct scene *scene,
                 const struct dem *dem, double time);

// Adds a snapshot, as of TIME, s.
void record_snapshot(struct record *record,
                     const struct simulate_parameters *parameters,
                     const struct scene *scene, const struct dem *dem, double time);

// Writes all columns to STREAM, or reads them.
void record_state(struct record *record, struct checkpoint_stream *stream);

#endif
