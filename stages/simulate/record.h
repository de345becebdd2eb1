// SPDX-License-Identifier: GPL-3.0-or-later
// What is recorded while a scene runs: columns that grow by rows, each of which becomes
// a dataset of the motion artifact under its name. Three families: /history has a row
// for each recorded moment, /snapshots a row of all grains for each snapshot, and
// /contacts one row for each contact of each snapshot, the snapshots one behind the
// other; /snapshots/contacts says how many rows each has.
//
// SI throughout. What a row holds is the schema's to say (schemas/motion.json).
#pragma once

#include "checkpoint/named_arrays.h"
#include "checkpoint/stream.h"
#include "scene.h"

// WIDTH numbers of TYPE in each of ROWS rows; owned. A row may have no numbers (walls,
// in a scene without walls): then DATA stays NULL and only ROWS counts.
struct recorded_column {
    const char *dataset; // "/history/time"
    enum array_type type;
    int64_t width, rows, capacity;
    void *data;
};

// More than record_init declares; a new column needs no other place than that function.
enum { MOST_COLUMNS = 48 };
struct record {
    int n_column;
    struct recorded_column column[MOST_COLUMNS];
    double largest_overlap; // of all rows, in mean radii
};

// Empty columns for SCENE; free with record_free. Which columns there are follows from
// SCENE and PARAMETERS alone (liquid, energy), so a run that goes on from a checkpoint
// declares the same ones.
struct record record_init(const struct simulate_parameters *parameters,
                          const struct scene *scene);
void record_free(struct record *record);

// The column of DATASET, or NULL where it is not recorded.
const struct recorded_column *recorded(const struct record *record,
                                       const char *dataset);

// Adds a row to /history, as of TIME, s. O(pairs), for stress, energies and the
// unbalanced ratio. Forces are those of the last cycle.
void record_sums(struct record *record, const struct scene *scene,
                 const struct dem *dem, double time);

// Adds a snapshot, as of TIME, s. Contacts too if record_contacts. O(pairs +
// n_particle); 72 bytes a grain and 68 a contact (with liquid 84) are kept until the
// artifact is written.
void record_snapshot(struct record *record,
                     const struct simulate_parameters *parameters,
                     const struct scene *scene, const struct dem *dem, double time);

// Writes all columns to STREAM, or reads them. Reading replaces what the record holds.
// The stream knows by itself which of both it does, and whether it failed.
void record_state(struct record *record, struct checkpoint_stream *stream);
