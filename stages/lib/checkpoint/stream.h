// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run as streams of numbers. Each part of it lists what it remembers in
// one function, which writes when a state is kept and reads when one is gone on from,
// so that the two cannot differ. What follows from the network and the conditions, or
// is room to work in, is not in it.
//
// A part of the state is one function, here for an array that grows:
//     void parts_state(struct parts *parts, struct checkpoint_stream *stream)
//     {
//         int64_t n = parts->n;
//         stream_count(stream, &n);
//         parts->at = stream_room(stream, parts->at, n, sizeof *parts->at);
//         parts->n = (int)n;
//         stream_numbers(stream, parts->at, n);
//         stream_integers(stream, parts->owner, n_owner, -1, parts->n - 1);
//     }
// The count goes first, as what follows is read by it. Bounds of indices may use counts
// that have been passed already, so an index that was read never leaves its array.
#pragma once

#include "basics/compensated.h"
#include "checkpoint/named_arrays.h"

#include <stdint.h>

// Values of one type, one after the other. Kept: owned, room for CAPACITY. While
// restoring DATA belongs to the list that is read.
struct value_list {
    void *data;
    int64_t n, capacity; // read: up to CAPACITY, N of them so far
};

// Values have no names: they are read in the order in which they were written, so a
// NAME_state function must not branch on anything but what it has already passed. After
// a failure all that is read is 0, so that no caller needs to ask before the end.
struct checkpoint_stream {
    bool restoring;
    bool failed; // restoring: there was less, or other, than must be; zeros since then
    struct value_list number, integer, byte;
};

// What a run goes on from, kept or restored by the same calls: NAME_state(..., STREAM)
// writes what NAME has, or reads it. The caller frees with stream_free; LIST must live
// as long. The lists have PREFIX_numbers, PREFIX_integers and PREFIX_bytes. Three types
// are kept apart because each becomes one array of an artifact. Where LIST lacks one of
// the three, or has it in another type, it counts as empty, and the first read fails.
struct checkpoint_stream stream_to_keep(void);
struct checkpoint_stream stream_to_restore(const struct array_list *list,
                                           const char *prefix);

// Each writes N values at AT, or reads them; AT has room for N. Integers lie from LEAST
// to MOST, bytes from 0 to MOST; a state with others has failed. Bounds are checked on
// reading only. Numbers are any doubles: their caller checks them. A flag is a byte of
// 0 or 1, a compensated sum two numbers, a 64-bit integer a double.
void stream_numbers(struct checkpoint_stream *stream, double *at, int64_t n);
void stream_sums(struct checkpoint_stream *stream, struct compensated *at, int64_t n);
void stream_integers(struct checkpoint_stream *stream, int32_t *at, int64_t n,
                     int32_t least, int32_t most);
void stream_bytes(struct checkpoint_stream *stream, uint8_t *at, int64_t n,
                  uint8_t most);
void stream_flags(struct checkpoint_stream *stream, bool *at, int64_t n);
void stream_integer(struct checkpoint_stream *stream, int *at, int least, int most);
void stream_long(struct checkpoint_stream *stream, int64_t *at); // 0 to 2^53

// How many elements arrays that are written next have. Once for all arrays of one
// length: two counts may differ. A count beyond 2^31, or what the stream holds, fails.
void stream_count(struct checkpoint_stream *stream, int64_t *n);
// Room for N elements of SIZE bytes while restoring, and one more. Returns ARRAY, moved
// or not; keeping: as it is.
void *stream_room(const struct checkpoint_stream *stream, void *array, int64_t n,
                  size_t size);

// All is written: the lists for a keeper, which frees them. Copies: STREAM is freed by
// itself.
struct array_list stream_list(const struct checkpoint_stream *stream,
                              const char *prefix);

// All is read: whether that was all there is, and none failed.
bool stream_is_whole(const struct checkpoint_stream *stream);

// Frees what was written; what is read belongs to the list.
void stream_free(struct checkpoint_stream *stream);
