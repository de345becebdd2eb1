// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run as streams of numbers. Each part of it lists what it remembers in
// one function, which writes when a state is kept and reads when one is gone on from,
// so that the two cannot differ. What follows from the network and the conditions, or
// is room to work in, is not in it.
#ifndef CRAQUELURE_CHECKPOINT_STREAM_H
#define CRAQUELURE_CHECKPOINT_STREAM_H

#include "basics/compensated.h"
#include "checkpoint/named_arrays.h"

#include <stdint.h>

struct state_stream {
    void *data;
    int64_t n, capacity; // read: up to CAPACITY, N of them so far
};

struct state {
    bool restoring;
    bool failed; // restoring: there was less, or other, than must be; zeros since then
    struct state_stream number, integer, byte;
};

// What a run goes on from, kept or restored by the same calls: NAME_state(..., STATE)
// writes what NAME has, or reads it. The caller frees with state_free; LIST must live
// as long. The lists have PREFIX_numbers, PREFIX_integers and PREFIX_bytes.
struct state state_to_keep(void);
struct state state_to_restore(const struct array_list *list, const char *prefix);

// Each writes N values at AT, or reads them. Integers lie from LEAST to MOST, bytes
// from 0 to MOST; a state with others has failed.
void state_numbers(struct state *state, double *at, int64_t n);
void state_sums(struct state *state, struct compensated *at, int64_t n);
void state_integers(struct state *state, int32_t *at, int64_t n, int32_t least,
                    int32_t most);
void state_bytes(struct state *state, uint8_t *at, int64_t n, uint8_t most);
void state_flags(struct state *state, bool *at, int64_t n);
void state_integer(struct state *state, int *at, int least, int most);
void state_long(struct state *state, int64_t *at); // 0 to 2^53

// ARRAY, with N elements of SIZE bytes, is written next: makes room for as many as are
// read (up to 2^31), and says how many in N.
void *state_room(struct state *state, void *array, int64_t *n, size_t size);

// All is written: the lists for a keeper, which frees them.
struct array_list state_list(const struct state *state, const char *prefix);

// All is read: whether that was all there is, and none failed.
bool state_is_whole(const struct state *state);

void state_free(struct state *state);

#endif
