// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of numbers by name: what the state of a run is kept as. An artifact holds each
// as a dataset; who reads one says which type, length and range it must have.
//
// How a state is read back:
//     struct array_reader reader = {list, reason, false};
//     const double *time = read_array(&reader, "time", ARRAY_FLOAT64, 1, 0, 1e150);
//     const int32_t *bond = read_array(&reader, "bond", ARRAY_INT32, n, 0, most);
//     if (reader.failed) return STATUS_BAD_DATA;
// A file may have been changed by anyone, so ranges are those outside of which a number
// could lead the program outside of its arrays. For one thread.
#pragma once

#include "basics/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum array_type { ARRAY_FLOAT64, ARRAY_INT32, ARRAY_INT64, ARRAY_UINT8 };

// One array. Longer names are cut, and then not found by the whole name. Numbers are in
// the byte order of the machine; the file format takes care of the rest.
struct named_array {
    char name[32]; // "pair_shear_force"
    enum array_type type;
    int64_t count; // numbers
    void *data;    // (count) of type; owned
};

// Arrays of different names, in any order; {NULL, 0} is the empty list.
struct array_list {
    struct named_array *array; // (count) owned
    int count;
};

// Bytes that one number of TYPE takes. 8, 4, 8 or 1.
size_t number_size(enum array_type type);

// COUNT zeros, to be freed with free_arrays. All memory here is that of
// basics/memory.h: it never fails.
struct named_array named_array_init(const char *name, enum array_type type,
                                    int64_t count);

// Adds a copy of the COUNT numbers of DATA to LIST; does not look for the name there.
// COUNT of 0 is an array, too: find_array finds it.
void add_array(struct array_list *list, const char *name, enum array_type type,
               int64_t count, const void *data);
// Frees COUNT arrays and ARRAY itself, which may be NULL.
void free_arrays(struct named_array *array, int count);

// The one of COUNT that is called NAME, or NULL.
const struct named_array *find_array(const struct named_array *array, int count,
                                     const char *name);

// How many numbers are called NAME, 0 when there are none. For lengths that the reader
// does not know before.
int64_t array_count(const struct array_list *list, const char *name);

// Whether ARRAY, which may be NULL, is of TYPE and has COUNT numbers from LEAST to
// MOST: STATUS_BAD_DATA if not, with NAME and the number in REASON. NAN never is.
enum status check_array(const struct named_array *array, const char *name,
                        enum array_type type, int64_t count, double least, double most,
                        struct reason *reason);

// Reads LIST; after the first array that is not as it should be, nothing any more, so
// that a caller reads all it needs and asks `failed` once. Begin with the first two.
//     struct array_reader reader = {list, reason, false};
struct array_reader {
    const struct array_list *list;
    struct reason *reason; // of that
    bool failed;
};

// The numbers called NAME if they are COUNT, each from LEAST to MOST; otherwise NULL.
// They stay the list's. REASON then has the first failure, not the last.
const void *read_array(struct array_reader *reader, const char *name,
                       enum array_type type, int64_t count, double least, double most);
